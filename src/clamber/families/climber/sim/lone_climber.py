"""A climber alone as a MuJoCo model."""

from typing import Any, Final

from ....sim.limb_flaws import LimbFlaws
from ....sim.lone_robot import JointBounds
from ....units import INCH
from ..control.limb_chain import chain_of_limb
from ..robot.robot import LimbedRobot
from .climber_model import lone_climber_spec

PEG_RADIUS: Final = 0.1875 * INCH
"""Of the pegs that hooks are shaped for: the bolts of Bevly 1997, 3/8 in thick [m]."""


def lone_climber(robot: LimbedRobot) -> tuple[Any, dict[str, JointBounds]]:
    """Its `MjSpec`, and the bounds of its joints."""
    spec = lone_climber_spec(robot, LimbFlaws(joint_limits=True), peg_radius=PEG_RADIUS)
    bounds = {}
    for limb in robot.limbs:
        chain = chain_of_limb(robot, limb.name)
        for name, record in zip(chain.joint_names, chain.joints, strict=True):
            lower, upper, limit, speed = (float(record[key]) for key in ("lower", "upper", "limit", "speed"))
            bounds[name] = JointBounds(lower, upper, limit, speed)
    for motor in spec.actuators:
        most = bounds[motor.name].effort
        assert most is not None  # every joint of a climber has a motor with a limit
        motor.ctrllimited, motor.ctrlrange = True, (-most, most)
    return spec, bounds
