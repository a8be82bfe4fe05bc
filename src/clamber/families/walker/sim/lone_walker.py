"""A walker alone as a MuJoCo model."""

from typing import Any

from ....sim.lone_robot import JointBounds
from ..robot import WalkerRobot
from .walker_flaws import WalkerFlaws
from .walker_model import arm_names, leg_names, walker_spec


def lone_walker(robot: WalkerRobot) -> tuple[Any, dict[str, JointBounds]]:
    """Its `MjSpec`, and the bounds of its joints."""
    legs, arm = robot.legs, robot.arm
    bounds = {name: JointBounds(legs.shortest, legs.longest, None, legs.speed) for name in leg_names()}
    if arm is not None:
        ends = zip(arm_names(robot), arm.lowest, arm.highest, arm.fastest, strict=True)
        bounds |= {name: JointBounds(low, high, None, speed) for name, low, high, speed in ends}
    return walker_spec(robot, None, WalkerFlaws()), bounds
