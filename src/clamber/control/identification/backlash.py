"""The play of a gear: how far the angle behind it can be from the motor's, one end of the play to the other."""

from typing import Final

import numpy as np

from ...types import Floats
from .estimate import Estimate
from .motion import angle_noise
from .samples import JointSamples

LEAST_PART: Final = 0.02
"""Of the samples must lie at each end of the play."""
APART: Final = 4.0
"""Ends must be so many standard deviations of the noise apart, or there is no play to see."""
NEARER: Final = (0.3, 0.15, 0.08, 0.04, 0.04)
"""Part of the play within which samples count as at its ends, round by round: those that cross it are sorted out."""
BLOCK_TIME: Final = 0.25
"""Samples that are resampled together [s]: a side of the play is kept for a while."""
RESAMPLES: Final = 100


def backlash(samples: JointSamples, speed: Floats, seed: int = 0) -> Estimate:
    """Play from the angles on both sides of the gear: the distance of the two places where their difference stays.

    The load lies at one end of the play while it is pushed and at the other while it is pulled; the most frequent difference in each
    half of the differences is that end, whatever crosses between them and whatever noise widens them. Where one sensor is late, the
    difference holds speed times that time, which is taken off first.

    Args:
        samples: Evenly spaced, of one joint.
        speed: Of the motor, at the joint's scale [rad/s].
        seed: Of the bootstrap.
    """
    if samples.output_angle is None:
        return _missing("an angle measured behind the gear, and reversals")
    noise = angle_noise(samples.output_angle) + angle_noise(samples.angle)
    gap = _without_delay(samples.output_angle - samples.angle, speed, noise)
    ends = _ends(gap, noise)
    if ends is None:
        spread = float(np.quantile(gap, 0.99) - np.quantile(gap, 0.01))
        if spread > 2 * APART * noise:
            return _missing("reversals: the load stayed at one end of the play")
        return Estimate(
            "backlash", "rad", 0.0, noise, 0.0, APART * noise, "no play seen above the noise of both angles"
        )
    rng = np.random.default_rng(seed)
    parts = np.array_split(gap, max(2, round(gap.size * samples.period / BLOCK_TIME)))
    draws = []
    for _ in range(RESAMPLES):
        again = _ends(np.concatenate([parts[p] for p in rng.integers(0, len(parts), len(parts))]), noise)
        if again is not None:
            draws.append(again[1] - again[0])
    low, high = np.quantile(draws, (0.025, 0.975))
    method = "ends of the play between both angles"
    return Estimate("backlash", "rad", ends[1] - ends[0], float(np.std(draws)), float(low), float(high), method)


def _without_delay(gap: Floats, speed: Floats, noise: float) -> Floats:
    """Differences of two angles without the part of the speed in them, told from the samples near the ends of the play."""
    for part in NEARER:
        low, high = _halves(gap)
        if min(low.size, high.size) < LEAST_PART * gap.size:
            sides = np.ones((gap.size, 1))
        else:
            ends = _mode(low), _mode(high)
            reach = max(part * (ends[1] - ends[0]), 3.0 * noise)
            sides = np.column_stack([np.abs(gap - end) < reach for end in ends]).astype(np.float64)
        near = sides.any(axis=1)
        if float(np.ptp(speed[near])) == 0.0:
            return gap
        design = np.column_stack((speed, sides))[near]
        gap = gap - np.linalg.lstsq(design, gap[near], rcond=None)[0][0] * speed
    return gap


def _halves(gap: Floats) -> tuple[Floats, Floats]:
    """Differences below and above the middle of their range, sorted."""
    ordered = np.sort(gap)
    middle = float(ordered[0] + ordered[-1]) / 2
    return ordered[ordered < middle], ordered[ordered >= middle]


def _ends(gap: Floats, noise: float) -> tuple[float, float] | None:
    """The two differences that occur most, one in each half; None if they are not two."""
    lower, upper = _halves(gap)
    if min(lower.size, upper.size) < LEAST_PART * gap.size:
        return None
    ends = _mode(lower), _mode(upper)
    return ends if ends[1] - ends[0] > APART * noise else None


def _mode(ordered: Floats) -> float:
    """Mean of the shortest interval that holds half of sorted values, halved until a tenth is left (half-sample mode)."""
    least = max(8, ordered.size // 10)
    while ordered.size > least:
        half = (ordered.size + 1) // 2
        widths = ordered[half - 1 :] - ordered[: ordered.size - half + 1]
        start = int(np.argmin(widths))
        ordered = ordered[start : start + half]
    return float(np.mean(ordered))


def _missing(needs: str) -> Estimate:
    return Estimate("backlash", "rad", needs=needs)
