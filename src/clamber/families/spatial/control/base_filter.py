"""Where a robot in space is, as a filter believes it: its arrays, its settings, and what is done to it tick by tick."""

import math
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from ....control.whole_body.tree import Dynamics, State, Tree
from ....types import Floats, Ints
from ....units import DEGREE
from .base_filter_kernels import (
    ACCELEROMETER,
    CONTACTS,
    GYRO,
    PHI,
    POSITION,
    VELOCITY,
    add_drift,
    begin_contact,
    end_contact,
    take_height,
)

LEAST: Final = 1e-4
"""What links and tips give way, which no encoder tells [m]."""
LAG: Final = 0.03
"""In which a motor's torque pushes its joint's play to one side [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FilterSettings:
    """What a filter believes of sensors and contacts: standard deviations."""

    gyro: float = 0.01
    """Of a reading [rad/s]."""
    accelerometer: float = 0.1
    """Of a reading [m/s^2]."""
    gyro_bias: float = 0.01
    """At the start [rad/s]."""
    accelerometer_bias: float = 0.1
    """At the start [m/s^2]."""
    gyro_wander: float = 1e-4
    """Of the bias [rad/s/sqrt(s)]."""
    accelerometer_wander: float = 1e-3
    """Of the bias [m/s^2/sqrt(s)]."""
    slip: float = 3e-4
    """Of what a contact gives way [m/sqrt(s)]."""
    yielding: float = 1e-3
    """The same of its direction [rad/sqrt(s)]."""
    encoder: float = 0.1 * DEGREE
    """Of what an encoder tells, with half of the play of its gear [rad]."""
    drift: float = 2.0
    """Of what a step of a limb whose hold keeps its direction moves and turns the robot unnoticed, over what its encoders tell of its tip
    [-]: play of its gears turns the robot with it. About other holds tips turn, and the robot does not turn with them."""
    place: float = 2e-3
    """Of where the robot is at the start [m]."""
    turn: float = 0.3 * DEGREE
    """Of how it stands at the start [rad]."""
    hold: float = 4e-3
    """Of the height of a hold, by the map, before it is touched [m]."""
    landmark: float = 5e-3
    """Of the place of a hold, by the map, on which an end effector centres itself [m]. More than a ball of that radius has, 2.2 mm along
    each axis, as every touch counts as if the map had been drawn anew: four limbs on a hold, one after another, claim no more than that."""
    gate: float = 0.02
    """A tip that seems to have moved by more has slipped [m]."""


class Believed(NamedTuple):
    """What a filter believes; a NamedTuple, as kernels take it."""

    rotation: Floats
    """Axes of the base in the world, as columns, shape (3, 3)."""
    velocity: Floats
    """Of the base's origin, world frame [m/s], shape (3,)."""
    position: Floats
    """World frame [m], shape (3,)."""
    biases: Floats
    """What gyro [rad/s] and accelerometer [m/s^2] tell too much, shape (6,)."""
    places: Floats
    """Of contacts, world frame [m], shape (limbs, 3)."""
    directions: Floats
    """Axes of end effectors that hold on, world frame, as columns, shape (limbs, 3, 3)."""
    holds: Ints
    """1 for limbs that hold on, shape (limbs,)."""
    turn_at: Ints
    """First row of the error of each contact's direction, -1: it holds none; shape (limbs,)."""
    covariance: Floats
    """Of the errors, whose rows stand in `base_filter_kernels`, shape (n, n)."""
    error: Floats
    """What has been found of the errors and is not yet taken off, shape (n,)."""
    gain: Floats
    """Covariances of all errors with what is measured, number by number, shape (3, n); scratch, as the next."""
    share: Floats
    """What each number that is measured tells of the errors."""


class Followed(NamedTuple):
    """A robot's joints as its encoders and motors tell of them; a NamedTuple, as kernels take it."""

    own: State
    """Joints as the encoders have them; at the world's origin."""
    placed: State
    """The same with each joint on the side of its play that its motor pushes from."""
    work: Dynamics
    """Of `placed`: where the tips are in the base."""
    variances: Floats
    """Of where the tips are in the base, by the encoders [m^2], shape (limbs,)."""
    pushed: Floats
    """Torque of each motor over the last `LAG` [N m] or [N], shape (n,)."""
    firm: Floats
    """That pushes its joint's play to one side [N m] or [N], shape (n,)."""
    half_play: Floats
    """[rad], shape (n,)."""

    @classmethod
    def of(cls, tree: Tree, firm: Floats, half_play: Floats) -> "Followed":
        """Of a tree, all joints at 0."""
        own, limbs, n = State.of(tree), tree.limbs, tree.joints
        placed = own._replace(joints=np.zeros(n))
        return cls(own, placed, Dynamics.of(tree), np.zeros(limbs), np.zeros(n), firm, half_play)


class Packed(NamedTuple):
    """Settings as the kernel reads them."""

    gravity: Floats
    """World frame [m/s^2], shape (3,)."""
    noise: Floats
    """As in `base_filter_kernels.predict`, shape (6,)."""
    tracking: tuple[float, float, float]
    """What a filter of joints keeps over a period, -1: encoders tell speeds [-]; the period, and `LAG` [s]."""
    contacts: tuple[float, float, float, float]
    """`LEAST`, the encoders' spread [rad], variance of a tip's direction [rad^2], and the gate [m]."""
    off: Floats
    """Scratch, shape (6,)."""


class BaseFilter:
    """A contact-aided invariant filter.

    Args:
        limbs: How many.
        tracking: What a tracking filter of joints keeps over a period, -1: encoders tell speeds [-]; and the period [s].
        directed: 1 for limbs whose contacts hold their direction, shape (limbs,).
        gravity: World frame [m/s^2], shape (3,).
        settings: What it believes of its sensors.
    """

    def __init__(
        self, limbs: int, tracking: tuple[float, float], directed: Ints, gravity: Floats, settings: FilterSettings
    ) -> None:
        first = CONTACTS + 3 * limbs
        turn_at = np.where(directed, first + 3 * (np.cumsum(directed) - 1), -1).astype(np.int32)
        n = first + 3 * int(directed.sum())
        self.believed = Believed(
            rotation=np.eye(3),
            velocity=np.zeros(3),
            position=np.zeros(3),
            biases=np.zeros(6),
            places=np.zeros((limbs, 3)),
            directions=np.tile(np.eye(3), (limbs, 1, 1)),
            holds=np.zeros(limbs, np.int32),
            turn_at=turn_at,
            covariance=np.zeros((n, n)),
            error=np.zeros(n),
            gain=np.zeros((3, n)),
            share=np.zeros((3, n)),
        )
        self._settings = s = settings
        noise = np.array((s.gyro, s.accelerometer, s.gyro_wander, s.accelerometer_wander, s.slip, s.yielding))
        self._row, self._turned = np.zeros(n), s.encoder**2 * 3.0
        contacts = (LEAST, s.encoder, self._turned, s.gate)
        self.packed: Final = Packed(gravity, noise, (*tracking, LAG), contacts, np.zeros(6))
        """As kernels read its settings."""

    def begin(self, rotation: Floats, position: Floats) -> None:
        """Begin at rest at a pose, with no contact."""
        b, s = self.believed, self._settings
        b.rotation[:], b.position[:] = rotation, position
        for array in (b.velocity, b.biases, b.covariance, b.error, b.holds):
            array[:] = 0
        spreads = (
            (PHI, s.turn),
            (VELOCITY, 1e-3),
            (POSITION, s.place),
            (GYRO, s.gyro_bias),
            (ACCELEROMETER, s.accelerometer_bias),
        )
        for first, spread in spreads:
            b.covariance[range(first, first + 3), range(first, first + 3)] = spread**2

    def hold_on(self, limb: int, tip: Floats, axes: Floats, variance: float) -> None:
        """A limb's tip stays where it is from now on."""
        s = self._settings
        if self.believed.turn_at[limb] >= 0:
            add_drift(self.believed, s.drift**2 * variance, (s.drift * s.encoder) ** 2, self._row)
        begin_contact(self.believed, limb, tip, axes, variance, self._turned)

    def let_go(self, limb: int) -> None:
        """A limb's tip moves from now on."""
        end_contact(self.believed, limb)

    def take_height(self, limb: int, place: Floats, normal: Floats, variance: float) -> None:
        """Take in that a limb is on the surface of a hold, by the map [m], [m^2]; where on it, it does not feel."""
        take_height(self.believed, limb, place, normal, variance, self._row)

    def take_place(self, limb: int, place: Floats, axes: Floats) -> None:
        """Take in that a limb is on a hold's own place, by the map [m], along each of some axes, shape (n, 3)."""
        for axis in axes:
            take_height(self.believed, limb, place, axis, self._settings.landmark**2, self._row)

    def spread(self, limb: int) -> float:
        """Standard deviation of where a limb's contact is, in any direction [m]."""
        at = CONTACTS + 3 * limb
        return math.sqrt(float(np.trace(self.believed.covariance[at : at + 3, at : at + 3])) / 3.0)
