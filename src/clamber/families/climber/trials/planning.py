"""Plans that are to be carried out: searched for with something kept back, rehearsed, and searched for anew without what failed there."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Final, TypeAlias

import numpy as np

from ....errors import StartError
from ....interrupts import passed_on
from ....planning.planners import PROVERS, accepts, find_planner
from ....planning.problem.plan import Plan
from ....planning.result import PlanResult
from ....sim.limb_flaws import LimbFlaws
from ....trials.dynamics import NoPlanError, RunEvents
from ..execution.climb_report import ClimbReport
from ..execution.climbing import Replan
from ..execution.executable_plan import lay_course
from ..planning.task import LimbedTask
from .noise import Noise
from .planning_margins import PLANNING_MARGINS, PlanningMargins, steady, with_margins
from .rerouting import repaired, without
from .run_plan import action_told, run_plan
from .stretch_repair import with_stretch_repaired

VALIDATION_NOISE: Final = Noise.of("none", ("peg_error=3mm",))
"""What deviates in a rehearsal."""
SEEDS: Final = (900_001, 900_002, 900_003)
"""Of its climbs: none that trials begin with."""


@dataclass(frozen=True, slots=True, order=True)
class PlanValidation:
    """What came of a plan's rehearsal; more is better."""

    climbed: int
    """Climbs that were carried out whole."""
    share: float
    """Actions carried out, of all, in the mean [-]."""
    failed: int | None = field(default=None, compare=False)
    """Step of the grab that the first climb that failed did not come beyond; None where there is none."""

    @property
    def flawless(self) -> bool:
        """Whether every climb was carried out whole."""
        return self.climbed == len(SEEDS)


def validations(
    flaws: LimbFlaws, events: RunEvents, noise: Noise = VALIDATION_NOISE
) -> Callable[[LimbedTask, Plan], PlanValidation]:
    """What climbs by a plan a few times, without asking for another on the way; after a fall only as often as it could still be flawless.

    Args:
        flaws: Of the plant, as the controller believes them.
        events: Told of each climb how far it is.
        noise: By how much pegs and plant differ from that.
    """

    def validate_plan(task: LimbedTask, plan: Plan) -> PlanValidation:
        climbed, shares, failed = 0, [], None
        what = f"rehearsing a plan of {len(plan.actions)} actions in simulation"
        for climb, seed in enumerate(SEEDS):

            def tell(*action: Any, climb: int = climb) -> None:
                share = (climb + action_told(*action)[1]) / len(SEEDS)
                events.step(f"{what}, climb {climb + 1} of {len(SEEDS)}", share)

            with passed_on():
                report = run_plan(task, plan, flaws, noise=noise, seed=seed, progress=tell).report
            climbed += report.done
            shares.append(sum(action.outcome == "ok" for action in report.actions) / max(1, len(plan.actions)))
            if not report.done:
                failed = grab_at_fault(plan, report)
                break
        return PlanValidation(climbed, float(np.mean(shares)), failed)

    return validate_plan


def grab_at_fault(plan: Plan, report: ClimbReport) -> int | None:
    """Step of the grab with which a climb went wrong, see `grab_before`; None where no action was carried out."""
    return grab_before(plan, report.actions[-1].first) if report.actions else None


def grab_before(plan: Plan, ended: int) -> int | None:
    """Step of the grab with which a climb went wrong that ended with a step: that one, that of the hook that stays wedged, else the latest.

    None where no grab has led to where it ended.
    """
    last = plan.actions[ended - 1]
    for step in range(ended, 0, -1):
        action = plan.actions[step - 1]
        if action.kind == "grab" and (last.kind != "release" or action.limb == last.limb):
            return step
    return None


Rehearse: TypeAlias = Callable[[LimbedTask, Plan], PlanValidation]
"""Climbs by a plan before anything moves."""
Find: TypeAlias = Callable[[PlanningMargins, str], Plan | None]
"""Searches for a plan with margins; told why it does so again, empty at first."""
HARD: Final = 10.0
"""What counts against a plan that is hard, all its stances together."""
INCAUTIOUS: Final = 10.0
"""What being less cautious counts in one that is not."""
EASY: Final = 3.5
"""What may count against a stance that is easy to hold: no link on a hold, no hook or motor much beyond what is wished."""
QUICK: Final = "beam"
"""Planner in place of one that proves: what fails in rehearsal changes the task time and again."""
UNEASY: Final = "no plan so far is easy to hold in every stance"
"""Why it is searched again where plans were found."""
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

    def search(task: LimbedTask, planner: str, why: str) -> PlanResult | None:
        if why:
            events.note(f"searching for a plan again, as {why}")
        options = {name: value for name, value in stated.items() if accepts(planner, name)}
        try:
            with passed_on():  # planners answer with what they have, which would be climbed
                result = find_planner(planner)(task, **options)
        except StartError:  # it stands where no such plan may begin
            return None
        if result.seconds >= seconds:
            events.cut()
        return result if result.has_plan else None

    def found_with(margins: PlanningMargins, planner: str, why: str) -> Plan | None:
        result = search(with_margins(task, margins), planner, why)
        if result is None:
            return None
        # the same actions, for the robot and the board as they are
        plan = Plan.of_codes(task, result.plan.codes(task), seed=seed, planner=result.plan.planner)
        return None if lay_course(task, plan).objections else plan

    def repaired_with(margins: PlanningMargins, why: str) -> Plan | None:
        plan = found_with(margins, quick, why)
        return None if plan is None else repaired(task, plan, margins, seconds) or plan

    quick = QUICK if planner in PROVERS else planner
    easy, hard = _by_ease(task, lambda margins, why: found_with(margins, planner, why))
    if validate_plan is None:  # the robot waits
        steadier = (found_with(margins, quick, UNEASY) for margins in steady(task))
        first = next((plan for plans in (easy, steadier, hard) for plan in plans if plan is not None), None)
    else:
        first = _rehearsed(task, easy, hard, repaired_with, validate_plan)
    if first is not None:
        return first
    result = search(task, planner, "none that keeps anything in reserve can be carried out")
    return None if result is None else result.plan


def _by_ease(task: LimbedTask, find: Find) -> tuple[list[Plan], list[Plan]]:
    """Plans of falling caution until one is easy in every stance, the easiest first: where one is nearly so, and where all are hard."""
    found: list[tuple[float, Plan]] = []
    seen: set[bytes] = set()
    least, why = math.inf, ""
    for rank, margins in enumerate(PLANNING_MARGINS):
        plan = find(margins, why)
        if plan is None:
            why = "none that keeps so much in reserve can be carried out"
            continue
        why = UNEASY
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
    find: Find,
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
        taught = _taught(task, margins, find, tried, UNEASY if best is None else "no rehearsal was without a failure")
        if taught is not None:
            return taught
    for plan in hard:
        if tried(plan).flawless:
            return plan
    return None if best is None else best[1]


def _taught(
    task: LimbedTask,
    margins: PlanningMargins,
    find: Find,
    tried: Callable[[Plan], PlanValidation],
    why: str,
) -> Plan | None:
    """A plan whose rehearsal is flawless: the grab that failed in the rehearsal before is made where it is steadier, or done without."""
    plan = find(margins, why)
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
        plan = find(margins, f"the rehearsal failed at step {done.failed}, {plan.actions[done.failed - 1].title}")
    return None


def replanner(
    planner: str, *, seconds: float, seed: int, threads: int | None = None, events: RunEvents = QUIET
) -> Replan:
    """What a sequencer asks for another plan; see `plan_to_climb`."""

    def replan(task: LimbedTask) -> Plan | None:
        return plan_to_climb(task, planner, seconds=seconds, seed=seed, threads=threads, events=events)

    return replan
