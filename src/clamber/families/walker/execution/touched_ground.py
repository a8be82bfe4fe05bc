"""Ground that nobody knows beforehand, as footfalls have told of it: the plane through them, and how far they lie off it."""

import math
from collections import deque
from typing import Final

import numpy as np

from ....types import Floats

KEPT: Final = 24
"""So many of the last footfalls count: those of four steps, or as many frames' lengths."""
FREE: Final = 3
"""Numbers that a plane has."""


class TouchedGround:
    """The last footfalls of a walker, as it believes them."""

    def __init__(self) -> None:
        self._footfalls: deque[Floats] = deque(maxlen=KEPT)
        self._middle: Floats = np.zeros(3)
        self._slope: Floats = np.zeros(2)
        self.rough = 0.0
        """How far above or below the plane ground is to be expected [m]."""

    @property
    def known(self) -> bool:
        """Whether there were enough of them."""
        return len(self._footfalls) > FREE

    def add(self, place: Floats, height: float) -> None:
        """Take in a footfall.

        Args:
            place: Of the sole in the world, seen from above, shape (2,) [m].
            height: Of it [m].
        """
        self._footfalls.append(np.array((place[0], place[1], height)))
        found = np.array(self._footfalls)
        self._middle = found.mean(axis=0)
        about = found - self._middle
        self._slope[:] = np.linalg.lstsq(about[:, :2], about[:, 2], rcond=1e-6)[0]
        off = float(np.abs(about[:, 2] - about[:, :2] @ self._slope).max())
        # the plane has gone by these footfalls, and others lie farther off it
        self.rough = off * math.sqrt(len(found) / (len(found) - FREE)) if len(found) > FREE else 0.0

    def heights(self, places: Floats) -> Floats:
        """Of the plane at places in the world, shape (n, 2) [m]; shape (n,) [m]."""
        heights: Floats = self._middle[2] + (np.asarray(places) - self._middle[:2]) @ self._slope
        return heights
