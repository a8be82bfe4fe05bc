"""The thesis's own way (Bevly 1997, 3.4.2): constant torques from rest, their first acceleration and their last speed.

At rest I qdd = tau - tau_f, at a steady speed tau = tau_f + d qd: two torques or more give d and tau_f, and then each start gives I.
"Rough estimates", says the thesis: the last speed is never quite steady, and a first acceleration is read from few samples.
"""

from dataclasses import dataclass
from typing import Annotated, Final

import numpy as np

from ...json_form import Count, Key
from ...types import Floats
from .motion import Motion
from .samples import JointSamples

LEAST_TIME: Final = 0.4
"""Of a constant torque that is looked at [s]."""
STEADY: Final = 0.06
"""Most that a steady speed may change over the last quarter of a constant torque, as a part of it."""
EVEN: Final = 4.0
"""A torque is constant while it stays within so many standard deviations of its noise."""


@dataclass(frozen=True, slots=True)
class Episode:
    """One constant torque from rest."""

    start: int
    """First and last sample, plus one."""
    end: int
    torque: float
    """Size, with its sign [N m]."""
    acceleration: float
    """First one, in the torque's direction [rad/s^2]."""
    speed: float
    """Last one, in the torque's direction [rad/s]; NaN where it was not steady."""


@dataclass(frozen=True, slots=True)
class RoughEstimates:
    """What the thesis's way gives; None where the log lacks what it needs."""

    inertia: float | None
    damping: float | None
    friction: float | None
    episodes: Annotated[tuple[Episode, ...], Key(get=len, kind=Count)]


def rough_estimates(samples: JointSamples, motion: Motion, torque: Floats) -> RoughEstimates:
    """Inertia, damping and friction from all constant torques in evenly spaced samples."""
    episodes = tuple(_episodes(samples, motion, torque))
    steady = [e for e in episodes if np.isfinite(e.speed)]
    sizes = np.array([abs(e.torque) for e in steady])
    if len(steady) < 2 or np.ptp(sizes) < 0.02 * sizes.max():
        return RoughEstimates(None, None, None, episodes)
    speeds = np.array([e.speed for e in steady])
    damping, friction = np.polyfit(speeds, sizes, 1)
    started = [(abs(e.torque) - friction) / e.acceleration for e in episodes if e.acceleration > 0.0]
    inertia = float(np.median(started)) if started else None
    return RoughEstimates(inertia, float(damping), float(friction), episodes)


def _episodes(samples: JointSamples, motion: Motion, torque: Floats) -> list[Episode]:
    level = samples.command if samples.command is not None else torque
    out = []
    for start, end in _stretches(level, round(LEAST_TIME / samples.period)):
        size = float(np.mean(torque[start:end]))
        sign = 1.0 if size > 0.0 else -1.0
        moving = np.flatnonzero(motion.forward[start:end] == sign)
        early = slice(start, start + max(2, round(0.02 / samples.period)))
        if moving.size < 0.8 * (end - start) or abs(float(np.median(motion.speed[early]))) > 2 * motion.dead:
            continue
        last = slice(end - (end - start) // 4, end - 2)
        early_speed, late_speed = (sign * float(np.median(part)) for part in np.array_split(motion.speed[last], 2))
        steady = abs(late_speed - early_speed) * 2 < STEADY * late_speed
        speed = float(np.polyfit(samples.time[last] - samples.time[last][0], sign * samples.angle[last], 1)[0])
        first = _first_acceleration(samples, sign, start, end, late_speed)
        out.append(Episode(start, end, size, first, speed if steady else float("nan")))
    return out


def _stretches(level: Floats, least: int) -> list[tuple[int, int]]:
    """Where a signal stays the same for `least` samples or more, up to its noise."""
    steps = np.abs(np.diff(level))
    noise = 1.4826 * float(np.median(steps)) / np.sqrt(2.0)
    edge = EVEN * noise + 1e-6 * float(np.max(np.abs(level)) + 1e-300)
    out, start, total = [], 0, float(level[0])
    for k in range(1, level.size + 1):
        if k < level.size and abs(level[k] - total / (k - start)) <= edge:
            total += float(level[k])
            continue
        if k - start >= least:
            out.append((start, k))
        if k < level.size:
            start, total = k, float(level[k])
    return out


def _first_acceleration(samples: JointSamples, sign: float, start: int, end: int, last_speed: float) -> float:
    """Acceleration at the start, from a cubic through the angle until the joint has half of its last speed."""
    way = sign * (samples.angle[start:end] - samples.angle[start])
    speed = np.gradient(way, samples.period)
    smooth = np.convolve(speed, np.ones(5) / 5, mode="same")
    reached = np.flatnonzero(smooth > 0.5 * last_speed)
    count = max(8, int(reached[0]) if reached.size else 8)
    time = samples.time[start : start + count] - samples.time[start]
    return float(2.0 * np.polyfit(time, way[:count], 3)[1])
