"""What identification is given and what it gives: samples of one joint and the motion in them; a parameter with its error."""

from dataclasses import dataclass, replace
from typing import Annotated, Final

import numpy as np
from scipy.signal import savgol_filter

from ...json_form import HIDDEN, Jsonable, Key, in_json
from ...types import Floats


@dataclass(frozen=True, slots=True, eq=False)
class JointSamples:
    """Samples of one joint; what was not measured is None."""

    name: str
    time: Floats
    """Increasing, shape (rows,) [s]."""
    angle: Floats
    """By the encoder, on the motor's side of the gear, at the joint's scale [rad]."""
    torque: Floats | None = None
    """Of the motor at the joint [N m]."""
    current: Floats | None = None
    """Of the motor [A]."""
    command: Floats | None = None
    """Voltage that the amplifier is commanded [V]."""
    output_angle: Floats | None = None
    """By an encoder behind the gear, or measured from outside [rad]."""
    sensed_torque: Floats | None = None
    """By a sensor at the output [N m]."""

    @property
    def period(self) -> float:
        """Median time between samples [s]."""
        return float(np.median(np.diff(self.time)))

    def evened(self) -> "JointSamples":
        """These samples at even times, one median period apart, by straight lines; unchanged where they are even already."""
        period = self.period
        if float(np.max(np.abs(np.diff(self.time) - period))) < 0.01 * period:
            return self
        time = np.arange(self.time[0], self.time[-1], period)

        def at(values: Floats | None) -> Floats | None:
            return None if values is None else np.interp(time, self.time, values)

        return replace(
            self,
            time=time,
            angle=np.interp(time, self.time, self.angle),
            torque=at(self.torque),
            current=at(self.current),
            command=at(self.command),
            output_angle=at(self.output_angle),
            sensed_torque=at(self.sensed_torque),
        )


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


NEEDS: Final = "What the log would have to hold for a value; null where there is one."


@dataclass(frozen=True, slots=True)
class Estimate(Jsonable):
    """One parameter of a joint."""

    name: str
    unit: str
    value: float | None = None
    """None: the log does not tell it."""
    error: Annotated[float | None, Key("standard_error")] = None
    """Standard error, of what scatters in the log; an error of the torque constant or gear is not in it."""
    low: Annotated[float | None, HIDDEN] = None
    """Ends of the interval that holds 95 % of the bootstrap's answers."""
    high: Annotated[float | None, HIDDEN] = None
    method: str = ""
    """How it was found."""
    needs: Annotated[str, Key(get=lambda needs: needs or None, kind=str | None, meaning=NEEDS)] = ""
    """What the log lacks; empty where there is a value."""
    stated: float | None = None
    """What the robot's file says."""

    @in_json(after="standard_error")
    def interval_95(self) -> Annotated[tuple[float | None, float | None] | None, Key(kind=tuple[float, float])]:
        """Holds 95 % of the bootstrap's answers; None where there is none."""
        return None if self.low is None else (self.low, self.high)

    @property
    @in_json()
    def difference(self) -> float | None:
        """From what the robot's file says, as a part of that; None where either is missing, or the file says 0."""
        if self.value is None or not self.stated:
            return None
        return (self.value - self.stated) / self.stated
