"""What of a walker may fail in its trials."""

import math
from typing import Final

from ....execution.fault import Failing
from ....units import GRAVITY
from ..execution.own_sensors import FORCES, INCLINES, channels_of
from ..robot import WalkerRobot
from ..robot.weight import weight_of

BEGINS: Final = (1.0, 100.0)
"""First and last time at which a fault of a trial begins [s]: while the robot levels, and in its first steps."""


def failing_of(robot: WalkerRobot) -> Failing:
    """Sensors of lengths, forces, inclines and joints; motors of lengths and joints."""
    names = [channel.name for channel in channels_of(robot)]
    weight = GRAVITY * weight_of(robot).total
    arm = () if robot.arm is None else zip(robot.arm.lowest, robot.arm.highest, strict=True)
    spans = (
        *[robot.mechanism.stroke] * 3,
        *[robot.legs.stroke] * 6,
        *[weight] * 6,
        *[math.pi / 2] * 2,
        *(high - low for low, high in arm),
    )
    motors = [name for k, name in enumerate(names) if k < FORCES.start or k >= INCLINES.stop]
    return Failing(sensors=dict(zip(names, spans, strict=True)), motors=motors, weight=weight)
