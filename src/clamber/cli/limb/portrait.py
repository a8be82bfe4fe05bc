"""`clamber limb portrait`: all that a law does."""

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import typer
from rich.console import Console

from ...terminal.name_completion import names_of
from ...terminal.options import ROBOT, AsJson, Quiet, takes_options
from ...terminal.output import print_json, stdout
from . import options as opt

if TYPE_CHECKING:
    from ...limb_bench.portrait import Portrait

GAINS: Final = ("kp", "kd", "Kxx\nN/mm", "Kyy\nN/mm")
NUMBERS: Final = tuple(
    f"{scene}\n{plant}" for scene in ("step", "circle", "fed", "push") for plant in ("ideal", "nom.")
)
ERRORS: Final = tuple(f"{plant}\n{what}" for plant in ("ideal", "nom.") for what in ("mean N", "worst N"))


@dataclass(frozen=True, slots=True)
class PortraitWords:
    """The limb of the portraits and how laws come by their gains, as it came."""

    reference: Annotated[
        str | None,
        typer.Option(
            metavar="NAME[:KEY=VALUE,...]",
            help="Match gains to this law, such as scct:kp=200,kd=10.",
            autocompletion=names_of("controllers"),
        ),
    ] = None
    match: opt.Matched = opt.MatchChoice.yy
    robot: opt.Robot = ROBOT
    limb: opt.LimbName = None
    seed: Annotated[int, typer.Option(min=0, help="Draws play and encoder phase of the nominal limb.")] = 1


@takes_options
def portrait(
    laws: Annotated[
        list[str],
        typer.Argument(
            metavar="LAW...", help="Laws by name, or all.", autocompletion=names_of("controllers", besides=("all",))
        ),
    ],
    folder: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="DIR", help="Write DIR/LAW.png for each law.")
    ] = None,
    *,
    words: PortraitWords,
    markdown: Annotated[bool, typer.Option("--markdown", help="Print the tables as a page has them.")] = False,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Show what each law does: a step, a circle, a push, forces on a wall; ideal and nominal limb.

    Gains are those recommended for the limb, unless they are matched to a reference.
    """
    from ...limb_bench.entries import read_law
    from ...limb_bench.portrait import Portraits, paint_portraits
    from ...regular_files import make_folder

    if folder is not None:
        make_folder(folder)
    matched = None if words.reference is None else read_law(words.reference)
    portraits = paint_portraits(
        () if laws == ["all"] else laws,
        robot=words.robot,
        limb=words.limb,
        matched=matched,
        match=words.match.value,
        seed=words.seed,
    )
    if folder is not None:
        for each in portraits:
            each.write(folder / f"{each.law}.png")
    if as_json:
        print_json(Portraits(seed=words.seed, laws=tuple(portraits)))
    elif markdown:
        print_markdown(portraits)
    else:
        print_portraits(stdout(), portraits, folder)


def print_markdown(portraits: "Sequence[Portrait]") -> None:
    """Print the rows of motions, and after an empty line those of forces, as docs/controllers.md has them."""
    rows = ["| " + " | ".join(each.row()) + " |" for each in portraits]
    forces = ["| " + " | ".join(row) + " |" for each in portraits for row in each.force_rows()]
    sys.stdout.write("\n".join([*rows, *(["", *forces] if forces else [])]) + "\n")


def print_portraits(console: Console, portraits: "Sequence[Portrait]", folder: Path | None = None) -> None:
    """Print every law's figures."""
    opt.show_table(console, ("law", *GAINS), [each.gains_row() for each in portraits])
    console.print()
    opt.show_table(console, ("law", *NUMBERS), [each.row() for each in portraits])
    console.print()
    console.print("ideal: friction alone; nom.: backlash, encoders, delay too; all in truth, in mm")
    console.print("step: most across, of 2 cm; circle: radial RMS, last lap of 3 s; fed: with the")
    console.print("aim's acceleration and friction fed forward; push: yielding along 10 N")
    rows = [row for each in portraits for row in each.force_rows()]
    if rows:
        console.print()
        opt.show_table(console, ("law", "joint friction", *ERRORS), rows, ("law", "joint friction"))
        console.print()
        console.print(f"errors of {portraits[0].task.force:g} N on a wall, standing and sliding")
    if folder is not None:
        console.print(f"pictures written to {folder}", soft_wrap=True)
