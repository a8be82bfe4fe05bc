"""What a phase of the gait leaves of the plate's freedoms to a tool, and what the tool has made of them.

While a frame slides the plate stands on the other's three feet: its height is free between what those legs, the lifted and the landing
ones allow. Feet that are lifted or lowered need a plate that rests. All other freedoms have a use in walking, or none for a tool:
`docs/walks.md` tells which and why.
"""

from dataclasses import dataclass, field
from typing import Final

import numpy as np

from ....control.quintic import quintic_share
from ....types import Floats
from ..control.cooperative.freedoms import HEIGHT

FADE: Final = 1.0
"""In which a freedom is faded in, and out again before its phase ends [s]."""
ARRIVED: Final = 1e-4
"""A plate that is so near to where walking has it no longer goes there [m]."""


def open_share(time: float, left: float) -> float:
    """Weight of a freedom at a time of its phase [-]: 0 at both ends, with speed and acceleration; 1 but within `FADE` of them.

    Args:
        time: Since the phase began [s].
        left: Until it ends [s].
    """
    return quintic_share(time / FADE) * quintic_share(left / FADE)


@dataclass(slots=True)
class FreeBaseFreedoms:
    """Of one walker, as its motions set it."""

    weights: Floats = field(default_factory=lambda: np.zeros(6))
    """Of x, y, z, alpha, beta, gamma: 1 for those that the phase leaves, 0 for those that walking has, shape (6,) [-]."""
    lowest: float = 0.0
    """Heights of the plate between which all legs have room in this step [m], world ..."""
    highest: float = 0.0
    """... lifted, standing and landing."""
    raised: float = 0.0
    """By how much the plate is to be higher than walking would have it [m]."""

    def hold(self, own: float, lowest: float, highest: float, wish: float) -> float:
        """Take a step's room, and say how high the plate is to be in it [m].

        Args:
            own: Where walking would have it [m].
            lowest, highest: Between which it may be; where that is nothing it is as walking has it [m].
            wish: By how much it is wished higher [m].
        """
        if lowest > highest:
            lowest = highest = own
        height = min(highest, max(lowest, own + wish))
        self.lowest, self.highest, self.raised = lowest, highest, height - own
        return height

    def open(self, weight: float) -> None:
        """Leave the height free, as far as this phase does now."""
        self.weights[HEIGHT] = weight
