"""`clamber calibrate`: sizes of a two-frame mechanism from its published range of angles and longest step, with the rival fits."""

from typing import TYPE_CHECKING, Annotated

import typer

from ....terminal.live_line import LiveLine
from ....terminal.options import AsJson, Quiet
from ....terminal.output import print_json, stderr, stdout
from ....viewing.text_table import plain_table

if TYPE_CHECKING:
    from ..robot.calibration import Fit


def calibrate(
    least: Annotated[
        str, typer.Option(metavar="ANGLE", help="Least angle of the Y-frame in the Delta-frame.")
    ] = "-18 deg",
    most: Annotated[str, typer.Option(metavar="ANGLE", help="Largest angle of it.")] = "48 deg",
    step: Annotated[str, typer.Option(metavar="LENGTH", help="Longest step.")] = "160 mm",
    direction: Annotated[str, typer.Option(metavar="ANGLE", help="Its direction, up to 60 deg.")] = "30 deg",
    stroke: Annotated[str, typer.Option(metavar="LENGTH", help="Stroke of the actuators.")] = "250 mm",
    seeds: Annotated[int, typer.Option(min=1, help="Random starts of every family of fits.")] = 8,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Fit a walker's unprinted sizes to what is printed of it, and list what else fits as well.

    The numbers are those of Hoshino and others unless given, their angles mirrored to grow with the region.
    """
    from ....units import parse_quantity
    from ..robot.calibration import HOSHINO_1995, Published, fit_families

    published = Published(
        least=parse_quantity(least, "angle"),
        most=parse_quantity(most, "angle"),
        step=parse_quantity(step, "length"),
        direction=parse_quantity(direction, "angle"),
        stroke=parse_quantity(stroke, "length"),
    )
    if not published.least < 0.0 < published.most:
        raise typer.BadParameter("must be on either side of 0 deg", param_hint="--least, --most")
    if published.step <= 0.0 or published.stroke <= 0.0:
        raise typer.BadParameter("must be more than 0", param_hint="--step, --stroke")
    with LiveLine(stderr(), quiet=quiet, doing="preparing the fits") as line:
        found = fit_families(published, range(seeds), progress=line.counting("fit"))
    if as_json:
        print_json(found)
        return
    console = stdout()
    columns = ("R", "R_y", "offset", "drawn", "least", "most", "step", "misfit")
    table = plain_table("free", *columns, right=columns)
    for number, rivals in enumerate(found, 1):
        for k, fit in enumerate(rivals.fits):
            table.add_row(f"({number})" if k == 0 else "", *_numbers(fit))
    console.print(table)
    for number, rivals in enumerate(found, 1):
        console.print(
            f"({number}) {rivals.good} of {rivals.seeds} starts: {rivals.family.name}; step: {rivals.family.reading}"
        )
    console.print(
        "R, R_y: radii of the circles; drawn: length of an actuator drawn in. Lengths in mm, angles in deg. starts: how many came as near. "
        "misfit: largest difference from what is given, in half last places (0.5 deg, 0.5 mm); 1 and below rounds to it."
    )
    if published == HOSHINO_1995:
        console.print("Best directions turn with the whole mechanism, so they tell no fit from another.")


def _numbers(fit: "Fit") -> tuple[str, ...]:
    from ....units import DEGREE

    sizes, mm = fit.sizes, 1e3
    return (
        f"{sizes.radius * mm:.1f}",
        f"{sizes.radius * sizes.ratio * mm:.1f}",
        f"{sizes.offset / DEGREE:.1f}",
        f"{sizes.shortest * mm:.1f}",
        f"{fit.least / DEGREE:.1f}",
        f"{fit.most / DEGREE:.1f}",
        f"{fit.step * mm:.1f}",
        f"{fit.misfit:.2f}",
    )
