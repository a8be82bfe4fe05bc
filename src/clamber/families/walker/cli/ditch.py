"""`clamber ditch`: the widest ditch that a walker crosses, and the slides that cross one."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import typer

from ....terminal.name_completion import names_of
from ....terminal.options import AsJson, Output, takes_options
from ....terminal.output import check_writable, print_json, stdout
from ....viewing.text_table import plain_table

if TYPE_CHECKING:
    from ..robot.ditch import Footing
    from ..robot.ditch_plan import Crossing

MM = 1e3


@dataclass(frozen=True, slots=True)
class WidestDitch:
    """The widest ditch that is crossed at one angle of the frames."""

    theta_deg: float
    widest_m: float
    direction_deg: float
    """In which."""
    least_over_directions_m: float
    """In the worst direction."""


@dataclass(frozen=True, slots=True)
class Crossed:
    """The ditch, and where the walker is before it."""

    width: Annotated[
        str | None, typer.Option(metavar="LENGTH", help="Cross a ditch as wide; else tell the widest.")
    ] = None
    before: Annotated[str, typer.Option(metavar="LENGTH", help="Where it starts, before the near edge.")] = "350 mm"
    heading: Annotated[str, typer.Option(metavar="ANGLE", help="Of the Delta-frame to the crossing direction.")] = (
        "0 deg"
    )
    theta: Annotated[str, typer.Option(metavar="ANGLE", help="Of the Y-frame in the Delta-frame at the start.")] = (
        "0 deg"
    )
    reserve: Annotated[str, typer.Option(metavar="LENGTH", help="How much wider it must still get across.")] = "0 mm"


@takes_options
def ditch(
    robot: Annotated[
        str,
        typer.Argument(
            help="A walker's name (`clamber list robots`), or its TOML file.", autocompletion=names_of("robots")
        ),
    ] = "hoshino",
    *,
    crossed: Crossed,
    margin: Annotated[str, typer.Option(metavar="LENGTH", help="Centre of mass inside the standing feet.")] = "0 mm",
    straight: Annotated[bool, typer.Option("--straight", help="No sidesteps along the ditch.")] = False,
    as_json: AsJson = False,
    output: Output = None,
) -> None:
    """Tell how wide a ditch a walker crosses, by the angle of its frames; with --width, plan a crossing, pivots first."""
    from ....errors import SpecError
    from ....tasks.robots import load_robot
    from ....units import parse_quantity
    from ..robot import WalkerRobot
    from ..robot.ditch import Footing
    from ..robot.ditch_plan import cross_ditch

    check_writable(output)
    made = load_robot(robot)
    if not isinstance(made, WalkerRobot):
        raise SpecError(f"robot '{made.name}'", "family", made.name, "must be a two-frame walker")
    footing = Footing.of(made, margin=parse_quantity(margin, "length"))
    if crossed.width is None:
        _tell_widest(footing, not straight, as_json, output)
        return
    found = cross_ditch(
        footing,
        parse_quantity(crossed.width, "length"),
        before=parse_quantity(crossed.before, "length"),
        heading=parse_quantity(crossed.heading, "angle"),
        theta=parse_quantity(crossed.theta, "angle"),
        reserve=parse_quantity(crossed.reserve, "length"),
        aside=not straight,
    )
    if output is not None and found.status == "found":
        from ..pictures.mechanism_plots import draw_crossing

        draw_crossing(found, output)
    if as_json:
        print_json(found)
    elif found.status == "found":
        _tell_crossing(found)
    else:
        stdout().print(f"impossible: {found.reason}")
    if found.status != "found":
        raise typer.Exit(1)


def _tell_widest(footing: "Footing", aside: bool, as_json: bool, output: Output) -> None:
    import numpy as np

    from ....units import DEGREE
    from ..robot.ditch import ditch_map
    from ..robot.turning import turning_range

    turn = turning_range(footing.frames, (0.0, 0.0, 0.0), guard=footing.guard or None)
    thetas = np.arange(math.ceil(turn.least / DEGREE), math.floor(turn.most / DEGREE) + 1.0)
    directions = np.arange(0.0, 361.0)
    widths = ditch_map(footing, thetas * DEGREE, directions * DEGREE, aside=aside)
    if output is not None:
        from ..pictures.mechanism_plots import draw_ditch_maps

        title = "with sidesteps" if aside else "straight"
        draw_ditch_maps(thetas.tolist(), directions.tolist(), {title: widths * MM}, output)
    best = [int(row.argmax()) for row in widths]
    rows = [
        WidestDitch(float(theta), float(row[k]), float(directions[k]), float(row.min()))
        for theta, row, k in zip(thetas, widths, best, strict=True)
    ]
    if as_json:
        print_json(rows)
        return
    columns = ("theta [deg]", "widest [mm]", "along [deg]", "least of all directions [mm]")
    table = plain_table(*columns, right=columns)
    for row in rows:
        table.add_row(
            f"{row.theta_deg:g}",
            f"{row.widest_m * MM:.1f}",
            f"{row.direction_deg:g}",
            f"{row.least_over_directions_m * MM:.1f}",
        )
    stdout().print(table)


def _tell_crossing(found: "Crossing") -> None:
    from ....units import DEGREE

    console = stdout()
    console.print(
        f"{found.pivots} pivots, {len(found.slides) - found.pivots} slides at theta = {found.theta / DEGREE:.4g} deg along "
        f"{found.direction / DEGREE:.4g} deg of the Delta-frame, where {found.widest * MM:.1f} mm could be crossed"
    )
    columns = ("x [mm]", "y [mm]", "angle [deg]", "stroke [mm]", "singular [-]", "balance [mm]", "feet [mm]")
    table = plain_table("slide", "frame to", *columns, right=("slide", *columns))
    for k, (slide, margins) in enumerate(zip(found.slides, found.replay(), strict=True), 1):
        x, y, angle = slide.way[-1]
        table.add_row(
            str(k),
            ("Delta", "Y")[slide.frame],
            f"{round(x * MM, 1) + 0.0:.1f}",
            f"{round(y * MM, 1) + 0.0:.1f}",
            f"{angle / DEGREE:.2f}",
            f"{margins.stroke * MM:.1f}",
            f"{margins.singular:.3f}",
            f"{margins.balance * MM:.1f}",
            f"{margins.foothold * MM:.1f}",
        )
    console.print(table)
    console.print("x across the ditch from its near edge; the last four columns are margins, the worst of each slide.")
