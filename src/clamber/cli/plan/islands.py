"""`clamber plan --islands`: several genetic populations over workers or a cluster."""

from typing import Any

import typer

from ...planning.islands import plan_islands
from ...planning.result import PlanResult
from ...tasks import Task
from ..crew import EndsLine, executor_of
from ..output import stderr

TAKEN = ("seed", "profile", "max_evaluations")
"""Options of the genetic planner that islands take, too."""


def islands_result(
    task: Task,
    planner: str,
    options: dict[str, Any],
    islands: int,
    workers: int | None,
    ray: str | None,
    *,
    quiet: bool,
) -> PlanResult:
    """Plan with islands; `options` are those of the genetic planner.

    Raises:
        BadParameter: If another planner or an option is asked for that islands don't take.
    """
    if planner != "genetic":
        raise typer.BadParameter("only the genetic planner has populations", param_hint="--islands")
    other = [name for name, value in options.items() if name not in TAKEN and value is not None]
    if other:
        raise typer.BadParameter(f"islands don't take {', '.join(other)}", param_hint="--islands")
    executor = executor_of(ray, workers)
    if ray is not None:
        executor.check()
    line = EndsLine(stderr(), "islands", quiet=quiet)
    given = {name: options[name] for name in TAKEN}
    return plan_islands(task, islands=islands, executor=executor, progress=line.update, **given)
