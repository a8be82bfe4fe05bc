"""docs/controllers.md: its numbers are those that its commands print, its example runs, its pictures and links are there."""

import json
import re
from pathlib import Path

import pytest

from clamber.cli import main
from clamber.control.law_settings import LAWS

PAGE = Path(__file__).parents[2] / "docs" / "controllers.md"
TEXT = PAGE.read_text()
NUMBER = re.compile(r"-?\d+\.\d+")
MATCHED = ("jacobian-transpose", "operational-space", "joint-pd", "scct")


def table(begin: str) -> list[list[str]]:
    """Rows of the table whose first line begins so."""
    lines = TEXT[TEXT.index(begin) :].splitlines()[2:]
    rows = []
    for line in lines:
        if not line.startswith("|"):
            break
        rows.append([cell.strip() for cell in line.strip("|").split("|")])
    return rows


FIGURES, FORCES = table("| law | step ideal"), table("| law | joint friction")
IN_MATCHING, CHECKS = table("| law, matched in Kyy"), table("| `clamber limb` | law")


def agree(told: str, ours: str) -> None:
    """Two cells are the same but for the last digit of their numbers, which another processor may round the other way."""
    assert NUMBER.sub("#", told) == NUMBER.sub("#", ours)
    for a, b in zip(NUMBER.findall(told), NUMBER.findall(ours), strict=True):
        assert abs(float(a) - float(b)) < 1.5 * 10.0 ** -len(a.partition(".")[2]), (told, ours)


def said(capfd: pytest.CaptureFixture[str], *words: str) -> str:
    capfd.readouterr()
    try:
        main(("limb", *words, "-q"))
    except SystemExit as left:
        assert left.code in (None, 0, 1)
    return capfd.readouterr().out


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "motions", "forces"),
    [(("all",), FIGURES, FORCES), ((*MATCHED, "--reference", "scct:kp=200,kd=10"), IN_MATCHING, [])],
)
def test_the_tables_are_what_the_portraits_print(
    capfd: pytest.CaptureFixture[str], words: tuple[str, ...], motions: list[list[str]], forces: list[list[str]]
) -> None:
    printed = [line for line in said(capfd, "portrait", *words, "--markdown").splitlines() if line]
    for told, line in zip([*motions, *forces], printed, strict=True):
        for cell, ours in zip(told, line.strip("|").split("|"), strict=True):
            agree(cell, ours.strip())


@pytest.mark.slow
@pytest.mark.parametrize(("command", "law", "key", "told"), CHECKS)
def test_other_choices_come_to_what_the_page_says(
    capfd: pytest.CaptureFixture[str], command: str, law: str, key: str, told: str
) -> None:
    result = json.loads(said(capfd, *command.strip("`").split(), "--json"))
    (entry,) = (each for each in result["laws"] if each["label"] == law)
    value = entry[key.strip("`")] if "mean" not in entry else entry["mean"]["true"][key.strip("`")]
    unit = told.split()[1]
    agree(told, f"{value * {'mm': 1e3, 's': 1.0, 'N': 1.0}[unit]:.2f} {unit}")


def test_every_figure_in_the_text_stands_in_a_table() -> None:
    known = {cell.split()[0] for rows in (FIGURES, FORCES, IN_MATCHING, CHECKS) for row in rows for cell in row if cell}
    prose = [line for line in TEXT.splitlines() if not line.startswith(("| ", "    ")) or "](#" in line]
    told = [number for line in prose for number in re.findall(r"(\d+\.\d+)(?= (?:mm|N|s)\b)(?! N/)", line)]
    assert len(told) > 25
    assert [number for number in told if number not in known] == []


def test_every_law_has_a_section_and_a_picture_and_every_link_leads_somewhere() -> None:
    titles = re.findall(r"^#+ (.+)$", TEXT, re.MULTILINE)
    for law in LAWS:
        assert law in titles
        assert f"\n![{law}](media/controllers/{law}.png)\n" in TEXT
    for link in re.findall(r"\]\(([^)]+)\)", TEXT):
        if link.startswith("#"):
            assert link[1:] in titles
        else:
            assert (PAGE.parent / link).is_file(), link
    assert [row[0] for row in FIGURES] == list(LAWS)


def test_the_example_runs(capsys: pytest.CaptureFixture[str]) -> None:
    (code,) = re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL)
    names: dict[str, object] = {}
    exec(code, names)
    assert getattr(names["torques"], "shape", None) == (1000, 3)
    assert "scct on libra's right limb" in capsys.readouterr().out
