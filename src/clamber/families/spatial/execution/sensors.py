"""Sensors of a robot in space side by side: their names, and what they cover by the robot's own size, weight and motors."""

import math
from typing import Final

import numpy as np

from ....types import Floats
from ....units import GRAVITY
from ..robot.parts import Motors
from ..robot.robot import SpatialRobot
from .settings import Pace

TURNS: Final = 2.0
"""Range of a gyro, over the angular speed that a body has which falls over by its own size [-]."""
PUSHES: Final = 4.0
"""Range of an accelerometer, over free fall on Earth [-]."""
LEVER: Final = 0.1
"""Range of a tip's moments, over the weight at the longest limb's length [-]."""
AXES: Final = ("x", "y", "z")


def sensor_names(robot: SpatialRobot) -> tuple[str, ...]:
    """Of encoders, motors' torques, gyro, accelerometer and tips' wrenches, one after another."""
    chains = robot.chains
    joints = [name for limb in chains.joint_names for name in limb]
    imu = [f"{unit} {axis}" for unit in ("gyro", "accelerometer") for axis in AXES]
    tips = [f"{limb} {what} {axis}" for limb in chains.limb_names for what in ("force", "moment") for axis in AXES]
    return (*joints, *(f"{name} torque" for name in joints), *imu, *tips)


def sensor_ranges(robot: SpatialRobot) -> Floats:
    """What each of these sensors covers, by the robot's own size, weight and motors, shape (sensors,)."""
    chains, pace, limbs = robot.chains, Pace.of(robot), len(robot.chains.limb_names)
    span = (chains.upper - chains.lower)[chains.used]
    span = np.where(np.isfinite(span), span, math.tau)
    turning, weight = 2.0 * TURNS * math.sqrt(2.0 * GRAVITY / pace.size), pace.weight
    imu, tip = [turning] * 3 + [2.0 * PUSHES * GRAVITY] * 3, [weight] * 3 + [LEVER * pace.size * weight] * 3
    return np.concatenate((span, 2.0 * Motors.of(robot).torque, imu, tip * limbs))
