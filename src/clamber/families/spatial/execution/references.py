"""Where a body and a swinging tip are to be at a moment, with speed and acceleration: quintics from rest to rest."""

import math
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from ....compiled import Handle
from ....types import Floats
from ..control.turn_kernels import write_quaternion
from ..statics.stance_kernels import OFF, RISE
from .reference_kernels import body_at, share_at, tip_at

PEAK_SPEED: Final = 1.875
"""Of a quintic from rest to rest, of its way per its time [-] ..."""
PEAK: Final = 10.0 / math.sqrt(3.0)
"""... and of its acceleration, of its way per its squared time [-]."""
EASING: Final = PEAK / PEAK_SPEED
"""Of the square of a path's rate, per share of the path: half of it times the peak speed is half the peak acceleration [-]."""


def seconds_for(way: float, acceleration: float) -> float:
    """That a way takes from rest to rest with such a largest acceleration [s]."""
    return math.sqrt(PEAK * way / acceleration)


@dataclass(frozen=True, slots=True, eq=False)
class BodyPath:
    """A body on its way from one pose to another, straight and by the shortest turn."""

    position: Floats
    """At the start [m], shape (3,)."""
    rotation: Floats
    """At the start, shape (3, 3)."""
    way: Floats
    """[m], shape (3,)."""
    turn: Floats
    """Axis times angle, world frame [rad], shape (3,)."""
    seconds: float
    handle: Handle = field(init=False, repr=False)
    """For kernels."""

    def __post_init__(self) -> None:
        made = Handle(self.position, self.rotation, self.way, self.turn, float(self.seconds))
        object.__setattr__(self, "handle", made)

    @classmethod
    def between(cls, position: Floats, rotation: Floats, to: Floats, to_rotation: Floats, seconds: float) -> "BodyPath":
        """From one pose to another."""
        return cls(position.copy(), rotation.copy(), to - position, rotation_vector(to_rotation @ rotation.T), seconds)

    def at(self, time: float) -> tuple[Floats, Floats, Floats, Floats]:
        """Position, rotation, velocity and acceleration, linear then angular, shapes (3,), (3, 3), (6,), (6,)."""
        made = np.empty(3), np.empty((3, 3)), np.empty(6), np.empty(6)
        body_at(self.handle, time, *made)
        return made


@dataclass(frozen=True, slots=True, eq=False)
class TipPath:
    """The lifted path of a tip between two places: off along the normals first, on last, as the check `swing` has it."""

    start: Floats
    end: Floats
    """[m], shape (3,)."""
    normals: Floats
    """At both, out of the surfaces, shape (2, 3)."""
    up: Floats
    """How far it is lifted at its highest [m], shape (3,)."""
    handle: Handle = field(init=False, repr=False)
    """For kernels."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "handle", Handle(self.start, self.end, self.normals, self.up))

    def at(self, u: float) -> tuple[Floats, Floats, Floats]:
        """Place, and its first and second derivative, at a share of the path [m], shape (3,) each."""
        made = np.empty((3, 3))
        tip_at(self.handle, u, 1.0, 0.0, *made)
        return made[0], made[1], made[2]


@dataclass(frozen=True, slots=True, eq=False)
class TimeScaling:
    """How a share of a path grows with time; its squared rate is linear between even shares, as in Pham and Pham (2018)."""

    times: Floats
    """At even shares of the path [s], shape (n,)."""
    rates: Floats
    """Of the share there [1/s], shape (n,)."""
    handle: Handle = field(init=False, repr=False)
    """For kernels."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "handle", Handle(self.times, self.rates))

    @classmethod
    def within(cls, seconds: float, least: Floats) -> "TimeScaling":
        """The quickest one that slows down where it has to, and there alone.

        Args:
            seconds: That the path takes where nothing slows it.
            least: That all of it would take at the rate which each of its equal pieces allows [s], shape (pieces,).
        """
        allowed = (seconds / np.maximum(least, seconds)) ** 2
        nodes = np.minimum(np.append(allowed, 1.0), np.append(1.0, allowed))
        shares = np.linspace(0.0, 1.0, len(nodes))
        squares = np.min(nodes + EASING * np.abs(shares[:, None] - shares), axis=1)
        rates = np.sqrt(squares) / seconds
        return cls(np.append(0.0, np.cumsum(2.0 / len(least) / (rates[1:] + rates[:-1]))), rates)

    def at(self, time: float) -> tuple[float, float, float]:
        """Share, its rate and how that grows at a moment [-, 1/s, 1/s^2]."""
        found: tuple[float, float, float] = share_at(self.handle, time)
        return found


def swing_seconds(way: float, lift: float, acceleration: float) -> float:
    """That a lifted path takes so that neither part of it accelerates more [s]."""
    return max(seconds_for(way, acceleration) / (1.0 - 2.0 * OFF), seconds_for(lift, acceleration) / RISE)


def rotation_vector(rotation: Floats) -> Floats:
    """Axis times angle of a rotation [rad], shape (3,)."""
    r = rotation
    skew = 0.5 * np.array((r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]))
    sine, cosine = float(np.linalg.norm(skew)), 0.5 * (float(np.trace(r)) - 1.0)
    if sine < 1e-9:
        if cosine > 0.0:
            return skew
        k = int(np.argmax(np.diag(r)))  # half a turn: an axis is a column of R + 1
        axis = r[:, k] + np.eye(3)[k]
        half: Floats = math.pi * axis / np.linalg.norm(axis)
        return half
    made: Floats = math.atan2(sine, cosine) / sine * skew
    return made


def quaternion_of(rotation: Floats) -> Floats:
    """Unit quaternion w, x, y, z of a rotation, w not negative, shape (4,)."""
    made = np.empty(4)
    write_quaternion(np.ascontiguousarray(rotation), made)
    return made
