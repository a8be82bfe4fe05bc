"""The route planner as a whole: up a wall of any size, quickly, by a greedy search that a map of the wall leads."""

import time
from typing import Final

import numpy as np

from ...errors import PlannerError
from ...tasks import Task
from ..problem.plan import Plan
from ..problem.plan_families import plan_family
from ..problem.problems import pose_problem
from ..progress import Listener, Routing
from ..result import PlanResult, furthest_of
from .climb import Climb, climb

WEIGHTS: Final = (8.0, 3.0, 1.5)
"""How much the way left counts, search by search: the first finds a plan, the others look for shorter ones."""
SHARE: Final = 0.2
"""Weight of the limbs' way beside the body's [-]."""
CROWDING: Final = 0.2
"""By how much a stance expanded at a place makes the way left from there longer [steps]: dead ends fill up and are left."""
MOST_STANCES: Final = 4_000_000
"""Stances kept unless told otherwise: about half a GB; half as much again while it grows."""
EFFORT: Final = 5
"""A search for a shorter plan may see so many times the stances of the first."""


def plan_route(
    task: Task,
    *,
    seed: int = 0,
    seconds: float | None = None,
    threads: int | None = None,
    max_stances: int = MOST_STANCES,
    weights: tuple[float, ...] = WEIGHTS,
    share: float = SHARE,
    crowding: float = CROWDING,
    progress: Listener | None = None,
) -> PlanResult:
    """Find a plan over a board of any size; choose it where the way is long.

    A map of the wall says how far each place is from each goal, over places with holds in reach. Stances are then expanded in the order of
    actions made plus the weighted way left; the more stances of a place have been expanded, the longer its way counts, so that the search
    leaves dead ends. Its time grows with the length of the way and with the dead ends on it, not with the board.

    Args:
        task: What to plan.
        seed: Only written down: nothing here is drawn at random.
        seconds: Most wall-clock time [s].
        threads: The search itself runs on one; replays take as many as given.
        max_stances: Memory: most stances kept. Running out is a result ("stopped").
        weights: Of the way left, search by search; the first plan found gets shorter with the smaller weights behind.
        share: Weight of the limbs' way beside the body's.
        crowding: By how much a stance expanded at a place makes the way left from there longer [steps].
        progress: Called now and then.

    Returns:
        "found", or "stopped" with the furthest stance; it proves nothing.

    Raises:
        PlannerError: If the task has no board of holds, or allows actions that can't be listed one by one.
    """
    started = time.monotonic()
    problem = pose_problem(task, threads=threads).problem
    if problem.incomplete is not None:
        raise PlannerError("route", task.name, problem.incomplete)
    fields = problem.ways()
    if fields is None:
        raise PlannerError("route", task.name, "its world has no holds; take the genetic or the exact planner")

    def tell(stances: int, actions: int, left: float, whole: float) -> None:
        if progress is not None:
            progress(Routing(stances, actions, 1.0 - left / whole if whole > 0.0 else 1.0))

    best, checks, stances, first_length, first_checks = None, 0, 0, None, None
    for weight in weights:
        left = None if seconds is None else max(0.0, seconds - (time.monotonic() - started))
        most = max_stances if best is None else min(max_stances, EFFORT * best.stances)
        seen = climb(
            problem, fields, weight=weight, share=share, crowding=crowding, most_stances=most, seconds=left, tell=tell
        )
        checks, stances = checks + seen.checks, stances + seen.stances
        if best is None or (seen.found and len(seen.codes) < len(best.codes)):
            best = seen
        if seen.found and first_length is None:
            first_length, first_checks = len(seen.codes), checks
        if not best.found or seen.interrupted or (left is not None and time.monotonic() - started >= (seconds or 0.0)):
            break
    assert best is not None
    family = plan_family(task)
    replayed = problem.replay(best.codes)
    return PlanResult(
        status="found" if best.found else "stopped",
        plan=Plan.of_codes(task, best.codes, seed=seed, planner="route"),
        task=task,
        reason=_reason(best, stances),
        evaluations=0,
        checks=checks,
        seconds=time.monotonic() - started,
        seed=seed,
        planner="route",
        max_torque=float(np.max([family.torque(stance) for stance in replayed.stances[1:]], initial=0.0)),
        furthest=None if best.found else furthest_of(task, problem, best.codes),
        stances=stances,
        first_length=first_length,
        first_checks=first_checks,
    )


def _reason(best: Climb, stances: int) -> str:
    if best.found:
        return (
            f"reached every goal after {stances} stances" if len(best.codes) else "the start meets every goal already"
        )
    closed = ", ".join(f"{name} {n}" for name, n in sorted(best.forbidden.items(), key=lambda item: -item[1])[:3])
    if best.exhausted:
        why = f"all {stances} stances that differ by a quarter of a step or a hold were seen, and none meets the goal"
        return f"{why}; this search proves nothing; actions forbidden: {closed}"
    why = "interrupted" if best.interrupted else "out of time or memory"
    return f"{why} after {stances} stances, about {best.left:.0f} steps from the goal; actions forbidden: {closed}"
