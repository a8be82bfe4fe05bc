"""What the climber knows of its holds' places and of its sensors' errors: an extended Kalman filter that learns from hooks on holds."""

import math
from collections.abc import Iterable, MutableMapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from ....types import Floats

TIP_ERROR: Final = 0.001
"""Standard deviation of a difference of two tips on their holds, each joint surely on one side of its play, along each axis [m]."""
ODD: Final = 4.0
"""What differs from what is expected by more than so many standard deviations was learned from a hook that was not home [-]."""
ANGLE_ERROR: Final = math.radians(1.0) / math.sqrt(3.0)
"""Standard deviation of the offset of the body's own encoder: a degree either way, evenly spread [rad]."""
PLAY_ERROR: Final = math.radians(0.15)
"""Standard deviation of half the backlash that is reckoned with: a quarter of a degree either way, evenly spread [rad]."""


@dataclass(frozen=True, slots=True, eq=False)
class TipDifference:
    """Where one tip is from another, world frame, and how that would change with what is wrong about the sensors."""

    place: Floats
    """Shape (2,) [m]."""
    by_angle: Floats
    """Change of `place` per offset of the body's encoder, shape (2,) [m/rad]."""
    by_play: Floats
    """Change of `place` per half backlash of every joint, shape (2,) [m/rad]."""
    by_joints: Floats
    """Change of `place` per angle at the gear output of each joint of the one limb, then of the other, shape (2, joints) [m/rad]."""
    loose: Floats
    """How far off each of these may be where its joint is on no side of its play for sure, standard deviations, shape (joints,) [rad]."""

    @property
    def unsure(self) -> Floats:
        """Covariance of `place` by that, shape (2, 2) [m^2]."""
        spread = self.by_joints * self.loose
        return np.asarray(spread @ spread.T)


class HoldMap:
    """Places of the holds, the offset of the body's encoder and the joints' half backlash, with their common uncertainty.

    The state holds every place's x and y, then the offset, then the half backlash.

    Args:
        places: Number -> believed place, world frame, shape (2,) [m]; changed as the map learns, also by others.
        error: Largest error of a place before anything is learned, each way along each axis, evenly spread [m].
        backlash: Whole play of a joint as it is believed [rad].
        terrain: Covariance of all places' x and y in turn besides that error, for a board that is warped or turned as a whole, so that a
            hold that is touched tells of its neighbours, shape (2 n, 2 n) [m^2]; None: each is off by itself.
    """

    def __init__(
        self,
        places: MutableMapping[int, Floats],
        error: float,
        *,
        backlash: float = 0.0,
        terrain: Floats | None = None,
    ) -> None:
        self.places, self._error = places, error
        self.offset = 0.0
        """What the body's encoder tells too much [rad]."""
        self.half_play = backlash / 2
        """Half the backlash, the same at every joint [rad]."""
        self._row = {number: 2 * k for k, number in enumerate(places)}
        own = np.full(2 * len(places) + 2, max(error, 1e-6) ** 2 / 3.0)
        own[-2], own[-1] = ANGLE_ERROR**2, PLAY_ERROR**2 if backlash > 0.0 else 0.0
        self._variance = np.diag(own)
        self._mapped = None if terrain is None else {number: place.copy() for number, place in places.items()}
        self._latest: tuple[int, ...] = ()
        if terrain is not None:
            self._variance[:-2, :-2] += terrain

    def learn(self, number: int, other: int, seen: TipDifference) -> Floats:
        """Two hooks are on their holds: the difference of their tips corrects all that hangs together with it.

        Where it is too odd for what is known, the place of the first hold counts as little known again.

        Args:
            number: Of the hold of the one tip, the one that was taken last.
            other: Of that of the other.
            seen: Place of the one tip less that of the other, by the sensors as they are believed now.

        Returns:
            What of it is put down to joints that may be anywhere in their play: by how much their angles at the gear outputs are more than
            believed, shape (joints,) [rad].
        """
        self._latest = (number, other)
        slope = self._slope(number, other, seen)
        lack = seen.place - (self.places[number] - self.places[other])
        noise = seen.unsure + TIP_ERROR**2 * np.eye(2)
        if lack @ np.linalg.solve(slope @ self._variance @ slope.T + noise, lack) > ODD**2:
            for k in (self._row[number], self._row[number] + 1):
                self._variance[k, k] += self._error**2 / 3.0
        towards = self._variance @ slope.T
        weight = np.linalg.inv(slope @ towards + noise)
        gain = towards @ weight
        change = gain @ lack
        for one, k in self._row.items():
            self.places[one] = self.places[one] + change[k : k + 2]
        self.offset += float(change[-2])
        self.half_play = max(0.0, self.half_play + float(change[-1]))
        self._variance -= gain @ towards.T
        self._variance = 0.5 * (self._variance + self._variance.T)
        return np.asarray(-(seen.loose**2 * seen.by_joints).T @ weight @ lack)

    def shift(self, numbers: Iterable[int]) -> Floats:
        """How far holds are believed to be from where they were mapped, on the average, shape (2,) [m]; none on even terrain."""
        known = [number for number in numbers if number in self.places]
        if self._mapped is None or not known:
            return np.zeros(2)
        return np.asarray(np.mean([self.places[number] - self._mapped[number] for number in known], axis=0))

    def error(self, number: int) -> float:
        """How far off a hold's place may be along each axis: the map's error, less what has been learned [m].

        On uneven terrain, seen from the holds that were learned last: all that is near may be off alike, and is met alike.
        """
        k = self._row[number]
        spans = [self._variance[k : k + 2, k : k + 2]]
        if self._mapped is not None and any(one != number for one in self._latest):
            rows = [self._row[one] for one in self._latest if one != number]
            spans = [
                spans[0] + self._variance[j : j + 2, j : j + 2] - self._variance[k : k + 2, j : j + 2]
                - self._variance[j : j + 2, k : k + 2]
                for j in rows
            ]  # fmt: skip
        return math.sqrt(3.0 * min(max(span[0, 0], span[1, 1]) for span in spans))

    def doubt(self, number: int, other: int, seen: TipDifference) -> float:
        """How far off a tip that is on a hold may seem to be along each axis, by another tip that is on its own [m].

        As an even spread has it: at first twice the map's error where neither hold is known.
        """
        slope = self._slope(number, other, seen)
        return math.sqrt(3.0 * float(np.linalg.eigvalsh(slope @ self._variance @ slope.T + seen.unsure)[-1]))

    def _slope(self, number: int, other: int, seen: TipDifference) -> Floats:
        """How the difference of two holds, less that of the tips on them, changes with the state, shape (2, n)."""
        slope = np.zeros((2, len(self._variance)))
        a, b = self._row[number], self._row[other]
        slope[:, a : a + 2] += np.eye(2)
        slope[:, b : b + 2] -= np.eye(2)
        slope[:, -2], slope[:, -1] = -seen.by_angle, -seen.by_play
        return slope
