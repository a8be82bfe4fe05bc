"""`clamber sweep`: plan a task at many values of one or two of its keys."""

from pathlib import Path
from typing import Annotated

import typer

from .options import AsJson, Output, Overrides, Quiet
from .output import announce_compilation, check_writable, print_json, stderr, stdout


def sweep(
    task: Annotated[str, typer.Argument(help="A task's name (`clamber list tasks`), or the path of its TOML file.")],
    vary: Annotated[
        list[str] | None,
        typer.Option(metavar="KEY=LOW..HIGH:N", help="A key and its range, such as motor.torque_limit=10Nm..21Nm:12."),
    ] = None,
    values: Annotated[
        list[str] | None, typer.Option(metavar="KEY=A,B,C", help="A key and its values, such as board=ladder,h.")
    ] = None,
    planner: Annotated[str, typer.Option(help="How to search (`clamber list planners`).")] = "exact",
    overrides: Overrides = None,
    seed: Annotated[int, typer.Option(min=0, help="Of the genetic planner.")] = 0,
    evaluations: Annotated[int, typer.Option(min=1, help="Most plans that the genetic planner tries.")] = 50_000,
    stances: Annotated[int, typer.Option(min=1, help="Most stances that the exact planner keeps.")] = 2_000_000,
    workers: Annotated[int | None, typer.Option(min=1, help="Processes; one a core unless given.")] = None,
    store: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Keep each point as it ends (SQLite), to resume from.")
    ] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Go on with --store: what is finished stays.")] = False,
    output: Output = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Plan at every point of a range: where a plan exists, how long the shortest is, how hard it loads the joints."""
    check_writable(output)
    if resume and store is None:
        raise typer.BadParameter("needs --store, the file to go on with", param_hint="--resume")
    pictured = output is not None and output.suffix.lower() != ".csv"
    if pictured and output is not None:
        from ..viewing.output import CANVASES, check_suffix

        check_suffix(output, (".csv", *CANVASES))
    from ..planning.axes import check_axes, range_axis, values_axis

    axes = [*map(range_axis, vary or ()), *map(values_axis, values or ())]
    check_axes(axes)
    from .sweep_text import SweepLine, announced_loop, print_sweep, worker_count

    announce_compilation(announced_loop(planner), quiet=quiet)
    from ..planning.budgets import accepts
    from ..planning.sweep import run_sweep

    stated = {"max_evaluations": evaluations, "max_stances": stances}
    limits = {"seed": seed} | {option: most for option, most in stated.items() if accepts(planner, option)}
    result = run_sweep(
        task,
        axes,
        overrides=overrides or (),
        planner=planner,
        options=limits,
        workers=worker_count(workers),
        store=store,
        resume=resume,
        progress=SweepLine(stderr(), quiet=quiet).update,
    )
    if pictured and output is not None:
        from ..viewing.sweep_plot import draw_sweep

        draw_sweep(result, output)
    elif output is not None:
        result.save_table(output)
    if as_json:
        print_json(result.to_json())
    else:
        print_sweep(stdout(), result, output)
    raise typer.Exit(0 if result.found else 1)
