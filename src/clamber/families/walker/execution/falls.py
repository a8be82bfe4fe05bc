"""A walker's fall told from its own sensors: nothing carries it, only two feet feel the ground, or the plate tilts."""

import math
from collections.abc import Callable
from typing import Final

import numpy as np

from ....types import Floats

BORNE: Final = 0.5
"""Feet that feel less than this part of the weight, all together, do not carry the robot."""
LOOSE: Final = 0.3
"""They do so for that long in a fall; a landing shakes for less [s]."""
LIGHT: Final = 5.0
"""A foot that feels less is off the ground [N]."""
LIFTED: Final = 1.0
"""Fewer than three feet feel the ground for that long only if the robot tips [s]."""
EMPTY: Final = 1.5
"""A foot that feels less carries nothing: of a robot of 80 kg that leaves the centre of mass less than a millimetre inside [N]."""
FELT: Final = 0.08
"""Time constant over which that is judged: load cells are noisy [s]."""
TIPPING: Final = 0.06
"""A robot whose centre of mass is at the edge of its feet tips if fewer than three carry anything for so long [s]."""
EDGE: Final = 0.01
"""A centre of mass that is believed to be less far inside the feet is at their edge; farther in, two feet that carry all are a kick [m]."""
TILTED: Final = math.radians(6.0)
"""A plate that tilts so far from what its legs say is falling [rad]."""


class FallWatch:
    """Looks at forces and tilt.

    Args:
        weight: Of the robot with its arm [N].
        period: Between two ticks [s].
    """

    def __init__(self, weight: float, period: float) -> None:
        self._least, self._period = BORNE * weight, period
        self._felt: Floats | None = None
        self._loose = self._lifted = self._tipping = self._tilted = 0.0

    def see(self, forces: Floats, tilted: float, margin: Callable[[], float]) -> str:
        """Take in a tick; why this is a fall, empty if it is none.

        Args:
            forces: Along the legs, shape (6,) [N].
            tilted: How far the inclinometers differ from what the legs say [rad].
            margin: Tells how far the centre of mass is believed to be inside the feet that stand [m].
        """
        if self._felt is None:
            self._felt = forces.copy()
        self._felt += min(1.0, self._period / FELT) * (forces - self._felt)
        two = int(np.count_nonzero(self._felt > EMPTY)) < 3
        self._tipping = self._tipping + self._period if two and margin() < EDGE else 0.0
        self._loose = self._loose + self._period if forces.sum() < self._least else 0.0
        off = int(np.count_nonzero(forces > LIGHT)) < 3
        self._lifted = self._lifted + self._period if off else 0.0
        self._tilted = self._tilted + self._period if tilted > TILTED else 0.0
        if self._loose > LOOSE:
            return f"nothing carries the robot: its feet feel {forces.sum():.0f} N together"
        if self._tilted > LOOSE:
            return f"the plate is tilted by {math.degrees(tilted):.1f} deg from what its legs say"
        if self._tipping > TIPPING or self._lifted > LIFTED:
            return "the robot tips: fewer than three of its feet carry anything"
        return ""
