"""A slide that stops where a lifted foot runs against the ground: higher than anybody knew."""

from typing import Final

import numpy as np

from .walker import RefusedError, Walker, leg_name

OVER: Final = 0.015
"""Feet are lifted so far above the highest ground that was found about the plane through it [m]: what comes may be higher."""
BRUSHED: Final = 10.0
"""A lifted foot that feels more than this, either way, has run against something [N]; the noise of load cells is a few newtons."""
BRAKE: Final = 0.2
"""In which a slide stops when a lifted foot runs against the ground [s]."""


class Brake:
    """Stops a slide while a lifted foot that has run against the ground is drawn up.

    A leg feels along itself only: against a wall that is how the foot rubs on it, up or down.
    """

    def __init__(self, walker: Walker, swing: int) -> None:
        self._walker, self._legs = walker, list(walker.of_frame(swing))
        self._felt, self._drawn = np.zeros(3, np.int32), np.zeros(3, np.bool_)
        self._met: set[int] = set()
        self.pace = 1.0
        """Of the slide, 1 as fast as it may."""

    @property
    def free(self) -> list[int]:
        """Legs that have not run against anything, and may go down before the slide ends."""
        return [i for i in self._legs if i not in self._met]

    def see(self) -> None:
        """Take in a tick.

        Raises:
            RefusedError: If a foot runs against ground that is higher than its leg can be drawn up.
        """
        walker, legs = self._walker, self._legs
        self._felt = np.where(np.abs(walker.forces[legs]) > BRUSHED, self._felt + 1, 0)
        felt = self._felt >= walker.settings.touches
        self._drawn &= walker.lengths[legs] - walker.free_aims[legs] > 1e-6
        self._drawn |= felt
        for i in np.array(legs)[felt].tolist():
            self._met.add(i)
            if walker.lengths[i] < walker.robot.legs.shortest + 1e-6:
                raise RefusedError(f"{leg_name(i)} runs against ground that is higher than it can be lifted")
            walker.free_aims[i] = max(walker.robot.legs.shortest, walker.lengths[i] - OVER)
        change = walker.period / BRAKE
        self.pace = max(0.0, self.pace - change) if self._drawn.any() else min(1.0, self.pace + change)
