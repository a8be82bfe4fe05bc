"""Plans that are to be carried out: joints and hooks keep something back for what no plan foresees."""

import copy
from typing import Final

from ...actions.plan import Plan
from ...execution.climb.here import GENERATORS, hold_document
from ...execution.climb.sequencer import Replan
from ...planning.budgets import accepts
from ...planning.planners import PLANNERS
from ...tasks.library import change_task, task_from_document
from ...tasks.limbed import LimbedTask
from ...types import Json
from ...units import DEGREE, INCH
from ...worlds.board import Hold

CAUTIONS: Final = ((0.22, 2.0), (0.4, 2.0), (0.4, 0.0), (1.0, 0.0))
"""Share of the motors' torque that a plan may use [-], and reach that its grabs leave [in]; the next where there is no plan."""
PULL_CONE: Final = 10.0
"""Holds that state no direction are pulled down, within this of straight [deg]: limbs carry side by side, not one against the other."""
HOOK_CONE: Final = 58.0
"""Hooks pull within this of their grab direction [deg]."""


def plan_to_climb(task: LimbedTask, planner: str, *, seconds: float, seed: int) -> Plan | None:
    """A cautious plan, or the least incautious one that there is.

    Args:
        task: Under the rules that can be carried out.
        planner: Its name.
        seconds: Most time for each search.
        seed: Of the planner.
    """
    options = {name: value for name, value in (("seconds", seconds), ("seed", seed)) if accepts(planner, name)}
    for share, spare in CAUTIONS:
        result = PLANNERS[planner](cautious(task, share, spare), **options)
        if result.has_plan:
            # the same actions, for the robot and the board as they are
            return Plan.of_codes(task, result.plan.codes(task), seed=seed, planner=result.plan.planner)
    result = PLANNERS[planner](task, **options)
    return result.plan if result.has_plan else None


def cautious(task: LimbedTask, share: float, spare: float) -> LimbedTask:
    """A task that asks for more than its checks do, so that what holds in it can bear to be carried out.

    Args:
        task: The task.
        share: Of the motors' torque limit that may be used.
        spare: Reach that grabs leave, unless the task's rules leave more [in].
    """
    document = copy.deepcopy(task.document)
    if any(limb.end.kind != "gripper" for limb in task.robot.limbs):  # grippers may well push one against the other
        board = {key: value for key, value in document["board"].items() if key not in GENERATORS}
        document["board"] = board | {"holds": [_pulled_down(hold) for hold in task.world.holds]}
    changed = task_from_document(document, "cautious task")
    offset = max(task.rules.reach_offset, spare * INCH)
    limits = [f"rules.reach_offset={offset!r} m", f"motor.torque_limit={share * task.robot.motor.torque_limit!r} N m"]
    cautious_task = change_task(changed, [f"rules.hook_cone={HOOK_CONE} deg", *limits])
    assert isinstance(cautious_task, LimbedTask)  # the robot stays what it is
    return cautious_task


def _pulled_down(hold: Hold) -> Json:
    if hold.direction is not None:
        return hold_document(hold, hold.direction, hold.cone)
    return hold_document(hold, -90.0 * DEGREE, PULL_CONE * DEGREE)


def replanner(planner: str, *, seconds: float, seed: int) -> Replan:
    """What a sequencer asks for another plan."""

    def replan(task: LimbedTask) -> Plan | None:
        return plan_to_climb(task, planner, seconds=seconds, seed=seed)

    return replan
