"""Plans that are to be carried out: searched for with something kept back, rehearsed, and searched for anew without what failed there."""

import math
from collections.abc import Callable
from typing import Final, TypeAlias

import numpy as np

from ....errors import StartError
from ....interrupts import passed_on
from ....planning.planners import PROVERS, accepts, find_planner
from ....planning.problem.plan import Plan
from ....planning.result import PlanResult
from ....trials.dynamics import NoPlanError, RunEvents
from ..execution.climbing import Replan
from ..execution.executable_plan import lay_course
from ..planning.task import LimbedTask
from .plan_validation import PlanValidation
from .planning_margins import PLANNING_MARGINS, PlanningMargins, steady, with_margins
from .rerouting import repaired, without
from .stretch_repair import with_stretch_repaired

Rehearse: TypeAlias = Callable[[LimbedTask, Plan], PlanValidation]
"""Climbs by a plan before anything moves."""
HARD: Final = 10.0
"""What counts against a plan that is hard, all its stances together."""
INCAUTIOUS: Final = 10.0
"""What being less cautious counts in one that is not."""
EASY: Final = 3.5
"""What may count against a stance that is easy to hold: no link on a hold, no hook or motor much beyond what is wished."""
QUICK: Final = "beam"
"""Planner in place of one that proves: what fails in rehearsal changes the task time and again."""
QUIET: Final = RunEvents()
LESSONS: Final = 10
"""Most plans of one caution that are rehearsed, each without what failed in those before."""


def no_plan(planner: str, task: LimbedTask) -> NoPlanError:
    """What is raised where `plan_to_climb` finds none."""
    return NoPlanError(planner, task.name, "that hooks can be trusted with")


def plan_to_climb(
    task: LimbedTask,
    planner: str,
    *,
    seconds: float,
    seed: int,
    threads: int | None = None,
    events: RunEvents = QUIET,
    validate_plan: Rehearse | None = None,
) -> Plan | None:
    """The most cautious plan that is easy to carry out and climbs, or one that has learned from its rehearsals, or the one that did best.

    What a search may see is limited by the planner, so the plan is the same on any number of cores, busy or not, unless a search takes
    longer than it may.

    Args:
        task: Under the rules that can be carried out.
        planner: Its name.
        seconds: Most time for each search.
        seed: Of the planner.
        threads: Threads; None for one a core.
        events: Called on the way, for each search.
        rehearse: Climbs by a plan in simulation; None: ease alone decides.
    """
    stated = {"seconds": seconds, "seed": seed, "threads": threads, "progress": events.search}

    def search(task: LimbedTask, planner: str) -> PlanResult | None:
        options = {name: value for name, value in stated.items() if accepts(planner, name)}
        try:
            with passed_on():  # planners answer with what they have, which would be climbed
                result = find_planner(planner)(task, **options)
        except StartError:  # it stands where no such plan may begin
            return None
        if result.seconds >= seconds:
            events.cut()
        return result if result.has_plan else None

    def found_with(margins: PlanningMargins, planner: str) -> Plan | None:
        result = search(with_margins(task, margins), planner)
        if result is None:
            return None
        # the same actions, for the robot and the board as they are
        plan = Plan.of_codes(task, result.plan.codes(task), seed=seed, planner=result.plan.planner)
        return None if lay_course(task, plan).objections else plan

    def repaired_with(margins: PlanningMargins, planner: str) -> Plan | None:
        plan = found_with(margins, planner)
        return None if plan is None else repaired(task, plan, margins, seconds) or plan

    easy, hard = _by_ease(task, lambda margins: found_with(margins, planner))
    quick = QUICK if planner in PROVERS else planner
    if validate_plan is None:  # the robot waits
        steadier = (found_with(margins, quick) for margins in steady(task))
        first = next((plan for plans in (easy, steadier, hard) for plan in plans if plan is not None), None)
    else:
        first = _rehearsed(task, easy, hard, lambda margins: repaired_with(margins, quick), validate_plan)
    if first is not None:
        return first
    result = search(task, planner)
    return None if result is None else result.plan


def _by_ease(task: LimbedTask, find: Callable[[PlanningMargins], Plan | None]) -> tuple[list[Plan], list[Plan]]:
    """Plans of falling caution until one is easy in every stance, the easiest first: where one is nearly so, and where all are hard."""
    found: list[tuple[float, Plan]] = []
    seen: set[bytes] = set()
    least = math.inf
    for rank, margins in enumerate(PLANNING_MARGINS):
        plan = find(margins)
        if plan is None:
            continue
        codes = plan.codes(task).tobytes()
        course = lay_course(task, plan)
        if codes in seen:
            continue
        seen.add(codes)
        own = float(np.maximum(course.elbow_costs - EASY, 0.0).sum())
        least = min(least, own)
        found.append((own + (INCAUTIOUS * rank if own > 0.0 else 0.0), plan))
        if own == 0.0:
            break
    plans = [plan for _, plan in sorted(found, key=lambda each: each[0])]
    return (plans, []) if least <= HARD else ([], plans)


def _rehearsed(
    task: LimbedTask,
    easy: list[Plan],
    hard: list[Plan],
    find: Callable[[PlanningMargins], Plan | None],
    validate_plan: Rehearse,
) -> Plan | None:
    """The first plan whose rehearsal is flawless, or the one that did best, the first of equals."""
    best: tuple[PlanValidation, Plan] | None = None

    def tried(plan: Plan) -> PlanValidation:
        nonlocal best
        done = validate_plan(task, plan)
        if best is None or done > best[0]:
            best = done, plan
        return done

    for plan in easy:
        if tried(plan).flawless:
            return plan
    for margins in steady(task):
        taught = _taught(task, margins, find, tried)
        if taught is not None:
            return taught
    for plan in hard:
        if tried(plan).flawless:
            return plan
    return None if best is None else best[1]


def _taught(
    task: LimbedTask,
    margins: PlanningMargins,
    find: Callable[[PlanningMargins], Plan | None],
    tried: Callable[[Plan], PlanValidation],
) -> Plan | None:
    """A plan whose rehearsal is flawless: the grab that failed in the rehearsal before is made where it is steadier, or done without."""
    plan = find(margins)
    for _ in range(LESSONS):
        if plan is None:
            return None
        done = tried(plan)
        if done.flawless:
            return plan
        if done.failed is None:
            return None
        codes = plan.codes(task)
        made = with_stretch_repaired(with_margins(task, margins), codes, done.failed)
        if not np.array_equal(made, codes):
            plan = Plan.of_codes(task, made, seed=plan.seed, planner=plan.planner)
            continue
        margins = without(margins, plan, done.failed)
        plan = find(margins)
    return None


def replanner(
    planner: str, *, seconds: float, seed: int, threads: int | None = None, events: RunEvents = QUIET
) -> Replan:
    """What a sequencer asks for another plan; see `plan_to_climb`."""

    def replan(task: LimbedTask) -> Plan | None:
        return plan_to_climb(task, planner, seconds=seconds, seed=seed, threads=threads, events=events)

    return replan
