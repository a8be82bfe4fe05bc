"""Torques that pass smoothly from one share of the load to another: a joint thrown across its play hits harder than any hold bears."""

import numpy as np

from ...types import Floats


class Easing:
    """Blends commanded torques from what they were when the easing began into what is wanted.

    Args:
        limbs: How many there are.
        period: Of the control [s].
    """

    def __init__(self, limbs: int, period: float) -> None:
        self._from, self._last = np.zeros((limbs, 2)), np.zeros((limbs, 2))
        self._part, self._step, self._period = 1.0, 0.0, period

    def begin(self, seconds: float) -> None:
        """Ease from the last torques, over that long [s]."""
        self._from[:] = self._last
        self._part, self._step = 0.0, self._period / seconds

    def blend(self, wanted: Floats) -> Floats:
        """Torques of this tick, shape (limbs, 2) [N m]; `wanted` itself where nothing is being eased."""
        if self._part < 1.0:
            self._part = min(1.0, self._part + self._step)
            wanted = self._from + self._part * (wanted - self._from)
        self._last[:] = wanted
        return wanted
