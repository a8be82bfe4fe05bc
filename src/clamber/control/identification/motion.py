"""What a joint's angle tells about its motion: how noisy it is, its speed, where it moves and where it stands."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.signal import savgol_filter

from ...types import Floats
from .samples import JointSamples

DEAD_PART: Final = 0.03
"""A joint slower than this part of its fast speed may be sticking [-]."""
NOISE_PART: Final = 5.0
"""Nor is a speed told from rest that is less than so many standard deviations of its noise."""
LONGEST_HALF: Final = 0.1
"""Half of the longest piece that a speed is read from [s]."""


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """The motion of one joint, at the times of its samples."""

    speed: Floats
    """By a straight line through the samples around [rad/s]."""
    acceleration: Floats
    """By a parabola through about twice as many [rad/s^2]."""
    noise: float
    """Standard deviation of the angle's noise [rad]."""
    dead: float
    """Speeds below this are not told from rest [rad/s]."""
    forward: Floats
    """1 where the joint moves forward, -1 backward, 0 where it may stand."""

    @property
    def moves(self) -> bool:
        """Whether it moves at all."""
        return bool(np.any(self.forward != 0.0))


def angle_noise(angle: Floats) -> float:
    """Standard deviation of white noise in an angle, from its third differences, the calm 90 % of them [rad]."""
    third = np.diff(angle, 3)
    # Differences of white noise have the variance of the sum of squared binomials, 1 + 9 + 9 + 1
    calm = np.sort(np.abs(third))[: max(1, int(0.9 * third.size))]
    shrunk = 0.7895  # standard deviation of a normal distribution without the outer tenth
    return float(np.sqrt(np.mean(calm**2) / 20.0) / shrunk)


def motion_of(samples: JointSamples) -> Motion:
    """The motion in evenly spaced samples."""
    period, angle = samples.period, samples.angle
    noise = angle_noise(angle)
    longest = max(2, min(round(LONGEST_HALF / period), (angle.size - 1) // 4))
    half = 2
    while True:
        speed = savgol_filter(angle, 2 * half + 1, 1, deriv=1, delta=period)
        fast = float(np.quantile(np.abs(speed), 0.95))
        speed_noise = noise / (period * np.sqrt(half * (half + 1) * (2 * half + 1) / 3.0))
        if NOISE_PART * speed_noise <= DEAD_PART * fast or half >= longest:
            break
        half = min(longest, half + 1 + half // 2)
    dead = max(DEAD_PART * fast, NOISE_PART * speed_noise)
    curve = min(2 * half + 3, (angle.size - 1) // 2)
    acceleration = savgol_filter(angle, 2 * curve + 1, 3, deriv=2, delta=period)
    forward = np.where(np.abs(speed) > dead, np.sign(speed), 0.0) if dead > 0.0 else np.zeros(angle.size)
    return Motion(speed=speed, acceleration=acceleration, noise=noise, dead=dead, forward=forward)
