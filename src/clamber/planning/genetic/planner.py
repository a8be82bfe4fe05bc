"""The genetic planner as a whole: a task in, a plan or the furthest stance out."""

import time
from collections.abc import Sequence
from pathlib import Path

from ...actions.plan import Plan
from ...actions.plan_families import plan_family
from ...actions.problems import last_goal_only, pose_problem
from ...tasks import Task
from ..progress import Listener
from ..result import PlanResult, furthest_of
from .learning import Macro
from .profile import Profile, load_profile
from .search import Budget, Outcome, search


def plan_genetic(
    task: Task,
    *,
    seed: int = 0,
    profile: str | Profile = "default",
    max_evaluations: int = 50_000,
    max_checks: int | None = None,
    seconds: float | None = None,
    threads: int | None = None,
    filters: bool = True,
    macros: Sequence[Macro] = (),
    progress: Listener | None = None,
    checkpoint: Path | None = None,
) -> PlanResult:
    """Plan by genetic search (thesis 2.2.3; page "The model", section 10).

    Args:
        task: What to plan.
        seed: Same seed, same plan, on any number of threads.
        profile: Name or file of a profile, or a profile.
        max_evaluations: Most plans to evaluate, polishing included.
        max_checks: Most single actions to judge, polishing included; a generation that has begun is finished.
        seconds: Most wall-clock time [s].
        threads: Threads; None for one a core.
        filters: Whether the inventory's filters are applied.
        macros: Learned modules to add to the inventory.
        progress: Called after every generation.
        checkpoint: File to save the search to, and to resume it from.

    Returns:
        The plan ("found"), or the furthest stance and what stopped it ("stopped").
    """
    started = time.monotonic()
    settings = load_profile(profile) if isinstance(profile, str) else profile
    aim = task if settings.search.subgoals else last_goal_only(task)
    posed = pose_problem(aim, threads=threads, filters=filters)
    table = posed.problem.actions.extended([(macro.name, macro.codes, False) for macro in macros])
    problem = posed.problem.rebind(table)
    identity = f"genetic/{dict(task.hashes)}/{table.names}"
    outcome = search(
        problem,
        settings,
        seed=seed,
        budget=Budget(max_evaluations, seconds, max_checks),
        stages=problem.goals,
        listener=progress,
        checkpoint=checkpoint,
        identity=identity,
    )
    replayed = problem.replay(outcome.codes)
    family = plan_family(task)
    plan = Plan.of_codes(
        task, outcome.codes, seed=seed, planner=f"genetic/{settings.name}", genes=outcome.names or None
    )
    return PlanResult(
        status="found" if outcome.found else "stopped",
        plan=plan,
        task=task,
        reason=_reason(outcome),
        evaluations=outcome.evaluations,
        checks=outcome.checks,
        seconds=time.monotonic() - started,
        seed=seed,
        planner=f"genetic/{settings.name}",
        max_torque=max((family.torque(stance) for stance in replayed.stances[1:]), default=0.0),
        furthest=None if outcome.found else furthest_of(task, problem, outcome.codes),
        first_length=outcome.first_length,
        first_evaluations=outcome.first_evaluations,
        first_checks=outcome.first_checks,
        history=outcome.history,
        macros=outcome.macros,
    )


def _reason(outcome: Outcome) -> str:
    if outcome.found and not len(outcome.codes):
        return "the start meets every goal already"
    if outcome.found and outcome.interrupted:
        return f"interrupted while polishing; the plan of {len(outcome.codes)} actions works"
    if outcome.found:
        return f"reached every goal after {outcome.first_evaluations} evaluations"
    how = "interrupted" if outcome.interrupted else "the budget ran out"
    return f"{how} after {outcome.evaluations} evaluations without reaching the goal; this search proves nothing"
