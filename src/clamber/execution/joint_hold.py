"""A posture held by its joints alone: PD about it, with what the motors gave before fed forward."""

from typing import Final

from ..types import Floats

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
