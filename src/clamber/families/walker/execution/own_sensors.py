"""The sensors of a walker and the motors behind them: what is to be believed of a tick, and motors that do not follow their aims."""

import math
from typing import Final

import numpy as np

from ....execution.reading_monitor import Channel, ReadingMonitor
from ....types import Floats
from ....units import GRAVITY
from ..robot import LEG_NAMES, WalkerRobot
from .plant import WalkerSensed

BEHIND: Final = 0.5
"""A motor that is farther from its aim than it goes in this time at its fastest does not follow [s] ..."""
LAGS: Final = 0.2
"""... if it is for so long [s]."""
BLOWS: Final = 10.0
"""A blow bends a leg or an actuator so much faster than its motor goes [-]: in walks without a fault by up to its own speed."""
ACTUATORS, LEGS, FORCES, INCLINES, ARM = slice(0, 3), slice(3, 9), slice(9, 15), slice(15, 17), slice(17, None)
"""Where channels of a kind are."""


def channels_of(robot: WalkerRobot) -> tuple[Channel, ...]:
    """Lengths of actuators and legs, forces of the legs, both inclinometers, joints of the arm."""
    falls = math.sqrt(GRAVITY / robot.legs.nominal)  # as fast as a leg that is free to tip over turns [rad/s]
    arm = () if robot.arm is None else robot.arm.fastest
    return (
        *(Channel(name=f"actuator {i + 1}", fastest=BLOWS * robot.mechanism.speed) for i in range(3)),
        *(Channel(name=leg, fastest=BLOWS * robot.legs.speed) for leg in LEG_NAMES),
        *(Channel(name=f"load cell of {leg}", fastest=math.inf) for leg in LEG_NAMES),
        *(Channel(name=f"inclinometer {axis}", fastest=falls) for axis in "xy"),
        *(Channel(name=f"arm joint {i}", fastest=BLOWS * speed) for i, speed in enumerate(arm)),
    )


class OwnSensors:
    """Believes, bridges or gives up what the sensors of a walker say, and looks at how far its motors are from where they are to be.

    Args:
        robot: The walker.
        period: Of the control [s].
    """

    def __init__(self, robot: WalkerRobot, period: float) -> None:
        channels = channels_of(robot)
        self.monitor = ReadingMonitor(channels, period)
        speeds = np.array([channel.fastest for channel in channels])
        self._at = np.concatenate((np.arange(9), np.arange(ARM.start, len(speeds))))
        self._most, self._patience = BEHIND / BLOWS * speeds[self._at], LAGS / period
        self._behind = np.zeros(len(self._at))

    def reset(self) -> None:
        """Begin anew, as if all were well."""
        self.monitor.reset()
        self._behind[:] = 0.0

    def read(self, sensed: WalkerSensed) -> WalkerSensed:
        """What to believe of a tick.

        Raises:
            FaultError: If a sensor or the link has failed.
        """
        monitor = self.monitor
        values, speeds = monitor.values, monitor.speeds
        values[ACTUATORS], values[LEGS], values[FORCES] = sensed.actuators, sensed.legs.ravel(), sensed.forces.ravel()
        values[INCLINES], values[ARM] = sensed.inclines, sensed.arm
        speeds[:] = math.nan  # those of lengths and joints follow from them ...
        speeds[FORCES.start : INCLINES.stop] = 0.0  # ... and noise has none
        monitor.see(sensed.number)
        return WalkerSensed(
            sensed.time, values[ACTUATORS], values[LEGS].reshape(2, 3), values[FORCES].reshape(2, 3), values[INCLINES],
            values[ARM], sensed.number,
        )  # fmt: skip

    def follow(self, actuators: Floats, legs: Floats, arm: Floats) -> None:
        """Take in where the motors were told to be when the readings were taken.

        Raises:
            FaultError: If one does not follow.
        """
        monitor = self.monitor
        off = np.abs(np.concatenate((actuators, legs, arm)) - monitor.values[self._at])
        self._behind = np.where(off > self._most, self._behind + 1.0, 0.0)
        worst = int(np.argmax(self._behind))
        if self._behind[worst] > self._patience:
            channel = int(self._at[worst])
            monitor.bad.add(channel)
            why = (
                f"sensor stuck or drifting, or motor dead or weak: it is {off[worst]:.3g} from where it was told to be"
            )
            monitor.fail("no answer", monitor.channels[channel].name, why)
