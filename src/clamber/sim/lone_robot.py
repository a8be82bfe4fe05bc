"""A robot by itself, without its world, as a MuJoCo model that can be written for other programs."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from ..control.chain import chain_of_limb
from ..robots import LimbedRobot, WalkerRobot
from ..robots.library import Robot
from ..units import INCH
from .climber_model import lone_climber_spec
from .limb_flaws import LimbFlaws
from .walker_flaws import WalkerFlaws
from .walker_model import arm_names, leg_names, walker_spec

PEG_RADIUS: Final = 0.1875 * INCH
"""Of the pegs that hooks are shaped for: the bolts of Bevly 1997, 3/8 in thick [m]."""


@dataclass(frozen=True, slots=True)
class JointBounds:
    """How far, how hard and how fast a joint goes, in its own units; None where the robot's file does not say."""

    lower: float
    upper: float
    effort: float | None
    speed: float | None


@dataclass(frozen=True, slots=True, eq=False)
class LoneRobot:
    """A robot's model."""

    name: str
    title: str
    spec: Any
    """An `MjSpec`, compiled once."""
    model: Any
    """The `MjModel` of it."""
    bounds: Mapping[str, JointBounds]
    """Joint -> its bounds, for joints with motors."""


def lone_robot(robot: Robot) -> LoneRobot:
    """The model of a robot as its file has it: joints without play, no payload, no noise."""
    spec, bounds = _climber(robot) if isinstance(robot, LimbedRobot) else _walker(robot)
    return LoneRobot(robot.name, robot.title, spec, spec.compile(), bounds)


def _climber(robot: LimbedRobot) -> tuple[Any, dict[str, JointBounds]]:
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


def _walker(robot: WalkerRobot) -> tuple[Any, dict[str, JointBounds]]:
    legs, arm = robot.legs, robot.arm
    bounds = {name: JointBounds(legs.shortest, legs.longest, None, legs.speed) for name in leg_names()}
    if arm is not None:
        ends = zip(arm_names(robot), arm.lowest, arm.highest, arm.fastest, strict=True)
        bounds |= {name: JointBounds(low, high, None, speed) for name, low, high, speed in ends}
    return walker_spec(robot, None, WalkerFlaws()), bounds
