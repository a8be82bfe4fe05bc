"""One joint identified: from which signal its torque is, every parameter, how well the model fits.

The thesis's own way (Bevly 1997, 3.4.2): constant torques from rest, their first acceleration and their last speed.

At rest I qdd = tau - tau_f, at a steady speed tau = tau_f + d qd: two torques or more give d and tau_f, and then each start gives I.
"Rough estimates", says the thesis: the last speed is never quite steady, and a first acceleration is read from few samples.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from operator import attrgetter
from typing import Annotated, Final

import numpy as np

from ...json_form import HIDDEN, Count, Jsonable, Key
from ...types import Floats
from .amplifier import amplifier_gain
from .joint_fit import NAMES, NEEDS, UNITS, JointFit, LinkLoad, fit_joint
from .samples import Estimate, JointSamples, Motion, angle_noise

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


NO_TORQUE: Final = "torque, or current with the motor's torque constant and gear"


@dataclass(frozen=True, slots=True, kw_only=True)
class Drivetrain:
    """What is known beforehand of a joint's motor; None where it is not."""

    torque_constant: float | None = None
    """Motor torque per current, before the gear [N m/A]."""
    gear: float | None = None
    """Motor turns per joint turn; None: as if there were no gear [-]."""
    amplifier_gain: float | None = None
    """Taken where a log has voltages and no currents [A/V]."""
    stated: Mapping[str, float] = field(default_factory=dict)
    """Parameter -> what the robot's file says."""

    @property
    def torque_per_current(self) -> float | None:
        """k_t N at the joint [N m/A]."""
        return None if self.torque_constant is None else self.torque_constant * (self.gear or 1.0)


@dataclass(frozen=True, slots=True, eq=False)
class IdentifiedJoint(Jsonable):
    """What a log tells of one joint."""

    samples: Annotated[
        JointSamples,
        Key("joint", get=attrgetter("name"), kind=str),
        Key("rows", get=lambda samples: samples.time.size, kind=Count),
        Key("seconds", get=lambda samples: samples.time[-1] - samples.time[0], kind=float),
    ]
    """Evenly spaced."""
    motion: Annotated[Motion, HIDDEN]
    torque: Annotated[Floats | None, HIDDEN]
    """Of the motor at the joint, at every sample [N m]."""
    links: Annotated[LinkLoad | None, HIDDEN]
    """What the links ask of the joint, where a robot is named."""
    torque_from: str
    fit: Annotated[
        JointFit | None,
        Key("lag", get=attrgetter("lag"), kind=float, meaning="Of the torque behind the angles [s]."),
        Key(
            "residual_torque",
            get=attrgetter("residual"),
            kind=float,
            meaning="Root mean square of what the fit leaves [N m].",
        ),
    ]
    rough: Annotated[RoughEstimates, Key("constant_torque", after="estimates")]
    estimates: tuple[Estimate, ...]
    """Inertia, damping, friction, offset, amplifier gain, backlash."""


def identify_joint(
    samples: JointSamples, motion: Motion, links: LinkLoad | None, drivetrain: Drivetrain, seed: int = 0
) -> IdentifiedJoint:
    """Everything that evenly spaced samples of one joint tell.

    Args:
        samples: Of the joint.
        motion: Of the same samples.
        links: What the limb's links ask of the joint; None where that is not known: inertia then includes theirs.
        drivetrain: What is known beforehand.
        seed: Of the bootstrap.
    """
    gain = amplifier_gain(samples, motion, drivetrain.torque_per_current, seed)
    torque, source = _torque(samples, drivetrain)
    fit, rough = None, RoughEstimates(None, None, None, ())
    if torque is None:
        moved = tuple(Estimate(name, unit, needs=NO_TORQUE) for name, unit in zip(NAMES, UNITS, strict=True))
    elif not motion.moves:
        moved = tuple(Estimate(name, unit, needs=need) for name, unit, need in zip(NAMES, UNITS, NEEDS, strict=True))
    else:
        fit = fit_joint(samples, motion, torque, links, seed)
        rough = rough_estimates(samples, motion, torque)
        moved = fit.estimates
    estimates = tuple(
        replace(estimate, stated=drivetrain.stated.get(estimate.name))
        for estimate in (*moved, gain, backlash(samples, motion.speed, seed))
    )
    return IdentifiedJoint(samples, motion, torque, links, source, fit, rough, estimates)


def _torque(samples: JointSamples, drivetrain: Drivetrain) -> tuple[Floats | None, str]:
    """The motor's torque at the joint, from the best of what was measured, and from what."""
    if samples.torque is not None:
        return samples.torque, "torque"
    scale, gain = drivetrain.torque_per_current, drivetrain.amplifier_gain
    if samples.current is not None and scale is not None:
        return scale * samples.current, "current"
    if samples.command is not None and scale is not None and gain is not None:
        return scale * gain * np.asarray(samples.command), f"command, with {gain:g} A/V taken as given"
    return None, "nothing"


def model_speed(joint: IdentifiedJoint) -> Floats | None:
    """Speed of the model at every sample, by steps of one period; None where inertia, damping or friction is not known [rad/s].

    The model starts anew from the measured speed wherever the joint stands: in its stops it would turn on.
    """
    if joint.fit is None or joint.torque is None or any(e.value is None for e in joint.estimates[:3]):
        return None
    inertia, damping, friction, offset = (float(e.value or 0.0) for e in joint.estimates[:4])
    samples, motion = joint.samples, joint.motion
    period = samples.period
    late = joint.fit.lag - period / 2  # a torque held for a period is half of one late on its own
    torque = np.interp(samples.time - late, samples.time, joint.torque) - offset
    whole = np.full(samples.time.size, inertia)
    if joint.links is not None:
        torque = torque - joint.links.bias
        whole = whole + joint.links.inertia[:, joint.links.place]
    out = np.empty(samples.time.size)
    speed = float(motion.speed[0])
    for k in range(out.size):
        if motion.forward[k] == 0.0:
            speed = float(motion.speed[k])
        out[k] = speed
        pull = float(torque[k]) - damping * speed
        if abs(speed) > 0.0:
            changed = speed + period / whole[k] * (pull - friction * np.sign(speed))
            speed = changed if changed * speed > 0.0 or abs(pull) > friction else 0.0
        elif abs(pull) > friction:
            speed = period / whole[k] * (pull - friction * np.sign(pull))
    return out
