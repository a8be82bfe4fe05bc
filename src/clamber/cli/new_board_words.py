"""The options of `clamber new board`."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Final, TypeAlias

import typer

from .name_completion import names_of
from .options import AsJson

LIKE: Final = "Start from this one in place of a made-up one."
Force: TypeAlias = Annotated[bool, typer.Option("--force", help="Write over a file that is there.")]


@dataclass(frozen=True, slots=True)
class BoardWords:
    """Options of `clamber new board`, as they came."""

    random: Annotated[bool, typer.Option("--random", help="Holds scattered at random, the same for the same seed.")] = (
        False
    )
    csv: Annotated[Path | None, typer.Option("--csv", metavar="FILE", help="Holds of a table: x, y per line.")] = None
    unit: Annotated[str | None, typer.Option(help="Of that table, such as cm, where its header names none.")] = None
    pixels: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Holds marked in a picture: x, y per line in pixels, y down.")
    ] = None
    scale: Annotated[str | None, typer.Option(help="Size of such a pixel on the wall, such as 3.2mm.")] = None
    origin: Annotated[
        str | None,
        typer.Option(metavar="X,Y", help="Pixel of the board's origin; unless given, left of and below all holds."),
    ] = None
    radius: Annotated[str | None, typer.Option(help="Of holds of a table or a picture, such as 5mm.")] = None
    like: Annotated[str | None, typer.Option(metavar="NAME|FILE", help=LIKE, autocompletion=names_of("boards"))] = None
    holds: Annotated[int, typer.Option(help="How many random holds.")] = 100
    density: Annotated[str, typer.Option(help="Holds per m^2, or with a unit, such as '2 holds/ft^2'.")] = "20"
    width: Annotated[str | None, typer.Option(help="Of the wall, such as 3m; as wide as high unless given.")] = None
    least_gap: Annotated[
        str | None,
        typer.Option(help="Least distance of two holds, such as 8cm; half of the mean distance unless given."),
    ] = None
    seed: Annotated[int, typer.Option(min=0, help="Same seed, same board, on any machine.")] = 0
    listed: Annotated[
        bool, typer.Option("--listed", help="List every hold, to edit them, and not how they were scattered.")
    ] = False
    task: Annotated[
        bool, typer.Option("--task", help="Write a task to FILE, to the top of the board, and the board beside it.")
    ] = False
    overrides: Annotated[
        list[str] | None,
        typer.Option(
            "--set", metavar="KEY=VALUE", help="Change one key of that task, such as robot=gecko4 or rules.max_hangs=0."
        ),
    ] = None
    force: Force = False
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="File to write.")] = Path("wall.toml")
    as_json: AsJson = False

    def check(self) -> None:
        """Make sure that they go together."""
        sources = {"--random": self.random, "--csv": self.csv, "--pixels": self.pixels, "--like": self.like}
        given = [name for name, value in sources.items() if value]
        if len(given) > 1:
            raise typer.BadParameter("are different ways to a board; take one", param_hint=", ".join(given))
        for flag, value, way in (
            ("--unit", self.unit, "--csv"),
            ("--scale", self.scale, "--pixels"),
            ("--origin", self.origin, "--pixels"),
        ):
            if value is not None and way not in given:
                raise typer.BadParameter(f"is for {way}", param_hint=flag)
        if self.pixels is not None and self.scale is None:
            raise typer.BadParameter("needs the size of a pixel: --scale 3.2mm", param_hint="--pixels")
        if self.radius is not None and not (self.csv or self.pixels):
            raise typer.BadParameter("is for --csv and --pixels", param_hint="--radius")
        if self.overrides and not self.task:
            raise typer.BadParameter("changes the task; it needs --task", param_hint="--set")

    @property
    def board_file(self) -> Path:
        """Where the board goes: beside its task, if there is one."""
        return self.output.with_name(f"{self.output.stem}-board.toml") if self.task else self.output
