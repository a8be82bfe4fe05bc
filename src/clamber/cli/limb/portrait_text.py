"""Portraits of laws as people read them: two tables, and a folder of pictures."""

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from rich.console import Console

from ...limb_bench.portrait import Portrait
from ..output import plain_table

GAINS: Final = ("kp", "kd", "Kxx\nN/mm", "Kyy\nN/mm")
NUMBERS: Final = tuple(
    f"{scene}\n{plant}" for scene in ("step", "circle", "fed", "push") for plant in ("ideal", "nom.")
)
ERRORS: Final = tuple(f"{plant}\n{what}" for plant in ("ideal", "nom.") for what in ("mean N", "worst N"))


def draw_portraits(portraits: Sequence[Portrait], folder: Path) -> None:
    """Write a picture of each law."""
    from ...limb_bench.pictures.law_portrait import draw_portrait

    for each in portraits:
        draw_portrait(each, folder / f"{each.law}.png")


def print_markdown(portraits: Sequence[Portrait]) -> None:
    """Print the rows of motions, and after an empty line those of forces, as docs/controllers.md has them."""
    rows = ["| " + " | ".join(each.row()) + " |" for each in portraits]
    forces = ["| " + " | ".join(row) + " |" for each in portraits for row in each.force_rows()]
    sys.stdout.write("\n".join([*rows, *(["", *forces] if forces else [])]) + "\n")


def print_portraits(console: Console, portraits: Sequence[Portrait], folder: Path | None = None) -> None:
    """Print the figures of every law."""
    gains = plain_table("law", *GAINS, right=GAINS)
    for each in portraits:
        gains.add_row(*each.gains_row())
    console.print(gains)
    console.print()
    table = plain_table("law", *NUMBERS, right=NUMBERS)
    for each in portraits:
        table.add_row(*each.row())
    console.print(table)
    console.print()
    console.print("ideal: friction alone; nom.: backlash, encoders, delay too; all in truth, in mm")
    console.print("step: most across, of 2 cm; circle: radial RMS, last lap of 3 s; fed: with the")
    console.print("aim's acceleration and friction fed forward; push: yielding along 10 N")
    rows = [row for each in portraits for row in each.force_rows()]
    if rows:
        console.print()
        forces = plain_table("law", "joint friction", *ERRORS, right=ERRORS)
        for row in rows:
            forces.add_row(*row)
        console.print(forces)
        console.print()
        console.print(f"errors of {portraits[0].task.force:g} N on a wall, standing and sliding")
    if folder is not None:
        console.print(f"pictures written to {folder}", soft_wrap=True)
