"""`clamber limb portrait`: one picture and one line of figures for each law, for docs/controllers.md."""

from pathlib import Path
from typing import Annotated

import typer

from ..name_completion import names_of
from ..options import ROBOT, AsJson, Quiet
from ..output import announce_compilation, print_json, stdout
from . import options as opt


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
    reference: Annotated[
        str | None,
        typer.Option(
            metavar="NAME[:KEY=VALUE,...]",
            help="Match gains to this law, such as scct:kp=200,kd=10.",
            autocompletion=names_of("controllers"),
        ),
    ] = None,
    match: opt.Matched = opt.MatchChoice.yy,
    robot: opt.Robot = ROBOT,
    limb: opt.LimbName = None,
    seed: Annotated[int, typer.Option(min=0, help="Draws play and encoder phase of the nominal limb.")] = 1,
    markdown: Annotated[bool, typer.Option("--markdown", help="Print the tables as a page has them.")] = False,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Show what each law does: a step, a circle, a push, forces on a wall; ideal and nominal limb.

    Gains are those recommended for the limb, unless they are matched to a reference.
    """
    from ...limb_bench.entries import read_law
    from ...limb_bench.portrait import paint_portraits, portraits_json
    from ...regular_files import make_folder
    from .portrait_text import draw_portraits, print_markdown, print_portraits

    if folder is not None:
        make_folder(folder)
    announce_compilation(quiet=quiet)
    matched = None if reference is None else read_law(reference)
    portraits = paint_portraits(
        () if laws == ["all"] else laws, robot=robot, limb=limb, matched=matched, match=match.value, seed=seed
    )
    if folder is not None:
        draw_portraits(portraits, folder)
    if as_json:
        print_json(portraits_json(portraits, seed))
    elif markdown:
        print_markdown(portraits)
    else:
        print_portraits(stdout(), portraits, folder)
