"""The amplifier's gain, current over command voltage, by the motor that is stalled (Bevly 1997, 4.3.4), or else in motion."""

from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt

from ...types import Floats
from .samples import Estimate, JointSamples, Motion

Mask: TypeAlias = npt.NDArray[np.bool_]
NEEDS: Final = "command voltage and current (or sensed torque), at two or more voltages"
LEAST_STALL: Final = 40
"""Samples at rest under a voltage."""
SPREAD: Final = 0.1
"""Voltages must differ by this part of the largest."""
RESAMPLES: Final = 200
BLOCKS: Final = 40


def amplifier_gain(samples: JointSamples, motion: Motion, torque_per_current: float | None, seed: int = 0) -> Estimate:
    """The slope of current over voltage, with an offset for the sensor's zero.

    At rest, currents are compared with voltages as they are. In motion, speed is a third variable, so that back-EMF does not count as
    gain. Without a current, a sensed torque at rest gives it: friction holds up to tau_f either way, which is each direction's offset.

    Args:
        samples: Evenly spaced, of one joint.
        motion: Of the same samples.
        torque_per_current: Of motor and gear at the joint, k_t N [N m/A]; None if not known.
        seed: Of the bootstrap.
    """
    command = samples.command
    if command is None:
        return _missing()
    at_rest = (motion.forward == 0.0) & (np.abs(command) > SPREAD / 4 * np.abs(command).max())
    still = at_rest & _calm(command)
    if samples.current is not None:
        current = samples.current
        if _tells(command, still):
            return _slope(command, current, still, np.ones((command.size, 1)), "stalled motor", seed)
        moving = motion.forward != 0.0
        if _tells(command, moving):
            others = np.column_stack((np.ones(command.size), motion.speed))
            return _slope(command, current, moving, others, "motor in motion, with back-EMF: no stall", seed)
        return _missing()
    if samples.sensed_torque is not None and torque_per_current is not None and _tells(command, still):
        others = np.column_stack((command > 0.0, command < 0.0)).astype(np.float64)
        others = others[:, others[still].any(axis=0)]
        current = samples.sensed_torque / torque_per_current
        return _slope(command, current, still, others, "sensed torque of the stalled motor", seed)
    return _missing()


def _calm(command: Floats) -> Mask:
    """Whether the voltage is that of the samples around."""
    same = np.abs(np.diff(command, prepend=command[0])) < 1e-3 * float(np.abs(command).max() + 1e-300)
    return same & np.roll(same, -1)


def _tells(command: Floats, mask: Mask) -> bool:
    if int(np.count_nonzero(mask)) < LEAST_STALL:
        return False
    return bool(np.ptp(command[mask]) > SPREAD * np.abs(command).max() > 0.0)


def _slope(command: Floats, current: Floats, mask: Mask, others: Floats, method: str, seed: int) -> Estimate:
    """Median of means: the regression over resampled blocks of the samples, without those far off."""
    design = np.column_stack((command, others))[mask]
    right = current[mask]
    values = np.linalg.lstsq(design, right, rcond=None)[0]
    rest = right - design @ values
    good = np.abs(rest) <= 4.0 * 1.4826 * float(np.median(np.abs(rest))) + 1e-12 * float(np.abs(right).max())
    design, right = design[good], right[good]
    values = np.linalg.lstsq(design, right, rcond=None)[0]
    rng = np.random.default_rng(seed)
    parts = np.array_split(np.arange(right.size), min(BLOCKS, right.size))
    draws = np.empty(RESAMPLES)
    for k in range(RESAMPLES):
        rows = np.concatenate([parts[p] for p in rng.integers(0, len(parts), len(parts))])
        draws[k] = np.linalg.lstsq(design[rows], right[rows], rcond=None)[0][0]
    low, high = np.quantile(draws, (0.025, 0.975))
    return Estimate("amplifier gain", "A/V", float(values[0]), float(draws.std()), float(low), float(high), method)


def _missing() -> Estimate:
    return Estimate("amplifier gain", "A/V", needs=NEEDS)
