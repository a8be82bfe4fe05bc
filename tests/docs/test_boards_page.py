"""Lengths, cones and stances on the page of the boards are those of the study that proves them."""

from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"
STUDY = DOCS / "studies" / "boards-exact"


def rows(page: Path, head: str) -> dict[str, list[str]]:
    """The table of a page whose first line begins so: first cell -> the others."""
    block = page.read_text(encoding="utf-8").split(f"\n{head}", 1)[1].split("\n\n", 1)[0]
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in block.splitlines()[2:]]
    return {row[0]: row[1:] for row in cells}


KEPT = rows(DOCS / "benchmark-boards.md", "| board | shortest plan at 90, 75, 60 deg, before |")


@pytest.mark.parametrize("board", KEPT)
def test_what_is_proved_with_kept_elbows_is_on_the_studys_pages(board: str) -> None:
    _, lengths, _, cone, _, stances = KEPT[board]
    _, _, at_90, at_75, at_60, _, seen = rows(STUDY / "hook-cost.md", "| board | hook off, elbows free |")[board]
    narrowest = rows(STUDY / "narrowest-cone.md", "| board | narrowest cone [deg] |")[board][0]
    assert (lengths, cone, stances) == (f"{at_90}, {at_75}, {at_60}", f"{narrowest} deg", seen)


def test_every_board_of_the_study_is_on_the_page() -> None:
    assert list(KEPT) == list(rows(STUDY / "hook-cost.md", "| board | hook off, elbows free |"))
