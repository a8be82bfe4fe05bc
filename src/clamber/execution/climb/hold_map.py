"""What the climber knows of its holds' places: a Kalman filter that learns from where its hooks are when they are on them."""

from collections.abc import Iterable, Mapping, MutableMapping
from typing import Final

import numpy as np

from ...types import Floats

TIP_ERROR: Final = 0.002
"""Standard deviation of a difference of two tips that are on their holds, the play of their joints counted, along each axis [m]."""
KNOWN: Final = 0.001
"""Standard deviation of the place of a hold that the robot was put on, along each axis [m]."""


class HoldMap:
    """Places of the holds with their uncertainty, which is the same along both axes.

    Args:
        places: Number -> believed place, world frame, shape (2,) [m]; changed as the map learns, also by others.
        error: Largest error of a place before anything is learned, each way along each axis, evenly spread [m].
    """

    def __init__(self, places: MutableMapping[int, Floats], error: float) -> None:
        self.places = places
        self._row = {number: k for k, number in enumerate(places)}
        self._variance = np.eye(len(places)) * max(error, 1e-6) ** 2 / 3.0

    def know(self, numbers: Iterable[int]) -> None:
        """Count some holds as known: the robot has been put on them."""
        for number in numbers:
            k = self._row[number]
            self._variance[k], self._variance[:, k] = 0.0, 0.0
            self._variance[k, k] = KNOWN**2

    def learn(self, number: int, others: Mapping[int, Floats]) -> None:
        """Two or more hooks are on their holds: their tips' differences correct all holds that hang together with them.

        Args:
            number: Of a hold.
            others: Number of another hold -> measured place of the first less this one, world frame, shape (2,) [m].
        """
        for other, difference in others.items():
            a, b = self._row[number], self._row[other]
            towards = self._variance[:, a] - self._variance[:, b]
            gain = towards / (towards[a] - towards[b] + TIP_ERROR**2)
            lack = difference - (self.places[number] - self.places[other])
            for one, k in self._row.items():
                self.places[one] = self.places[one] + gain[k] * lack
            self._variance -= np.outer(gain, towards)

    def error(self, number: int) -> float:
        """How far off a hold's place may be along each axis: the map's error, less what has been learned [m]."""
        k = self._row[number]
        return float(np.sqrt(3.0 * self._variance[k, k]))
