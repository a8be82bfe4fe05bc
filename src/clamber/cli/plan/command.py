"""`clamber plan`: find a plan for a task."""

from typing import TYPE_CHECKING, Any

import typer

from ...terminal.options import TaskName, takes_options
from ...terminal.output import print_json, stderr, stdout
from ...terminal.worker_options import EndsLine, executor_of
from .options import PlanOptions

if TYPE_CHECKING:
    from ...planning.result import PlanResult
    from ...tasks import Task
    from .openings import Seeker


@takes_options
def plan(
    task: TaskName,
    *,
    words: PlanOptions,
) -> None:
    """Find a sequence of grabs and body moves that every check allows, from the start to the goal."""
    words.check()
    from ...tasks import load_task

    problem = load_task(task, words.overrides or ())
    from ...planning.planners import PROVERS, find_planner
    from .openings import Seeker

    find_planner(words.chosen)
    if words.pareto is not None:
        from .front import front

        raise typer.Exit(front(problem, words.pareto, words))
    seeker = Seeker(problem, words, looks=words.openings and words.chosen in PROVERS and not words.to_run)
    if words.to_run:
        from .to_run import plan_to_run

        result = plan_to_run(problem, words)
    else:
        result = _search(problem, words, seeker)
    if words.output is not None:
        result.plan.save(words.output)
    if words.history is not None:
        from ...viewing.plan_curves import draw_history

        draw_history(result.history, words.history, goals=[goal.name for goal in problem.goals])
    from ...trials.work import to_run

    judged = to_run(result.task, result.plan) if result.has_plan else None
    if words.as_json:
        print_json(seeker.with_openings(result, judged))
    else:
        from .text import print_result, print_to_run

        print_result(stdout(), result, words.output, codes=words.codes)
        print_to_run(stdout(), judged, "this command with --to-run")
        seeker.print(result)
    raise typer.Exit(0 if result.has_plan else 1)


def _search(task: "Task", words: PlanOptions, seeker: "Seeker") -> "PlanResult":
    """Search as was asked for: on islands, or by one planner, whose trouble with the start is told with what would allow it."""
    options = words.planner_options(task)
    if words.islands is not None:
        return _plan_islands(task, options, words, words.islands)
    from ...planning.planners import plan_task
    from .text import ProgressLine

    with seeker.told_of_start(), ProgressLine(stderr(), quiet=words.quiet) as line:
        return plan_task(task, words.chosen, progress=line.update, **options)


TAKEN = ("seed", "profile", "max_evaluations")
"""Options of the genetic planner that islands take, too."""


def _plan_islands(task: "Task", options: dict[str, Any], words: PlanOptions, islands: int) -> "PlanResult":
    """Plan with islands; `options` are those of the genetic planner.

    Raises:
        BadParameter: If another planner or an option is asked for that islands don't take.
    """
    from ...planning.islands import plan_islands

    if words.chosen != "genetic":
        raise typer.BadParameter("only the genetic planner has populations", param_hint="--islands")
    other = [name for name, value in options.items() if name not in TAKEN and value is not None]
    if other:
        raise typer.BadParameter(f"islands don't take {', '.join(other)}", param_hint="--islands")
    executor = executor_of(words.ray, words.workers)
    if words.ray is not None:
        executor.check()
    given = {name: options[name] for name in TAKEN}
    with EndsLine(stderr(), "islands", quiet=words.quiet) as line:
        return plan_islands(task, islands=islands, executor=executor, progress=line.update, **given)
