"""`clamber reach`: everything that a robot can ever reach."""

from typing import Annotated

import typer

from .options import AsJson, Output, Overrides, Quiet, TaskName
from .output import announce_compilation, check_writable, print_json, stderr, stdout


def reach(
    task: TaskName,
    layer: Annotated[
        str | None,
        typer.Option(help="What to show of every place: force, payload, power, margin or steps.", show_default=False),
    ] = None,
    hangs: Annotated[
        bool, typer.Option("--hangs", help="Let hangs count as the task's rules have them; the space may have no end.")
    ] = False,
    overrides: Overrides = None,
    stances: Annotated[int, typer.Option(min=1, help="Memory: most stances to keep.")] = 8_000_000,
    seconds: Annotated[float | None, typer.Option(min=0.0, help="Most time to take.")] = None,
    threads: Annotated[int | None, typer.Option(min=1, help="Threads; one a core unless given.")] = None,
    output: Output = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Map every pose and hold that the robot can get to, and what it costs to be there (picture, or .csv of the poses)."""
    check_writable(output)
    pictured = output is not None and output.suffix.lower() != ".csv"
    if pictured and output is not None:
        from ..viewing.output import CANVASES, check_suffix

        check_suffix(output, (".csv", *CANVASES))
    from ..tasks import load_task

    loaded = load_task(task, overrides or ())
    from ..planning.reach.layers import choose_layer

    shown = choose_layer(loaded, layer)
    announce_compilation(quiet=quiet)
    from ..planning.reach.reach import find_reach
    from .reach_text import FloodLine, print_reach

    with FloodLine(stderr(), quiet=quiet) as line:
        result = find_reach(
            loaded, hangs=hangs, max_stances=stances, seconds=seconds, threads=threads, progress=line.update
        )
    if pictured and output is not None:
        from ..viewing.reach_plot import draw_reach

        draw_reach(result, shown, output)
    elif output is not None:
        result.save_table(output)
    if as_json:
        print_json(result)
    else:
        print_reach(stdout(), result, shown, output)
    raise typer.Exit(0 if result.status == "complete" else 1)
