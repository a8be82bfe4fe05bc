"""`clamber plan`: find a plan for a task."""

from pathlib import Path
from typing import Annotated, Any

import typer

from .options import AsJson, Output, Overrides, PlannerName, Quiet, Ray, TaskName, Workers
from .output import announce_compilation, check_writable, print_json, stderr, stdout


def plan(
    task: TaskName,
    planner: PlannerName = "genetic",
    profile: Annotated[str, typer.Option(help="The planner's settings: default, or thesis.")] = "default",
    overrides: Overrides = None,
    seed: Annotated[int, typer.Option(min=0, help="Same seed, same plan, on any number of threads.")] = 0,
    threads: Annotated[int | None, typer.Option(min=1, help="Threads; one a core unless given.")] = None,
    evaluations: Annotated[int, typer.Option(min=1, help="Most whole plans to try.")] = 50_000,
    checks: Annotated[
        int | None, typer.Option(min=1, help="Most single actions to judge, for planners that count them.")
    ] = None,
    seconds: Annotated[float | None, typer.Option(min=0.0, help="Most time to take.")] = None,
    checkpoint: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write the state of the search here, and go on from it.")
    ] = None,
    macros: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Learned modules to add (`clamber learn -o`).")
    ] = None,
    minimize: Annotated[
        str | None,
        typer.Option(
            metavar="COSTS",
            help="Of the exact planner, the first one first: length; energy, torque of climbers; time, strain of walkers.",
        ),
    ] = None,
    pareto: Annotated[
        str | None, typer.Option(metavar="COST,COST", help="Every plan that no other beats in both of two costs.")
    ] = None,
    stances: Annotated[
        int | None, typer.Option(min=1, help="Most stances that exact searches keep (8 million: 2 GB).")
    ] = None,
    width: Annotated[int | None, typer.Option(min=1, help="Stances that a beam keeps of each layer.")] = None,
    islands: Annotated[
        int | None, typer.Option(min=1, help="Genetic populations at once, each in a worker; the shortest plan wins.")
    ] = None,
    workers: Workers = None,
    ray: Ray = None,
    history: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw how the fitness grew (png, svg, pdf).")
    ] = None,
    openings: Annotated[
        bool, typer.Option(help="Where no plan is proved: look for the smallest changes of the task that open it.")
    ] = True,
    openings_seconds: Annotated[float, typer.Option(min=0.0, help="Most time for that.")] = 60.0,
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
    from ..planning.budgets import accepts
    from ..planning.learning import load_macros
    from ..planning.planners import PROVERS, find_planner
    from .openings import Seeker
    from .plan_text import ProgressLine, print_result

    search = find_planner(planner)
    announce_compilation(quiet=quiet)
    if pareto is not None:
        from .front import front

        raise typer.Exit(front(problem, pareto, seconds, threads, stances, output, as_json=as_json, quiet=quiet))
    from ..planning.exact.costs import read_costs

    stated = {
        "--checks": ("max_checks", checks),
        "--checkpoint": ("checkpoint", checkpoint),
        "--macros": ("macros", None if macros is None else load_macros(macros)),
        "--minimize": ("minimize", None if minimize is None else read_costs("--minimize", minimize)),
        "--stances": ("max_stances", stances),
        "--width": ("width", width),
    }
    usual = {"seed": seed, "seconds": seconds, "threads": threads, "profile": profile, "max_evaluations": evaluations}
    options: dict[str, Any] = {name: value for name, value in usual.items() if accepts(planner, name)}
    for flag, (name, value) in stated.items():
        if value is not None and not accepts(planner, name):
            raise typer.BadParameter(f"the {planner} planner does not take it", param_hint=flag)
        options |= {} if value is None else {name: value}
    if history is not None and planner != "genetic":
        raise typer.BadParameter("only the genetic planner has one", param_hint="--history")
    seeker = Seeker(problem, openings_seconds if openings and planner in PROVERS else None, threads, as_json, quiet)
    if islands is None and (workers or ray):
        raise typer.BadParameter("are for --islands", param_hint="--workers, --ray")
    if islands is not None:
        from .islands import islands_result

        result = islands_result(problem, planner, options, islands, workers, ray, quiet=quiet)
    else:
        with seeker.told_of_start(), ProgressLine(stderr(), quiet=quiet) as line:
            result = search(problem, progress=line.update, **options)
    if output is not None:
        result.plan.save(output)
    if history is not None:
        from ..viewing.charts import draw_history

        draw_history(result.history, history, goals=[goal.name for goal in problem.goals])
    if as_json:
        print_json(result.to_json() | seeker.to_json(result))
    else:
        print_result(stdout(), result, output)
        seeker.print(result)
    raise typer.Exit(0 if result.has_plan else 1)
