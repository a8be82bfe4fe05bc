"""The exact planner as a whole: the shortest plan, or the proof that there is none, within a stated model and memory."""

import time

import numpy as np

from ...actions.plan import Plan
from ...actions.plan_families import plan_family
from ...actions.problems import pose_problem
from ...errors import PlannerError
from ...tasks import Task
from ..progress import Exploring, Listener
from ..result import PlanResult, Status, furthest_of
from .explore import Exploration, explore

MOST_STANCES = 8_000_000
"""Stances kept unless told otherwise: about 1 GB for the climber, at 120 bytes each; half as much again while it grows."""


def plan_exact(
    task: Task,
    *,
    seed: int = 0,
    seconds: float | None = None,
    threads: int | None = None,
    max_stances: int = MOST_STANCES,
    progress: Listener | None = None,
) -> PlanResult:
    """Find a plan with the fewest actions, or prove that there is none.

    Args:
        task: What to plan.
        seed: Only written down: nothing here is drawn at random.
        seconds: Most wall-clock time [s].
        threads: The search itself runs on one; replays take as many as given.
        max_stances: Memory: most stances kept. Running out is a result ("bounded").
        progress: Called now and then.

    Returns:
        "optimal", "infeasible", or "bounded" with the proved lower bound on the number of actions.

    Raises:
        PlannerError: If the task allows actions that exact search can't list one by one.
    """
    started = time.monotonic()
    posed = pose_problem(task, threads=threads)
    problem = posed.problem
    if problem.incomplete is not None:
        raise PlannerError("exact", task.name, problem.incomplete)

    def tell(stances: int, bound: int) -> None:
        if progress is not None:
            progress(Exploring(stances, bound))

    seen = explore(problem, most_stances=max_stances, seconds=seconds, tell=tell)
    family = plan_family(task)
    replayed = problem.replay(seen.codes)
    status: Status = "optimal" if seen.found else "infeasible" if seen.exhausted else "bounded"
    return PlanResult(
        status=status,
        plan=Plan.of_codes(task, seen.codes, seed=seed, planner="exact"),
        task=task,
        reason=_reason(seen),
        evaluations=0,
        checks=seen.checks,
        seconds=time.monotonic() - started,
        seed=seed,
        planner="exact",
        max_torque=float(np.max([family.torque(stance) for stance in replayed.stances[1:]], initial=0.0)),
        furthest=None if seen.found else furthest_of(task, problem, seen.codes),
        lower_bound=None if seen.exhausted else seen.lower_bound,
        stances=seen.stances,
        model=family.model(task),
    )


def _reason(seen: Exploration) -> str:
    closed = ", ".join(f"{name} {n}" for name, n in sorted(seen.forbidden.items(), key=lambda item: -item[1]))
    if seen.found:
        return f"no plan has fewer than {len(seen.codes)} actions ({seen.stances} stances seen)"
    if seen.exhausted:
        return f"all {seen.stances} reachable stances were seen and none meets the goal; actions forbidden: {closed}"
    why = "interrupted" if seen.interrupted else "out of time or memory"
    return f"{why} after {seen.stances} stances: a plan has at least {seen.lower_bound} actions, if there is one"
