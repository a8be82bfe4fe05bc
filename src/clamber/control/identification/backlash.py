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
BLOCK_TIME: Final = 0.25
"""Samples that are resampled together [s]: a side of the play is kept for a while."""
RESAMPLES: Final = 100


def backlash(samples: JointSamples, seed: int = 0) -> Estimate:
    """Play from the angles on both sides of the gear: the distance of the two places where their difference stays.

    The load lies at one end of the play while it is pushed and at the other while it is pulled; the most frequent difference in each
    half of the differences is that end, whatever crosses between them and whatever noise widens them.
    """
    if samples.output_angle is None:
        return _missing("an angle measured behind the gear, and reversals")
    gap = samples.output_angle - samples.angle
    noise = angle_noise(samples.output_angle) + angle_noise(samples.angle)
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


def _ends(gap: Floats, noise: float) -> tuple[float, float] | None:
    """The two differences that occur most, one in each half; None if they are not two."""
    ordered = np.sort(gap)
    middle = float(ordered[0] + ordered[-1]) / 2
    lower, upper = ordered[ordered < middle], ordered[ordered >= middle]
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
