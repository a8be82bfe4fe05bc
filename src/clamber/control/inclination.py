"""What two noisy inclinometers say of the tilt that a walker's legs tell: a filter whose trust in both is stated.

The legs' lengths over believed footholds tell every change of the tilt at once, but not the tilt of the ground; inclinometers tell the
whole, but noisily, late, and wrongly while the plate is accelerated. A Kalman filter of one state an axis, the error of what the legs say,
joins them.
"""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from ..types import Floats
from .posture import inclines_of_tilt, tilt_of_inclines

DEGREE: Final = math.pi / 180.0


@dataclass(frozen=True, slots=True, kw_only=True)
class InclinometerTrust:
    """What is believed of the inclinometers and of the legs."""

    noise: float = 0.05 * DEGREE
    """Standard deviation of a reading [rad]."""
    time_constant: float = 0.2
    """Of the inclinometers' own filter [s]: readings nearer in time than this say the same."""
    drift: float = 0.005 * DEGREE
    """How far the tilt that the legs say strays from the true one in a second: feet settle [rad/sqrt(s)]."""
    start: float = 0.1 * DEGREE
    """How unsure the tilt is at first [rad]."""

    def __post_init__(self) -> None:
        for key in ("noise", "time_constant", "drift", "start"):
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
        """Readings that are worth one."""
        self._noise = together * trust.noise**2
        self._lag = min(1.0, period / trust.time_constant) if trust.time_constant > 0.0 else 1.0
        self.offsets: Floats = np.zeros(2)
        """What the inclinometers read too much [rad]."""
        self.frozen = False
        """Whether readings are left out: while a slide speeds up, accelerations look like tilt."""
        self._variance = trust.start**2
        self._lagged: Floats | None = None
        """The believed readings, late as those of the inclinometers are, shape (2,) [rad]."""

    @property
    def unsure(self) -> float:
        """Standard deviation of the tilt along each axis, offsets aside [rad]."""
        return math.sqrt(self._variance)

    def doubt(self, size: float) -> None:
        """Something may have tilted the plate by `size` [rad] that the legs do not tell."""
        self._variance = max(self._variance, size * size)

    def off(self, readings: Floats) -> float:
        """How far these readings differ from what was believed when they were taken [rad]."""
        if self._lagged is None:
            return 0.0
        return float(np.linalg.norm(readings - self.offsets - self._lagged))

    def see(self, readings: Floats, beta: float, gamma: float) -> tuple[float, float]:
        """By how much the tilt differs from what the legs say, as far as this reading is worth it: changes of beta and gamma [rad].

        Args:
            readings: Of both inclinometers, shape (2,) [rad].
            beta, gamma: Tilt by the legs [rad].
        """
        believed = np.array(inclines_of_tilt(beta, gamma))
        if self._lagged is None:
            self._lagged = believed
        self._lagged += self._lag * (believed - self._lagged)
        self._variance += self.trust.drift**2 * self._period
        if self.frozen:
            return 0.0, 0.0
        gain = self._variance / (self._variance + self._noise) if self._variance > 0.0 else 0.0
        self._variance *= 1.0 - gain
        along, across = believed + gain * (readings - self.offsets - self._lagged)
        seen_beta, seen_gamma = tilt_of_inclines(along, across)
        # the believed readings follow what is believed now, not late
        self._lagged += np.array((along, across)) - believed
        return seen_beta - beta, seen_gamma - gamma
