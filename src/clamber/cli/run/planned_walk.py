"""`clamber run` of a walker's task or plan: plan it if need be, and walk it."""

from typing import Final

from ...families.walker.planning.task import WalkerTask
from ...families.walker.trials.planned import careful, lay_plan, walk_of
from ...planning.planners import find_planner
from ...planning.problem.plan import Plan
from ..for_climbs import refuse_for_walk
from ..output import announce_compilation
from .options import RunOptions
from .report import RunReport
from .walk import walk_and_tell
from .walk_plan import plan_walk

CLIMBS_ONLY: Final = ("peg_error", "replan", "plant", "force")
"""Options of `run` that a walker's task has no use for."""


def run_planned_walk(what: str, task: WalkerTask, plan: Plan | None, words: RunOptions, telling: RunReport) -> None:
    """Carry a planned walk out and say how it went; leaves with 1 where there is no plan, or where it did not come to its end.

    Args:
        what: The task's or plan's name or file.
        task: The task.
        plan: Its plan; None: it is planned first, with more room than its checks ask for.
        words: How.
        telling: Its report, if one is asked for.
    """
    refuse_for_walk(what, words, CLIMBS_ONLY)
    find_planner(words.planner)
    announce_compilation(quiet=words.quiet)
    if plan is None:
        task = careful(task)
        plan = plan_walk(task, words.planner, seconds=words.seconds, seed=words.seed, quiet=words.quiet)
    if words.save_plan is not None:
        plan.save(words.save_plan)
    walk_and_tell(walk_of(task), words, telling, lay_plan(task, plan, what), plan)
