"""The README's rates are those of the pages that they restate: every row of its table of results, and every rate in a sentence."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
Row = dict[str, str]


def tables(text: str, *columns: str) -> list[Row]:
    """Rows of every Markdown table that has all of these columns: column -> cell, rows that link to commands elsewhere left out."""
    found = []
    for block in re.findall(r"(?:^\|.*\n)+", text, re.MULTILINE):
        lines = [[cell.strip() for cell in re.split(r"(?<!\\)\|", line.strip()[1:-1])] for line in block.splitlines()]
        if set(columns) <= set(lines[0]):
            found += [dict(zip(lines[0], cells, strict=True)) for cells in lines[2:]]
    return [row for row in found if row["command"].startswith("`")]


def page(name: str) -> str:
    return (ROOT / "docs" / name).read_text(encoding="utf-8")


def measured() -> dict[str, Row]:
    """What the two pages of rates tell of each command, in the README's columns; a bound that only judges is no part of a command."""
    found = {}
    for row in tables(page("results.md"), "success", "n", "seeds", "noise", "command"):
        command = re.sub(r" --at-least [\d.]+%", "", row["command"])
        held_out = row["seeds"].partition(", ")[2]
        noise = f"{row['noise']}, {held_out}" if held_out else row["noise"]
        found[command] = {"success": row["success"], "n": row["n"], "noise": noise}
    space = page("space-execution.md").split("**On held-out seeds**")[1]
    for row in tables(space, "came to their end", "command"):
        success, _, n = row["came to their end"].partition(" of ")
        found[row["command"]] = {"success": success, "n": n, "noise": "usual, held-out seeds"}
    return found


RATES = tables(README, "success", "n", "noise", "command")


@pytest.mark.parametrize("row", RATES, ids=lambda row: row["task"])
def test_a_rate_of_the_readme_is_that_of_its_page(row: Row) -> None:
    told = {column: row[column] for column in ("success", "n", "noise")}
    assert measured()[row["command"]] == told


def test_the_readme_has_rates_of_climbs_of_walks_and_of_robots_in_space() -> None:
    assert {"ladder", "rough", "wall"} <= {word for row in RATES for word in re.findall(r"[a-z]+", row["command"])}


def test_a_rate_in_a_sentence_of_the_readme_stands_on_a_page_of_rates() -> None:
    rates = page("results.md") + page("space-execution.md")
    told = re.findall(r"\b\d+ of \d+\b", README)
    assert [rate for rate in told if not re.search(rf"\b{rate}\b", rates)] == []
