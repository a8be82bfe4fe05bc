"""What holds a robot up when nobody commands it: without power the gearbox lets it fall, so a safe stop keeps every joint where it is."""

from typing import Final

import numpy as np

from ..types import Floats
from .hardware import Decoder, Reading
from .wiring import Wiring

RATE: Final = 25.0
"""Natural frequency of a joint that moves its own motor alone: about what a climber's free limbs have [rad/s]."""
DAMPING: Final = 0.7
"""Damping ratio of the same [-]."""


class JointHold:
    """Torques that hold joints where they are.

    Args:
        inertias: Of each joint with its motor and gear, shape (n,) [kg m^2].
    """

    def __init__(self, inertias: Floats) -> None:
        self._kp, self._kd = RATE**2 * inertias, 2 * DAMPING * RATE * inertias

    def torques(self, posture: Floats, fed: Floats, q: Floats, qd: Floats) -> Floats:
        """Of a tick, shape (n,) [N m].

        Args:
            posture: Joint angles to hold, shape (n,) [rad].
            fed: Torques that held it before, shape (n,) [N m].
            q, qd: Joint angles and speeds now, shape (n,).
        """
        torques: Floats = fed + self._kp * (posture - q) - self._kd * qd
        return torques


class PostureGuard:
    """Joint PD about a posture, with the last command before it fed forward, so that loads that it carried do not let the robot sag.

    Args:
        wiring: Of the robot.
        inertias: Of each joint with its motor and gear, shape (n_joints,) [kg m^2].
        period: Of the control [s].
    """

    def __init__(self, wiring: Wiring, inertias: Floats, period: float) -> None:
        self._wiring, self._n = wiring, wiring.n_joints
        self._law = JointHold(inertias)
        self._decoder = Decoder(wiring, period)
        self._posture, self._fed = np.zeros(self._n), np.zeros(self._n)
        self.at_rest: Floats = np.append(np.zeros(self._n), np.ones(len(wiring.grippers)))
        """Commands before the first: no volts, and whatever grips is shut, shape (n_commands,)."""
        self._switches = self.at_rest[self._n :]

    def hold(self, reading: Reading, commands: Floats) -> None:
        """From now on, hold the posture of `reading`, in which `commands` were given, shape (n_commands,); grippers stay as they are."""
        self._decoder.reset()
        self._posture = self._decoder.decode(reading)[0][: self._n]
        self._fed, self._switches = self._wiring.torques(commands[: self._n]), commands[self._n :]

    def commands(self, reading: Reading) -> Floats:
        """Of this tick, shape (n_commands,)."""
        angles, speeds = (values[: self._n] for values in self._decoder.decode(reading))
        volts = self._wiring.volts(self._law.torques(self._posture, self._fed, angles, speeds))
        return np.append(volts, self._switches)

    def moved(self, reading: Reading) -> float:
        """How far the joint that has moved most is off the posture [rad]."""
        return float(np.abs(self._wiring.angles(reading.counts)[: self._n] - self._posture).max())
