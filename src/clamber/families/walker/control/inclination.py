"""What two noisy inclinometers say of the tilt that a walker's legs tell: a filter whose trust in both is stated.

The legs' lengths over believed footholds tell every change of the tilt at once, but not the tilt of the ground; inclinometers tell the
whole, but noisily, late, and wrongly while the plate is accelerated. And a foot that takes load sinks in, by as much as its load cell says
times a give that nobody has measured. A Kalman filter joins them. Its state is the error of the tilt along both axes, and the give.
"""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from ....control.reading import weigh_reading
from ....types import Floats
from .posture import inclines_of_tilt, tilt_of_inclines

DEGREE: Final = math.pi / 180.0


MOST_GIVE: Final = 3e-5
"""Feet that sank in by more would not be stood on: what 10 mm of soft ground give under the robot's weight [m/N]."""
MOST_DOUBT: Final = 0.04 * DEGREE
"""A tilt that is this unsure follows the readings within a second; more, and it would follow their noise [rad]."""
WATCHED: Final = 1.0
"""Over which readings are compared with what is believed [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class InclinometerTrust:
    """What is believed of the inclinometers, the legs and the feet."""

    noise: float = 0.05 * DEGREE
    """Standard deviation of a reading [rad]."""
    time_constant: float = 0.2
    """Of the inclinometers' own filter [s]: readings nearer in time than this say the same."""
    drift: float = 0.0034 * DEGREE
    """How far the tilt that the legs say strays from the true one in a second: feet settle [rad/sqrt(s)]."""
    start: float = 0.1 * DEGREE
    """How unsure the tilt is at first [rad]."""
    give: float = 1e-5
    """By how much a foot sinks in under load, with the ground [m/N] ..."""
    give_doubt: float = 1e-5
    """... and how unsure that is at first [m/N]."""
    give_drift: float = 2e-8
    """How far that strays in a second: no foothold is like another [m/(N sqrt(s))]."""
    surprise: float = 4.0
    """Readings that differ for a second by more than this many of their deviations tell of something that nothing else told [-]."""

    def __post_init__(self) -> None:
        for key in ("noise", "time_constant", "drift", "start", "give", "give_doubt", "give_drift", "surprise"):
            if not 0.0 <= getattr(self, key) < math.inf:
                raise ValueError(f"{key} = {getattr(self, key)}: must be 0 or more, and finite")


class Inclination:
    """The filter.

    Args:
        trust: What is believed.
        period: Between two readings [s].
    """

    def __init__(self, trust: InclinometerTrust, period: float) -> None:
        self.trust, self._period = trust, period
        together = max(1.0, 2.0 * trust.time_constant / period)
        """Readings worth one."""
        self._noise = together * trust.noise**2
        self._lag = min(1.0, period / trust.time_constant) if trust.time_constant > 0.0 else 1.0
        self.offsets: Floats = np.zeros(2)
        """What the inclinometers read too much [rad]."""
        self.frozen = False
        """Whether readings are left out: while a slide speeds up, accelerations look like tilt."""
        self.give = trust.give
        """By how much a foot sinks in under load, as learned [m/N]."""
        self.learns = False
        """Whether readings teach the give: only while nothing but load shifts, or a slip is taken for it."""
        self._covariance = np.diag((trust.start**2, trust.start**2, trust.give_doubt**2))
        self._lagged: Floats | None = None
        """The believed readings, late as those of the inclinometers are, shape (2,) [rad]."""
        self._differs = np.zeros(2)
        """By how much the readings of the last second differ from those, shape (2,) [rad]."""
        correlated = trust.time_constant / (trust.time_constant + WATCHED)
        self._surprising = trust.surprise * trust.noise * math.sqrt(correlated)

    @property
    def unsure(self) -> float:
        """Standard deviation of the tilt along the axis where it is larger, offsets aside [rad]."""
        return math.sqrt(max(self._covariance[0, 0], self._covariance[1, 1]))

    @property
    def unsure_give(self) -> float:
        """Standard deviation of the give [m/N]."""
        return math.sqrt(self._covariance[2, 2])

    def doubt(self, size: float) -> None:
        """Something may have tilted the plate by `size` [rad] that nothing else tells."""
        for k in range(2):
            self._covariance[k, k] = max(self._covariance[k, k], size * size)

    def sink(self, change: Floats) -> None:
        """Feet have taken or lost load, and the plate has tilted by `give` times this along its axes, shape (2,) [rad N/m]."""
        moves = np.eye(3)
        moves[:2, 2] = change
        self._covariance = moves @ self._covariance @ moves.T

    def off(self, readings: Floats) -> float:
        """How far these readings differ from what was believed when they were taken [rad]."""
        if self._lagged is None:
            return 0.0
        return float(np.hypot(*(readings - self.offsets - self._lagged)))

    def see(self, readings: Floats, beta: float, gamma: float) -> tuple[float, float]:
        """By how much the tilt differs from what is believed, as far as this reading is worth it: changes of beta and gamma [rad].

        Args:
            readings: Of both inclinometers, shape (2,) [rad].
            beta, gamma: Tilt by the legs [rad].
        """
        believed = np.array(inclines_of_tilt(beta, gamma))
        if self._lagged is None:
            self._lagged = believed
        self._lagged += self._lag * (believed - self._lagged)
        self._covariance[0, 0] += self.trust.drift**2 * self._period
        self._covariance[1, 1] += self.trust.drift**2 * self._period
        self._covariance[2, 2] += self.trust.give_drift**2 * self._period
        if self.frozen:
            self._differs[:] = 0.0
            return 0.0, 0.0
        off = readings - self.offsets - self._lagged
        self._differs += self._period / WATCHED * (off - self._differs)
        much = float(np.abs(self._differs).max())
        if much > self._surprising:
            self.doubt(min(much, MOST_DOUBT))
        move = np.zeros(3)
        if not weigh_reading(
            self._covariance, self._noise, off, self.learns, move
        ):  # exact sensors and no doubt at all
            return 0.0, 0.0
        self.give = min(MOST_GIVE, max(0.0, self.give + float(move[2])))
        # the late readings follow what is believed now, not late
        self._lagged += move[:2]
        seen_beta, seen_gamma = tilt_of_inclines(believed[0] + move[0], believed[1] + move[1])
        return seen_beta - beta, seen_gamma - gamma
