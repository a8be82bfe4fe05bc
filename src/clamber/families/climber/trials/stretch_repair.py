"""A grab made where it is steadiest: a planner is indifferent to which of several moves a grab comes after, a climber is not."""

from dataclasses import replace
from typing import Final

import numpy as np

from ....errors import SpecError, StartError
from ....planning.problem.codes import ARGUMENT_BITS, HOLD, LIMB_BITS, MOVE
from ....planning.problem.plan import Plan
from ....planning.problem.problems import normalisation_of, plan_family
from ....planning.result import PlanResult
from ....types import Floats, Ints
from ..planning.task import LimbedTask
from .planning_margins import PLANNING_MARGINS, steady, with_margins
from .run_plan import climbing_task

BENT: Final = ("reach", "joint")
"""Checks that say how far limbs are from where they are soft or at an end: stretched, or a joint at its stop."""
SHIFT: Final = ARGUMENT_BITS + LIMB_BITS
"""Of a code, to its kind."""
WORTH: Final = 0.01
"""What a grab gains at least by being made elsewhere, as a share of the limit: less is rounding."""


def with_stretch_repaired(task: LimbedTask, codes: Ints, step: int) -> Ints:
    """The same actions, one grab among the moves about it where the limbs are farthest from their limits.

    A limb that pushes a hook onto a hold pushes the body away from it, and those that hold give way the more the straighter they are. A
    planner counts actions, and a grab an inch farther on is as good to it. So the grab is tried before and after every move that no
    other grab or release parts it from. Where the whole plan still holds and nothing among these moves comes nearer to a limit than
    before, it goes to the place where its own nearest limit is farthest.

    This is for a grab that went wrong. What else decides whether a grab comes off, such as how hard the hooks pull meanwhile, it does not
    look at: with all grabs of the plan for the circle steadied, climbs fell elsewhere about as often as before.

    Args:
        task: Robot, board, start and rules that the plan keeps to.
        codes: Packed actions of a plan, shape (n,); every grab names its hold.
        step: Of the grab, from 1.

    Returns:
        The same codes in the order found, shape (n,); as they were where nothing is gained, or where they don't hold.
    """
    problem = plan_family(task).problem(task)
    sticks = normalisation_of(task)
    rows = [i for i, check in enumerate(sticks.checks) if check.name in BENT]
    sizes = np.array([sticks.sizes[sticks.checks[i].name] for i in rows])

    def room(codes: Ints) -> Floats | None:
        replay = problem.replay(codes)
        return np.min(replay.margins[:, rows] / sizes, axis=1) if replay.ok else None

    best = np.array(codes, np.int32)
    before = room(best)
    if before is None:
        return best
    grab = step - 1
    about = _moves_about(best >> SHIFT, grab)
    moves, aim = np.delete(best[about], grab - about.start), before[grab] + WORTH
    for place in range(len(moves) + 1):
        tried = np.array(codes, np.int32)
        tried[about] = np.insert(moves, place, codes[grab])
        there = room(tried)
        if there is not None and there[about].min() >= before[about].min() and there[about.start + place] >= aim:
            best, aim = tried, there[about.start + place]
    return best


def steadied_result(result: PlanResult, step: int, label: str = "plan") -> PlanResult:
    """A plan's grab made where it is steadiest under the rules that can be carried out; the plan keeps back all that it kept back before.

    Args:
        result: With a plan of a climber. One that does not hold under those rules stays as it is.
        step: Of the grab, from 1.
        label: What errors call the plan.

    Raises:
        SpecError: If it is a walker's, or the step is no grab.
    """
    task = climbing_task(result.task)
    codes = result.plan.codes(result.task)
    if not 0 < step <= len(codes) or codes[step - 1] >> SHIFT != HOLD:
        grabs = ", ".join(str(1 + at) for at in np.flatnonzero(codes >> SHIFT == HOLD))
        raise SpecError(label, "step", step, f"must be a grab, one of {grabs}")
    made = with_stretch_repaired(_as_cautious(task, codes), codes, step)
    if np.array_equal(made, codes):
        return replace(result, reason=f"{result.reason}; the grab of step {step} is where it is steadiest")
    family = plan_family(result.task)
    stances = family.problem(result.task).replay(made).stances[1:]
    planner = f"{result.plan.planner}, steadied"
    return replace(
        result,
        plan=Plan.of_codes(result.task, made, seed=result.plan.seed, planner=planner),
        planner=planner,
        reason=f"{result.reason}; the grab of step {step} is made elsewhere",
        max_torque=max(family.torque(stance) for stance in stances),
    )


def _as_cautious(task: LimbedTask, codes: Ints) -> LimbedTask:
    """The task with the most caution that the plan keeps to."""
    for planning_margins in (*steady(task), *PLANNING_MARGINS):
        held = with_margins(task, planning_margins)
        try:
            if plan_family(held).problem(held).replay(codes).ok:
                return held
        except StartError:  # it stands where no such plan may begin
            continue
    return task


def _moves_about(kinds: Ints, grab: int) -> slice:
    """The grab and the moves before and after it, up to the next other action on either side."""
    others = np.flatnonzero(kinds != MOVE)
    before, after = others[others < grab], others[others > grab]
    return slice(int(before[-1]) + 1 if len(before) else 0, int(after[0]) if len(after) else len(kinds))
