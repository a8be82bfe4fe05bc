"""Plans that are to be carried out: the strong motors kept for what no plan foresees."""

from typing import Final

from ...actions.plan import Plan
from ...execution.climb.sequencer import Replan
from ...planning.budgets import accepts
from ...planning.planners import PLANNERS
from ...tasks.library import change_task
from ...tasks.limbed import LimbedTask

SHARES: Final = (0.3, 0.45, 1.0)
"""Of the motors' torque limit that a plan may use; the next where there is no plan [-]."""


def plan_to_climb(task: LimbedTask, planner: str, *, seconds: float, seed: int) -> Plan | None:
    """A plan with little torque: two hooks that carry side by side, not one over the other, which tears at both.

    Args:
        task: Under the rules that can be carried out.
        planner: Its name.
        seconds: Most time for each search.
        seed: Of the planner.
    """
    limit = task.robot.motor.torque_limit
    options = {name: value for name, value in (("seconds", seconds), ("seed", seed)) if accepts(planner, name)}
    for share in SHARES:
        result = PLANNERS[planner](change_task(task, [f"motor.torque_limit={share * limit!r} N m"]), **options)
        if result.has_plan:
            # the same actions, for the robot as it is
            return Plan.of_codes(task, result.plan.codes(task), seed=seed, planner=result.plan.planner)
    return None


def replanner(planner: str, *, seconds: float, seed: int) -> Replan:
    """What a sequencer asks for another plan."""

    def replan(task: LimbedTask) -> Plan | None:
        return plan_to_climb(task, planner, seconds=seconds, seed=seed)

    return replan
