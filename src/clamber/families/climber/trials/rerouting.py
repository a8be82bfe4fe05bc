"""Another way on from somewhere in a plan: what comes before stays, what comes after is searched for anew."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import product
from typing import Final

import numpy as np

from ....errors import StartError
from ....planning.beam import plan_beam
from ....planning.problem.plan import Plan
from ..control.limb_chain import legs_of
from ..execution.body_gains import USUAL_WEIGHT
from ..execution.elbows import load_capacity
from ..execution.executable_plan import ExecutablePlan, lay_course
from ..execution.remaining_task import task_from_here
from ..execution.swing_feasibility import grabs_without_way
from ..planning.task import LimbedTask
from .noise import Noise
from .planning_margins import PlanningMargins, with_margins

MAP_ERROR: Final = Noise.of("usual").widths["peg_error"]
"""With which ways are looked for on paper [m]."""
LONGER: Final = 1.5
"""Actions that another end may have, for each of the one before: looking for a much longer one takes longest and finds least [-]."""
LACK: Final = 2.5
"""What the worst of hooks and motors may lack of what the controller wishes: with much more, hooks slip off as another is pushed on [N]."""
BACKS: Final = (1, 2, 4)
"""How many grabs before a doubtful one a plan is changed from, in turn."""
MENDED: Final = 8
"""Most changes of a plan, one after the other."""


def without(margins: PlanningMargins, plan: Plan, step: int) -> PlanningMargins:
    """The caution that does without the grab of a step."""
    grab = plan.actions[step - 1]
    assert grab.limb is not None and grab.hold is not None  # a plan names what it took
    return replace(margins, barred=(*margins.barred, (grab.limb, grab.hold)))


def doubtful_grabs(course: ExecutablePlan) -> list[int]:
    """Steps of grabs that are doubtful on paper: the limb finds no way there, or hooks and motors lack much until the next one."""
    steps = set(grabs_without_way(course, MAP_ERROR))
    robot, places = course.task.robot.at_weight(USUAL_WEIGHT), course.task.world.positions()
    legs = legs_of(robot)
    for step, stance in enumerate(course.stances):
        if load_capacity(robot, legs, places, stance, course.elbows[step]) < -LACK:
            steps.add(next((at for at in range(step, 0, -1) if course.actions[at - 1].kind == "grab"), 0))
    return sorted(steps - {0})  # what the start lacks no grab mends


def repaired(task: LimbedTask, plan: Plan, margins: PlanningMargins, seconds: float) -> Plan | None:
    """A plan without doubtful grabs: changed from shortly before the first of them, until there is none.

    Args:
        task: Robot, board, start and rules that the plan is for.
        plan: That nothing speaks against.
        caution: What other ways keep back.
        seconds: Most time for each search.

    Returns:
        None where no such plan was found.
    """
    course = lay_course(task, plan)
    doubtful = doubtful_grabs(course)
    for _ in range(MENDED):
        if not doubtful:
            return plan
        best: tuple[tuple[int, int], Plan, ExecutablePlan, list[int]] | None = None
        for step, back in product(grabs_of(course, doubtful[0])[:2], BACKS):
            other = other_end(course, plan, step, back, without(margins, plan, step), seconds)
            if other is None:
                continue
            laid = lay_course(task, other)
            after = doubtful_grabs(laid)
            left = _left(other, after)
            if left < (best[0] if best else _left(plan, doubtful)):
                best = left, other, laid, after
            if best is not None and not best[3]:
                break
        if best is None:
            return None
        _, plan, course, doubtful = best
    return None


def _left(plan: Plan, doubtful: Sequence[int]) -> tuple[int, int]:
    """How much of a plan is in doubt: actions from the first doubtful grab on, and how many there are."""
    return (len(plan.actions) - doubtful[0] if doubtful else 0), len(doubtful)


def grabs_of(course: ExecutablePlan, step: int) -> list[int]:
    """Steps of the grabs by which the limbs hold after a step, the latest first: any of them may be at fault."""
    holds, steps = course.stances["hold"], []
    for i in range(len(course.task.robot.limbs)):
        taken = step
        while taken > 0 and holds[taken, i] == holds[step, i]:
            taken -= 1
        if holds[step, i] >= 0 and course.actions[taken].kind == "grab":
            steps.append(taken + 1)
    return sorted(steps, reverse=True)


def other_end(
    course: ExecutablePlan, plan: Plan, step: int, back: int, margins: PlanningMargins, seconds: float
) -> Plan | None:
    """A plan with another end, from `back` grabs before a step on; None where none is found, or something speaks against it.

    Args:
        course: The plan, carried out on paper.
        plan: The plan.
        step: Of a grab, from 1.
        back: Grabs before that.
        caution: What the new end keeps back.
        seconds: Most time for the search.
    """
    task, codes = course.task, plan.codes(course.task)
    cut = cut_before(plan, step, back)
    try:
        left = with_margins(task_from_here(course, cut + 1, course.holds(cut), set()), margins)
        result = plan_beam(left, longest=round(LONGER * (len(codes) - cut)), seconds=seconds)
    except StartError:  # it stands where no such plan may begin
        return None
    if not result.has_plan:
        return None
    made = np.concatenate((codes[:cut], result.plan.codes(left)))
    changed = Plan.of_codes(task, made, seed=plan.seed, planner=plan.planner)
    return None if lay_course(task, changed).objections else changed


def cut_before(plan: Plan, step: int, back: int) -> int:
    """How many actions of a plan stay that is changed from `back` grabs before a step on."""
    grabs: Sequence[int] = [at for at, action in enumerate(plan.actions[: step - 1]) if action.kind == "grab"]
    return grabs[-back] if len(grabs) >= back else 0
