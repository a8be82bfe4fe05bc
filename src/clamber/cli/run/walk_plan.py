"""The plan of a walker's task that `clamber run` and `clamber trials` carry out."""

import typer

from ...families.walker.planning.task import WalkerTask
from ...planning.planners import plan_task
from ...planning.problem.plan import Plan
from ..output import stderr
from ..plan.text import ProgressLine


def plan_walk(task: WalkerTask, planner: str, *, seconds: float, seed: int, quiet: bool) -> Plan:
    """Plan a walker's task; leaves with 1 where no plan is found.

    Args:
        task: With as much room as its plan is to have.
        planner: How to search.
        seconds: For which it may [s].
        seed: Of the planner.
        quiet: Whether to tell nothing on the way.
    """
    with ProgressLine(stderr(), quiet=quiet) as line:
        result = plan_task(task, planner, seed=seed, seconds=seconds, progress=line.update)
    if not result.has_plan:
        stderr().print(f"no plan for '{task.name}' that can bear to be walked: {result.reason}; nothing has moved")
        raise typer.Exit(1)
    return result.plan
