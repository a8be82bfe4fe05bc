"""Numbers of section 4.4.2 on the page of the body bench are those of the study's page."""

import re
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"
STUDY = (DOCS / "studies" / "bevly-1997" / "section-4-4-2.md").read_text(encoding="utf-8")


def number(name: str) -> float:
    """Of the study's table of numbers."""
    found = re.search(rf"^\| {re.escape(name)} \| ([\d.]+) \|", STUDY, re.MULTILINE)
    assert found is not None, name
    return float(found[1])


def climbed(control: str) -> float:
    return number(f"{control}, noise: rungs climbed, of 20")


def unhooked(control: str) -> float:
    return number(f"{control}, noise: rungs with a hook off, of 20")


def row(limit: str) -> str:
    """What the page says came of a limit."""
    text = (DOCS / "body-bench.md").read_text(encoding="utf-8")
    rows = [line.strip("|").split(" | ") for line in text.splitlines() if line.startswith(f"| {limit} |")]
    assert len(rows) == 1 and "`section-4-4-2`" in rows[0][2]
    return rows[0][1]


def said(pattern: str, limit: str) -> float:
    """The one number that a pattern finds in a row."""
    (found,) = re.findall(pattern, row(limit))
    return float(found)


def test_the_printed_limit() -> None:
    assert said(r"under noise (\d+) of 20 rungs", "`thesis`, alpha 0") == climbed("alpha 0")
    off = [number(f"alpha 0, ideal plant, no noise: body {side} its aim, most [mm]") for side in ("above", "below")]
    assert said(r"the ideal rung is climbed up to (\d+) mm off", "`thesis`, alpha 0") == pytest.approx(
        max(off), abs=0.5
    )
    assert unhooked("alpha 0") == 0  # "keeps hooks on through every push and rung"


def test_limits_with_an_offset() -> None:
    limit = "`thesis`, alpha above 0"
    assert said(r"with 0\.03 m/s\^2 (\d+) of 20 rungs", limit) == climbed("alpha 0.03")
    assert "with 0.1 none" in row(limit) and climbed("alpha 0.1") == climbed("alpha 0.3") == 0
    assert said(r"with 0\.3 hooks come off on all (\d+)", limit) == unhooked("alpha 0.3")


def test_no_limit_and_our_own_control() -> None:
    limit = "none, or our own control"
    assert said(r"all (\d+) rungs", limit) == climbed("no limit") == climbed("our own control")
