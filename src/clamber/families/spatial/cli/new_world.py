"""`clamber new world`: a world in space to start from."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Final

import typer

from ....json_form import Count
from ....terminal.name_completion import names_of
from ....terminal.options import AsJson, takes_options
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
    left_out: Annotated[
        float, typer.Option("--left-out", min=0.0, max=0.95, help="Share of holds that are missing, at random.")
    ] = 0.0
    seed: Annotated[int, typer.Option(min=0, help="Same seed, same world, on any machine.")] = 0
    force: Annotated[bool, typer.Option("--force", help="Write over a file that is there.")] = False
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="File to write.")] = Path("world.toml")
    as_json: AsJson = False


@takes_options
def world(
    kind: Annotated[Kind, typer.Argument(help="What to make.")] = Kind.wall,
    *,
    words: WorldOptions,
) -> None:
    """Write a world in space, sized for a robot, whose file tells of every key: stones, a wall, an overhang, a corner, a chimney."""
    check_new(words.output, words.force)
    from ....files import write_atomically
    from ..planning.first_task import fit_named
    from ..world.made import Fit, Wanted, world_data
    from .world_text import angle, checked_world, length, world_text

    if words.angle is not None and kind not in (Kind.slope, Kind.overhang):
        raise typer.BadParameter("is of slope and overhang", param_hint="--angle")
    if words.gap is not None and kind is not Kind.chimney:
        raise typer.BadParameter("is of chimney", param_hint="--gap")
    wanted = Wanted(
        kind=kind,
        length=length("--length", words.length),
        width=length("--width", words.width),
        spacing=length("--spacing", words.spacing),
        bumps=length("--bumps", words.bumps, least=0.0),
        gap=length("--gap", words.gap),
        angle=angle("--angle", words.angle),
        left_out=words.left_out,
        seed=words.seed,
    )
    data = world_data(wanted, Fit() if words.robot is None else fit_named(words.robot), name_of(words.output, "world"))
    built, long = checked_world(data)
    write_atomically(words.output, world_text(data, words.output))
    made = NewWorld(
        written={"world": str(words.output)}, name=built.name, holds=len(built.holds), length_m=round(long, 6)
    )
    if words.as_json:
        print_json(made)
        return
    robot = words.robot or "NAME|FILE"
    told = f"{built.title}: {made.holds} holds"
    print_new(
        made.written, told, f"clamber show {words.output}; clamber new task --robot {robot} --world {words.output}"
    )


PRINTED: Final = {"new world": NewWorld}
"""What it prints with `--json`."""
