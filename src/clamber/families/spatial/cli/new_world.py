"""`clamber new world`: a world in space to start from."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Final

import typer

from ....json_form import Count
from ....terminal.name_completion import names_of
from ....terminal.options import AsJson, Force, takes_options
from ....terminal.output import check_new, name_of, print_json, print_new
from ..world.made import Kind

LENGTH: Final = "LENGTH"
SIZED: Final = "such as 2m; by the robot's reach unless given."


@dataclass(frozen=True, slots=True, kw_only=True)
class NewWorld:
    """A world that was written."""

    written: dict[str, str]
    """world, to the file."""
    name: str
    holds: Count
    length_m: float
    """Of the guide."""


@dataclass(frozen=True, slots=True)
class WorldOptions:
    """Options of `clamber new world`, as they came."""

    robot: Annotated[
        str | None,
        typer.Option(
            metavar="NAME|FILE",
            help="Robot in space by whose reach all is sized; `gripper-climber` unless given.",
            autocompletion=names_of("robots"),
        ),
    ] = None
    length: Annotated[str | None, typer.Option(metavar=LENGTH, help=f"Of the guide, {SIZED}")] = None
    width: Annotated[str | None, typer.Option(metavar=LENGTH, help=f"Of the surface, {SIZED}")] = None
    spacing: Annotated[str | None, typer.Option(metavar=LENGTH, help=f"Of the holds, {SIZED}")] = None
    bumps: Annotated[str | None, typer.Option(metavar=LENGTH, help=f"Height of bumps, {SIZED}")] = None
    gap: Annotated[str | None, typer.Option(metavar=LENGTH, help=f"Between a chimney's walls, {SIZED}")] = None
    angle: Annotated[
        str | None,
        typer.Option(
            metavar="ANGLE",
            help="Of a slope from level, 30 deg unless given; of an overhang from the vertical, 60 deg unless given.",
        ),
    ] = None
    table: Annotated[
        Path | None,
        typer.Option(
            "--table", metavar="FILE", help="In place of a kind: holds of a CSV file, x [m],y,z,nx,ny,nz a line."
        ),
    ] = None
    heights: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="In place of a kind: a height map, .png in grey, .npy or .csv; with --size."),
    ] = None
    mesh: Annotated[
        Path | None, typer.Option(metavar="FILE", help="In place of a kind: a mesh, .stl, .obj or .ply.")
    ] = None
    points: Annotated[
        Path | None, typer.Option(metavar="FILE", help="In place of a kind: a cloud of points, .csv, .npy or .ply.")
    ] = None
    size: Annotated[
        str | None, typer.Option(metavar="X,Y", help="Of a height map along its columns and rows, such as 4m,2m.")
    ] = None
    scale: Annotated[
        str | None,
        typer.Option(metavar=LENGTH, help="Of a value of 1 in a terrain's file, of a PNG's white; 1 m unless given."),
    ] = None
    slope: Annotated[
        str | None, typer.Option(metavar="ANGLE", help="Largest angle of a hold's normal from the terrain's z.")
    ] = None
    left_out: Annotated[
        float, typer.Option("--left-out", min=0.0, max=0.95, help="Share of holds that are missing, at random.")
    ] = 0.0
    seed: Annotated[int, typer.Option(min=0, help="Same seed, same world, on any machine.")] = 0
    force: Force = False
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="File to write.")] = Path("world.toml")
    as_json: AsJson = False

    def check(self, kind: Kind | None) -> None:
        """Make sure that they go together."""
        files = {f"--{name}": getattr(self, name) for name in SOURCES}
        given = [name for name, value in files.items() if value is not None]
        if len(given) + (kind is not None) > 1:
            raise typer.BadParameter(
                "are different ways to a world; take one", param_hint=", ".join(("kind", *SOURCES))
            )
        of_kinds = ("length", "width", "bumps", "gap", "angle")
        of_files = ("size", "scale", "slope")
        for name in of_kinds if given else of_files:
            if getattr(self, name) is not None:
                where = "worlds that are made" if given else "files of terrain"
                raise typer.BadParameter(f"is of {where}", param_hint=f"--{name}")
        if self.table is not None and (self.spacing or self.size or self.scale or self.slope):
            raise typer.BadParameter("states its holds itself", param_hint="--table")
        if (self.heights is None) != (self.size is None):
            raise typer.BadParameter("go together: the size of the map", param_hint="--heights, --size")
        if self.angle is not None and kind not in (Kind.slope, Kind.overhang):
            raise typer.BadParameter("is of slope and overhang", param_hint="--angle")
        if self.gap is not None and kind is not Kind.chimney:
            raise typer.BadParameter("is of chimney", param_hint="--gap")


SOURCES: Final = ("table", "heights", "mesh", "points")
"""Options that name a file with the world in it."""


@takes_options
def world(
    kind: Annotated[Kind | None, typer.Argument(help="What to make; wall unless given.")] = None,
    *,
    words: WorldOptions,
) -> None:
    """Write a world in space, sized for a robot, whose file tells of every key: made up, or of holds or a terrain in a file."""
    words.check(kind)
    check_new(words.output, words.force)
    from ....files import write_atomically
    from ..planning.first_task import fit_named
    from ..world.made import Fit
    from .world_text import checked_world, made_data, read_data, world_text

    fit, name = Fit() if words.robot is None else fit_named(words.robot), name_of(words.output, "world")
    source = next((key for key in SOURCES if getattr(words, key) is not None), None)
    data = made_data(words, kind or Kind.wall, fit, name) if source is None else read_data(words, source, fit, name)
    built, long = checked_world(data, words.output.parent)
    write_atomically(words.output, world_text(data, words.output))
    made = NewWorld(
        written={"world": str(words.output)}, name=built.name, holds=len(built.holds), length_m=round(long, 6)
    )
    if words.as_json:
        print_json(made)
        return
    robot = words.robot or "ROBOT"
    told = f"{built.title}: {made.holds} holds"
    print_new(
        made.written, told, f"clamber show {words.output}; clamber new task --robot {robot} --world {words.output}"
    )


PRINTED: Final = {"new world": NewWorld}
"""What it prints with `--json`."""
