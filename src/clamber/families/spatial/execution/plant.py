"""What a robot in space senses, takes as commands, and how it really is: the protocol of a run and what is moved, simulated or real.

Joints are flat, limb by limb in the robot's order, each from the base to the tip, shape (n,). Wherever "holds" are meant by an index it
is that of the world's list, as in stances: 0 is the hold of number 1, and -1 means none. Wrenches are those of the surface on the limb.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from ....execution.plant import HoldBreak, PausingPlant
from ....types import Floats, Ints
from ..robot.chains import Chains


@dataclass(frozen=True, slots=True, eq=False)
class Pose:
    """Of the base frame in the world."""

    rotation: Floats
    """Its axes as columns, shape (3, 3)."""
    position: Floats
    """Its origin [m], shape (3,)."""


class SpatialSensed(NamedTuple):
    """What the sensors say at a tick; the arrays are the plant's own and change with the next one. None tells where in the world it is.

    A NamedTuple, as kernels take it.
    """

    joints: Floats
    """Angles [rad] or positions [m] by the encoders on the motors' side, then their speeds, shape (2, n)."""
    gyro: Floats
    """Angular velocity of the base, base frame [rad/s], shape (3,)."""
    accelerometer: Floats
    """Specific force at the base frame's origin (acceleration less gravity), base frame [m/s^2], shape (3,)."""
    wrenches: Floats
    """Force [N] and moment about the tip [N m] by each tip's sensor, end effector's frame (z out of it), shape (limbs, 6)."""
    torques: Floats
    """What the motors say that they give, by their currents [N m] or [N], shape (n,)."""
    closed: Ints
    """What each end effector's own switch says: 1 attached, 0 not; of feet always 0. Shape (limbs,)."""
    shutting: Ints
    """1 of jaws that are about something and not shut yet, shape (limbs,)."""
    number: Ints
    """Of the reading: one more for each period since the reset; -1: nobody tells. Shape (1,)."""

    @classmethod
    def of(cls, chains: Chains) -> "SpatialSensed":
        """Of a robot, all zero."""
        n, limbs = int(chains.n_joints.sum()), len(chains.limb_names)
        return cls(
            joints=np.zeros((2, n)),
            gyro=np.zeros(3),
            accelerometer=np.zeros(3),
            wrenches=np.zeros((limbs, 6)),
            torques=np.zeros(n),
            closed=np.zeros(limbs, np.int32),
            shutting=np.zeros(limbs, np.int32),
            number=np.full(1, -1, np.int32),
        )


@dataclass(frozen=True, slots=True, eq=False)
class SpatialTruth:
    """How the robot really is, world frame unless said otherwise: for logs and tests, never for a controller."""

    pose: Pose
    velocity: Floats
    """Of the base frame's origin [m/s], then angular [rad/s], shape (6,)."""
    joints: Floats
    """Positions and speeds at the outputs of the gears, shape (2, n)."""
    find_tips: Callable[[], Floats]
    """Gives `tips`, which few ask for."""
    wrenches: Floats
    """Force [N] and moment about the tip [N m] on each limb, shape (limbs, 6)."""
    attached: Ints
    """Index of the hold that each end effector is attached to; -1: none. Of feet: the hold that they stand on. Shape (limbs,)."""
    torques: Floats
    """What the motors gave over the last tick, on average [N m] or [N], shape (n,)."""
    broken: tuple[HoldBreak, ...] = ()
    """Contacts that have given way since the reset; holds by their numbers."""

    @property
    def tips(self) -> Floats:
        """[m], shape (limbs, 3)."""
        return self.find_tips()


class SpatialPlant(PausingPlant[SpatialSensed, SpatialTruth | None], Protocol):
    """A robot in space, driven by torques; friction, rotors, backlash, delay and torque-speed lines are the plant's.

    A real one knows no truth.
    """

    def actuate(self, torques: Floats) -> None:
        """Set the motors' torques [N m], or forces of slides [N], until the next call, shape (n,)."""

    def grip(self, limb: int, close: bool) -> None:
        """Command an end effector to attach, or to let go; until the next command of that limb. Feet ignore it.

        One that is to attach does so as soon as its tip is near enough to a hold and points well enough at it. One that has come off, or
        whose attempt has failed, stays off until it has been told to let go and to attach again.
        """

    def brake(self, joint: int) -> None:
        """Lock a joint by its brake, without power, until the next reset. It holds `brake` of the robot file."""

    def reset(self, pose: Pose, joints: Floats, held: Sequence[int] | Ints) -> None:
        """Put the robot somewhere at rest, at time 0.

        Args:
            pose: Of the base.
            joints: Positions [rad] or [m], shape (n,).
            held: Index of the hold that each limb is attached to or stands on, -1: none; shape (limbs,).
        """
