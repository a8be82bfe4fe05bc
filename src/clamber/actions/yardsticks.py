"""What margins of different units are measured against, so that they can be compared: each as a share of what is limited."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final

from ..statics.checks import LIMBED_CHECKS, Check
from ..statics.walker_checks import WALKER_CHECKS
from ..tasks import Task
from ..tasks.limbed import LimbedTask
from ..tasks.walker import WalkerTask

NOTHING_LIMITS: Final = 1e8
"""Larger margins mean that nothing limits."""


@dataclass(frozen=True, slots=True)
class Yardsticks:
    """What a task's margins are measured against."""

    checks: tuple[Check, ...]
    """In the order of a replay's margins."""
    hard: tuple[str, ...]
    """Names of the checks that forbid an action."""
    sizes: Mapping[str, float]
    """Check -> the size that its margin is a share of, in its own unit; counts have none, for they are never tight."""


def climber_yardsticks(task: LimbedTask) -> Yardsticks:
    """Reach, joint ranges, torque and power limits, weight; for distances the clearance or a tenth of the reach."""
    robot, rules = task.robot, task.rules
    reach = min(limb.length for limb in robot.limbs)
    joints = [joint for limb in robot.limbs for joint in (limb.shoulder, limb.elbow)]
    half = 0.5 * min(joint.upper - joint.lower for joint in joints)
    torque = min(robot.motor.torque_limit if j.torque_limit is None else j.torque_limit for j in joints)
    power = math.inf if rules.max_power is None else rules.max_power
    room = max(rules.clearance, 0.1 * reach)
    sizes = {check.name: room for check in LIMBED_CHECKS if check.unit != "1"}
    sizes |= {"reach": reach, "joint": half, "torque": torque, "power": power, "hook": robot.weight}
    return Yardsticks(LIMBED_CHECKS, rules.hard, sizes)


def walker_yardsticks(task: WalkerTask) -> Yardsticks:
    """Half a stroke, the guarded singular distance, a tenth of the feet's circle, the middle of a support triangle, the legs' stroke."""
    mechanism, legs = task.robot.mechanism, task.robot.legs
    feet = min(legs.radius_delta, legs.radius_y)
    sizes = {
        "stroke": 0.5 * mechanism.stroke,
        "singular": mechanism.guard * mechanism.singular_distance(0.0),
        "foothold": max(task.rules.clearance, 0.1 * feet),
        "balance": 0.5 * feet,  # inradius of a triangle over its circumradius
        "legs": legs.stroke,
    }
    return Yardsticks(WALKER_CHECKS, task.rules.hard, sizes)


YARDSTICKS: Final[dict[str, Callable[[Any], Yardsticks]]] = {"limbed": climber_yardsticks, "walker": walker_yardsticks}
"""Family of the robot -> the yardsticks of its tasks."""


def yardsticks_of(task: Task) -> Yardsticks:
    """The yardsticks of a task."""
    return YARDSTICKS[task.document["robot"]["family"]](task)
