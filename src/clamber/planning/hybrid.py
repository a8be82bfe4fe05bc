"""The hybrid planner: a genetic plan as the upper bound of an exact search, and exact ways as what a population starts with."""

from dataclasses import replace
from typing import Any, Final

import numpy as np

from ..interrupts import passed_on
from ..tasks import Task
from .exact.costs import Aim
from .exact.explore import Exploration, explore, inform
from .genetic.planner import plan_genetic
from .genetic.profile import Profile
from .problem.plan import Plan
from .problem.problem import CompiledProblem
from .problem.problems import first_goal_only, listed_problem, plan_family, pose_problem
from .progress import Clock, Exploring, Listener
from .result import PlanResult, furthest_of

MOST_STANCES: Final = 2_000_000
"""Stances that the exact search keeps unless told otherwise: about 250 MB for the climber."""
SUB_PLAN: Final = 100_000
"""Most stances of the exact search for a way to the first sub-goal."""


def plan_hybrid(
    task: Task,
    *,
    seed: int = 0,
    profile: str | Profile = "default",
    max_evaluations: int = 50_000,
    max_stances: int = MOST_STANCES,
    seconds: float | None = None,
    threads: int | None = None,
    progress: Listener | None = None,
) -> PlanResult:
    """Plan by genetic and exact search together: a plan soon, then how much shorter one may be, or that none is.

    The shortest way to the first sub-goal, if the task has one, seeds the population. The plan found is the upper bound of an exact
    search. Where the genetic search finds none, the way to where the exact search got furthest seeds a second one.

    Args:
        task: What to plan.
        seed: Same seed, same plan.
        profile: Name or file of a genetic profile, or a profile.
        max_evaluations: Most plans that each genetic search evaluates.
        max_stances: Memory: most stances that the exact search keeps.
        seconds: Most time [s]; a search that it ends is not repeatable.
        threads: Threads; None for one a core.
        progress: Called now and then.

    Returns:
        "optimal"; "infeasible"; or "bounded": the plan with its gap to the proved lower bound, or the furthest stance.

    Raises:
        PlannerError: If the task allows actions that exact search can't list one by one.
    """
    clock = Clock(seconds)
    problem = listed_problem(task, "hybrid", threads=threads)

    options: dict[str, Any] = {
        "seed": seed, "profile": profile, "max_evaluations": max_evaluations, "threads": threads, "progress": progress,
    }  # fmt: skip
    first = plan_genetic(task, seconds=clock.left, seeds=_way_to_first_goal(task, threads, clock.left), **options)
    if "interrupted" in first.reason:
        return replace(first, planner="hybrid", seconds=clock.spent)
    most = first.length if first.has_plan else None
    seen = _explore(problem, most, max_stances, clock.left, progress)
    told = first
    if not (first.has_plan or seen.found or seen.exhausted or seen.interrupted):
        furthest = Plan.of_codes(task, seen.codes, seed=seed, planner="exact")
        second = plan_genetic(task, seconds=clock.left, seeds=(furthest,), **options)
        told = replace(second, evaluations=first.evaluations + second.evaluations, checks=first.checks + second.checks)
    return _answer(task, problem, told, seen, clock.spent)


def _way_to_first_goal(task: Task, threads: int | None, seconds: float | None) -> tuple[Plan, ...]:
    if len(task.goals) < 2:
        return ()
    near = pose_problem(first_goal_only(task), threads=threads).problem
    near, seconds = inform(near, seconds)
    with passed_on():
        seen = explore(near, most_stances=SUB_PLAN, seconds=seconds)
    return (Plan.of_codes(task, seen.codes, planner="exact"),) if seen.found else ()


def _explore(
    problem: CompiledProblem, most: int | None, max_stances: int, seconds: float | None, progress: Listener | None
) -> Exploration:
    """Exact search for a plan of fewer than `most` actions."""

    def tell(stances: int, bound: float) -> None:
        if progress is not None:
            progress(Exploring(stances, bound))

    aim = Aim(at_most=None if most is None else most - 1)
    problem, seconds = inform(problem, seconds)
    return explore(problem, most_stances=max_stances, seconds=seconds, tell=tell, aim=aim)


def _answer(task: Task, problem: CompiledProblem, told: PlanResult, seen: Exploration, seconds: float) -> PlanResult:
    family = plan_family(task)
    common: dict[str, Any] = {
        "planner": "hybrid", "seconds": seconds, "checks": told.checks + seen.checks, "stances": seen.stances,
        "model": family.model(task),
    }  # fmt: skip
    if seen.found and (not told.has_plan or len(seen.codes) < told.length):
        stances = problem.replay(seen.codes).stances
        return replace(
            told,
            status="optimal",
            plan=Plan.of_codes(task, seen.codes, seed=told.seed, planner="hybrid"),
            reason=f"no plan has fewer than {len(seen.codes)} actions ({seen.stances} stances seen)",
            lower_bound=len(seen.codes),
            max_torque=float(np.max([family.torque(stance) for stance in stances[1:]], initial=0.0)),
            furthest=None,
            **common,
        )
    plan = replace(told.plan, planner="hybrid")
    if told.has_plan and (seen.found or seen.exhausted or seen.lower_bound >= told.length):
        reason = f"no plan has fewer than {told.length} actions ({seen.stances} stances seen)"
        return replace(told, status="optimal", plan=plan, reason=reason, lower_bound=told.length, **common)
    if seen.exhausted:
        reason = f"all {seen.stances} reachable stances were seen and none meets the goal"
        furthest = furthest_of(task, problem, seen.codes)
        plan = Plan.of_codes(task, seen.codes, seed=told.seed, planner="hybrid")
        return replace(told, status="infeasible", plan=plan, reason=reason, furthest=furthest, **common)
    why = "interrupted" if seen.interrupted else "out of time or memory"
    reason = f"{why} after {seen.stances} stances: a plan has at least {seen.lower_bound:.0f} actions"
    return replace(told, status="bounded", plan=plan, reason=reason, lower_bound=int(seen.lower_bound), **common)
