"""`clamber limb portrait`: one picture and one line of figures for each law, for docs/controllers.md."""

from pathlib import Path
from typing import Annotated

import typer

from . import limb_options as opt
from .options import AsJson, Quiet
from .output import announce_compilation, print_json, stdout


def portrait(
    laws: Annotated[list[str], typer.Argument(metavar="LAW...", help="Laws by name, or all.")],
    folder: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="DIR", help="Write DIR/LAW.png for each law.")
    ] = None,
    kp: Annotated[float, typer.Option(help="Stiffness of SCCT, which the others are matched to.")] = 200.0,
    kd: Annotated[float, typer.Option(help="Its damping.")] = 10.0,
    match: opt.Matched = opt.MatchChoice.yy,
    robot: opt.Robot = "libra",
    limb: opt.LimbName = None,
    seed: Annotated[int, typer.Option(min=0, help="Draws play and encoder phase of the nominal limb.")] = 1,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Show what each law does: a step, a circle, a push, forces on a wall; ideal and nominal limb, matched gains."""
    from ..experiments.limb.portrait import paint_portraits, portraits_json
    from .limb_portrait_text import check_folder, draw_portraits, print_portraits

    check_folder(folder)
    announce_compilation("drive", quiet=quiet)
    portraits = paint_portraits(
        () if laws == ["all"] else laws, robot=robot, limb=limb, kp=kp, kd=kd, match=match.value, seed=seed
    )
    if folder is not None:
        draw_portraits(portraits, folder)
    if as_json:
        print_json(portraits_json(portraits, seed))
    else:
        print_portraits(stdout(), portraits, folder)
