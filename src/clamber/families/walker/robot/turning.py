"""How far the Y-frame turns about any point while the Delta-frame stands, exact."""

import cmath
import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np
import numpy.typing as npt

from .geometry import TwoFrames

HARMONICS: Final = 3
"""The singular measure along a turn has no higher ones."""

CLOSE: Final = 1e-12
"""Limits hold up to rounding [m], [rad], [-]."""


@dataclass(frozen=True, slots=True)
class TurningRange:
    """How far a turn goes each way from where it starts; both 0 if the start itself is outside the limits."""

    least: float
    """Clockwise, not positive [rad]."""
    most: float
    """Anticlockwise, not negative [rad]."""

    @property
    def span(self) -> float:
        """From end to end [rad]."""
        return self.most - self.least


def turning_range(
    frames: TwoFrames, pose: npt.ArrayLike, *, about: tuple[float, float] = (0.0, 0.0), guard: float | None = None
) -> TurningRange:
    """How far the Y-frame turns about a point of the Delta-frame from a pose.

    The tips turn about that point x on circles, so L_i^2 = |x - A_i|^2 + |t_i - x|^2 + 2 (x - A_i) . R(phi) (t_i - x) is a constant and
    one harmonic: it meets the squares of shortest and longest in closed form. The singular measure has three harmonics, and its zeros
    are those of a polynomial.

    Args:
        frames: The mechanism.
        pose: x, y [m], theta [rad] of the Y-frame in the Delta-frame, shape (3,).
        about: The point, in the Delta-frame [m]; turning about the Y-frame's own origin takes that of the pose.
        guard: Largest nearness of a singular pose [-]; None for strokes alone.
    """
    x, y, theta = (float(one) for one in np.asarray(pose, np.float64))
    p, centre = complex(x, y), complex(*about)

    def holds(turn: float) -> bool:
        turned = centre + cmath.rect(1.0, turn) * (p - centre)
        there = turned.real, turned.imag, theta + turn
        return frames.room(there) >= -CLOSE and (guard is None or frames.nearness(there) <= guard + CLOSE)

    if not holds(0.0):
        return TurningRange(0.0, 0.0)
    ends = _stroke_ends(frames, p, theta, centre)
    if guard is not None:
        ends += _guard_ends(frames, p, theta, centre, guard)
    return TurningRange(-_first_end([-end for end in ends], lambda turn: holds(-turn)), _first_end(ends, holds))


def _first_end(ends: list[float], holds: Callable[[float], bool]) -> float:
    """The first turn from 0 on at which the limits end, half a turn at most [rad]; between two `ends` they hold or they do not."""
    marks = sorted({0.0, math.pi, *(end % math.tau for end in ends if end % math.tau < math.pi)})
    for low, high in pairwise(marks):
        if high - low > CLOSE and not holds(0.5 * (low + high)):
            return low
    return math.pi


def _stroke_ends(frames: TwoFrames, p: complex, theta: float, about: complex) -> list[float]:
    """Turns at which an actuator is as short or as long as it can be [rad]."""
    ends = []
    for a, b in zip(frames.delta @ (1, 1j), frames.y @ (1, 1j), strict=True):
        arm, base = p + cmath.rect(1.0, theta) * b - about, about - a
        swing, mean = 2.0 * abs(arm) * abs(base), abs(arm) ** 2 + abs(base) ** 2
        for limit in (frames.longest, frames.shortest):
            if swing > 0.0 and abs(limit * limit - mean) < swing:
                half, longest_at = math.acos((limit * limit - mean) / swing), cmath.phase(base) - cmath.phase(arm)
                ends += [longest_at + half, longest_at - half]
    return ends


def _guard_ends(frames: TwoFrames, p: complex, theta: float, about: complex, guard: float) -> list[float]:
    """Turns at which the nearness is the guard [rad]."""

    def spare(turn: float) -> float:
        turned = about + cmath.rect(1.0, turn) * (p - about)
        here = frames.singular_measure((turned.real, turned.imag, theta + turn))
        return here - (1.0 - guard * guard) * frames.singular_measure((0.0, 0.0, theta + turn))

    n = 2 * HARMONICS + 2
    harmonics = np.fft.fft([spare(math.tau * k / n) for k in range(n)]) / n
    roots = np.roots(np.concatenate([harmonics[-HARMONICS:], harmonics[: HARMONICS + 1]])[::-1])
    return [cmath.phase(root) for root in roots if abs(abs(root) - 1.0) < 1e-6]
