"""A floating base with links that hang on it by hinges and slides, as whole-body laws believe it to be, and what is worked out of it."""

from typing import NamedTuple

import numpy as np

from ...types import Floats, Ints

FREE = 6
"""Generalised speeds of the base: velocity of its origin, world frame, then its angular velocity, base frame."""


class Tree(NamedTuple):
    """Bodies 0 to n, the base first; body i >= 1 is moved by joint i - 1, whose axis is the z of the body's frame.

    A NamedTuple, as kernels take it.
    """

    parent: Ints
    """Body that each hangs on, of the base -1; parents before children, shape (n + 1,)."""
    sliding: Ints
    """1 for a slide, 0 for a hinge, shape (n + 1,); of the base 0."""
    offset: Floats
    """Origin of each body's frame in its parent's [m], shape (n + 1, 3)."""
    turn: Floats
    """Axes of each body's frame in its parent's with the joint at 0, as columns, shape (n + 1, 3, 3)."""
    mass: Floats
    """[kg], shape (n + 1,)."""
    centre: Floats
    """Centre of mass in the body's frame [m], shape (n + 1, 3)."""
    inertia: Floats
    """About that centre, in the frame's axes [kg m^2], shape (n + 1, 3, 3)."""
    rotor: Floats
    """Inertia of each motor with its gear, at the joint [kg m^2] or [kg], shape (n,)."""
    end: Ints
    """Body at the end of each limb, shape (limbs,)."""
    tip: Floats
    """Each limb's tip in that body's frame [m], shape (limbs, 3)."""
    tip_turn: Floats
    """Axes of each end effector in it, z out of the limb, shape (limbs, 3, 3)."""
    gravity: Floats
    """Acceleration of free fall, world frame [m/s^2], shape (3,)."""

    @property
    def joints(self) -> int:
        """How many."""
        return len(self.rotor)

    @property
    def limbs(self) -> int:
        """How many."""
        return len(self.end)

    @property
    def speeds(self) -> int:
        """Generalised speeds: of the base, then of the joints."""
        return FREE + len(self.rotor)


class State(NamedTuple):
    """Where a tree is and how it moves, as believed."""

    rotation: Floats
    """Axes of the base in the world, as columns, shape (3, 3)."""
    position: Floats
    """Of the base's origin, world frame [m], shape (3,)."""
    speed: Floats
    """Generalised speeds, shape (6 + n,)."""
    joints: Floats
    """Positions [rad] or [m], shape (n,)."""

    @classmethod
    def of(cls, tree: Tree) -> "State":
        """At rest at the world's origin, all joints at 0."""
        return cls(np.eye(3), np.zeros(3), np.zeros(tree.speeds), np.zeros(tree.joints))


class Dynamics(NamedTuple):
    """What `tree_kernels.work_out` makes of a state, in the world frame unless said otherwise."""

    mass: Floats
    """Mass matrix, shape (6 + n, 6 + n)."""
    bias: Floats
    """Generalised forces that keep all accelerations zero: gravity, Coriolis and centrifugal, shape (6 + n,)."""
    weight: Floats
    """Those that keep the robot at rest, shape (6 + n,)."""
    tip: Floats
    """Places of the tips [m], shape (limbs, 3)."""
    tip_turn: Floats
    """Axes of the end effectors, as columns, shape (limbs, 3, 3)."""
    jacobian: Floats
    """Velocity, then angular velocity of each tip by generalised speeds, shape (limbs, 6, 6 + n)."""
    tip_speed: Floats
    """Both of them, shape (limbs, 6)."""
    tip_bias: Floats
    """Their rates without acceleration of any generalised speed, shape (limbs, 6)."""
    # of every body
    axes: Floats
    origin: Floats
    spin: Floats
    velocity: Floats
    turning: Floats
    acceleration: Floats
    heavy: Floats
    """Mass, first moment (3) and inertia (9) about the base's origin of each body with all that hangs on it, shape (n + 1, 13)."""
    force: Floats
    """That each joint passes on, and its moment about the base's origin, shape (n + 1, 6)."""

    @classmethod
    def of(cls, tree: Tree) -> "Dynamics":
        """Of a tree, all zero."""
        n, limbs, bodies = tree.speeds, tree.limbs, tree.joints + 1
        return cls(
            mass=np.zeros((n, n)),
            bias=np.zeros(n),
            weight=np.zeros(n),
            tip=np.zeros((limbs, 3)),
            tip_turn=np.zeros((limbs, 3, 3)),
            jacobian=np.zeros((limbs, 6, n)),
            tip_speed=np.zeros((limbs, 6)),
            tip_bias=np.zeros((limbs, 6)),
            axes=np.zeros((bodies, 3, 3)),
            origin=np.zeros((bodies, 3)),
            spin=np.zeros((bodies, 3)),
            velocity=np.zeros((bodies, 3)),
            turning=np.zeros((bodies, 3)),
            acceleration=np.zeros((bodies, 3)),
            heavy=np.zeros((bodies, 13)),
            force=np.zeros((bodies, 6)),
        )
