"""`clamber plan`: find a plan for a task."""

from pathlib import Path
from typing import Annotated, Any

import typer

from ..errors import UnknownNameError
from .options import AsJson, Output, Overrides, Quiet
from .output import announce_compilation, check_writable, print_json, stderr, stdout


def plan(
    task: Annotated[str, typer.Argument(help="A task's name (`clamber list tasks`), or the path of its TOML file.")],
    planner: Annotated[str, typer.Option(help="How to search (`clamber list planners`).")] = "genetic",
    profile: Annotated[str, typer.Option(help="The planner's settings: default, or thesis.")] = "default",
    overrides: Overrides = None,
    seed: Annotated[int, typer.Option(min=0, help="Same seed, same plan, on any number of threads.")] = 0,
    threads: Annotated[int | None, typer.Option(min=1, help="Threads; one a core unless given.")] = None,
    evaluations: Annotated[int, typer.Option(min=1, help="Most whole plans to try.")] = 50_000,
    seconds: Annotated[float | None, typer.Option(min=0.0, help="Most time to take.")] = None,
    checkpoint: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write the state of the search here, and go on from it.")
    ] = None,
    macros: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Learned modules to add (`clamber learn -o`).")
    ] = None,
    width: Annotated[int | None, typer.Option(min=1, help="Stances that a beam keeps of each layer.")] = None,
    max_stances: Annotated[int | None, typer.Option(min=1, help="Memory of the hybrid's exact search.")] = None,
    history: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw how the fitness grew (png, svg, pdf).")
    ] = None,
    output: Output = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Find a sequence of grabs and body moves that every check allows, from the start to the goal."""
    check_writable(output)
    check_writable(checkpoint)
    check_writable(history)
    from ..tasks import load_task

    problem = load_task(task, overrides or ())
    announce_compilation("rollout", quiet=quiet)
    from ..planning.learning import load_macros
    from ..planning.planners import PLANNERS
    from .plan_text import ProgressLine, print_result

    if planner not in PLANNERS:
        raise UnknownNameError("planner", planner, tuple(PLANNERS))
    options: dict[str, Any] = {"seed": seed, "seconds": seconds, "threads": threads}
    if planner == "genetic":
        learned = () if macros is None else load_macros(macros)
        options |= {"profile": profile, "max_evaluations": evaluations, "macros": learned, "checkpoint": checkpoint}
    elif checkpoint is not None or macros is not None or history is not None:
        raise typer.BadParameter(
            "only the genetic planner takes --checkpoint, --macros and --history", param_hint="--planner"
        )
    if width is not None:
        if planner != "beam":
            raise typer.BadParameter("only the beam planner takes --width", param_hint="--planner")
        options["width"] = width
    if planner == "hybrid":
        options |= {"profile": profile, "max_evaluations": evaluations}
    if max_stances is not None:
        if planner != "hybrid":
            raise typer.BadParameter("only the hybrid planner takes --max-stances", param_hint="--planner")
        options["max_stances"] = max_stances
    with ProgressLine(stderr(), quiet=quiet) as line:
        result = PLANNERS[planner](problem, progress=line.update, **options)
    if output is not None:
        result.plan.save(output)
    if history is not None:
        from ..viewing.charts import draw_history

        draw_history(result.history, history, goals=[goal.name for goal in problem.goals])
    if as_json:
        print_json(result.to_json())
    else:
        print_result(stdout(), result, output)
    raise typer.Exit(0 if result.has_plan else 1)
