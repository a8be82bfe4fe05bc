"""A walker's fall told from its own sensors: nothing carries it, only two feet feel the ground, or the plate tilts."""

import math
from typing import Final

import numpy as np

from ...types import Floats

BORNE: Final = 0.5
"""Feet that feel less than this part of the weight, all together, do not carry the robot."""
LOOSE: Final = 0.3
"""They do so for that long in a fall; a landing shakes for less [s]."""
LIGHT: Final = 5.0
"""A foot that feels less is off the ground [N]."""
LIFTED: Final = 1.0
"""Fewer than three feet feel the ground for that long only if the robot tips [s]."""
TILTED: Final = math.radians(6.0)
"""A plate that tilts so far from what its legs say is falling [rad]."""


class FallWatch:
    """Looks at forces and tilt tick by tick.

    Args:
        weight: Of the robot with its arm [N].
        period: Between two ticks [s].
    """

    def __init__(self, weight: float, period: float) -> None:
        self._least, self._period = BORNE * weight, period
        self._loose = self._lifted = self._tilted = 0.0

    def see(self, forces: Floats, tilted: float) -> str:
        """Take in a tick; why this is a fall, empty if it is none.

        Args:
            forces: Along the legs, shape (6,) [N].
            tilted: How far the inclinometers differ from what the legs say [rad].
        """
        self._loose = self._loose + self._period if forces.sum() < self._least else 0.0
        off = int(np.count_nonzero(forces > LIGHT)) < 3
        self._lifted = self._lifted + self._period if off else 0.0
        self._tilted = self._tilted + self._period if tilted > TILTED else 0.0
        if self._loose > LOOSE:
            return f"nothing carries the robot: its feet feel {forces.sum():.0f} N together"
        if self._tilted > LOOSE:
            return f"the plate is tilted by {math.degrees(tilted):.1f} deg from what its legs say"
        if self._lifted > LIFTED:
            return "the robot tips: fewer than three of its feet feel the ground"
        return ""
