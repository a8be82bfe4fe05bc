"""The quadratic programme of one tick of whole-body control: what is asked for, by which gains, and the arrays that it is written into.

Unknown are the generalised accelerations and the wrench of every contact that bears, each in its contact's own frame:

    minimise   weighted squares of what tasks miss, and of wrenches beside the wanted ones
    subject to the six equations of the floating base, motor torques, and contact wrenches in their polytopes

Joints keep away from their limits by bounds on their accelerations, which give way where nothing else would do.
"""

from dataclasses import astuple, dataclass
from typing import Final, NamedTuple

import numpy as np

from ...types import Floats, Ints
from .tree import FREE, Tree

FREE_LIMB, SWINGS, HOLDS = range(3)
"""What a limb does: nothing but come to rest, follow a path with its tip, or hold on."""
ENDLESS: Final = 1e30
"""What the solver takes for no bound."""


class Aims(NamedTuple):
    """What is asked for at a tick; arrays that whoever asks writes into, world frame unless said otherwise."""

    rotation: Floats
    """Axes of the base, as columns, shape (3, 3)."""
    position: Floats
    """Of its origin [m], shape (3,)."""
    velocity: Floats
    """Of it, and angular, shape (6,)."""
    acceleration: Floats
    """Of it, and angular, shape (6,)."""
    does: Ints
    """`FREE_LIMB`, `SWINGS` or `HOLDS`, shape (limbs,)."""
    tip: Floats
    """Where the tip of a swinging limb is to be [m], shape (limbs, 3)."""
    tip_velocity: Floats
    """Of it [m/s], shape (limbs, 3)."""
    tip_acceleration: Floats
    """Of it [m/s^2], shape (limbs, 3)."""
    points: Floats
    """Direction that the end effector's z is to have, zero: any, shape (limbs, 3)."""
    tip_rate: Floats
    """At which errors of a swinging tip may die away at most [1/s], shape (limbs,)."""
    base_integral: Floats
    """Added to the error of the base [m], then about the world's axes [rad]: what of it lasts, shape (6,)."""
    tip_integral: Floats
    """The same of swinging tips and where they are to point, shape (limbs, 6)."""
    posture: Floats
    """That joints lean to where nothing else is asked of them, shape (n,)."""
    frame: Floats
    """Normal and two tangents of each contact, as rows, shape (limbs, 3, 3)."""
    components: Ints
    """Of a contact's wrench: 3 or 6, shape (limbs,)."""
    n_rows: Ints
    """Of each contact's polytope, shape (limbs,)."""
    rows: Floats
    """`rows wrench <= limits` in the contact's frame, shape (limbs, most rows, 6)."""
    limits: Floats
    """Shape (limbs, most rows)."""
    wrench: Floats
    """That a contact is to bear, its own frame, shape (limbs, 6)."""
    cap: Floats
    """Largest force along each of its axes, and moment per arm, that a contact may be given [N], shape (limbs,)."""

    @classmethod
    def of(cls, tree: Tree, most_rows: int) -> "Aims":
        """Nothing, for a tree."""
        limbs = tree.limbs
        return cls(
            rotation=np.eye(3),
            position=np.zeros(3),
            velocity=np.zeros(6),
            acceleration=np.zeros(6),
            does=np.zeros(limbs, np.int32),
            tip=np.zeros((limbs, 3)),
            tip_velocity=np.zeros((limbs, 3)),
            tip_acceleration=np.zeros((limbs, 3)),
            points=np.zeros((limbs, 3)),
            tip_rate=np.full(limbs, np.inf),
            base_integral=np.zeros(6),
            tip_integral=np.zeros((limbs, 6)),
            posture=np.zeros(tree.joints),
            frame=np.tile(np.eye(3), (limbs, 1, 1)),
            components=np.full(limbs, 3, np.int32),
            n_rows=np.zeros(limbs, np.int32),
            rows=np.zeros((limbs, most_rows, 6)),
            limits=np.zeros((limbs, most_rows)),
            wrench=np.zeros((limbs, 6)),
            cap=np.full(limbs, np.inf),
        )


class Limits(NamedTuple):
    """Of the joints, shape (n,) each."""

    torque: Floats
    """[N m] or [N]."""
    lower: Floats
    """[rad] or [m]."""
    upper: Floats
    """[rad] or [m]."""
    speed: Floats
    """[rad/s] or [m/s]."""
    friction: Floats
    """Coulomb friction of the gears [N m] or [N]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Gains:
    """Weights and feedback. Weights are of squared accelerations of a point; angular ones count at the arm's length."""

    arm: float
    """Length that angles and moments are weighed by [m]."""
    base: float = 10.0
    """Weight of the base's motion [-]."""
    swing: float = 5.0
    """Of the tip of a swinging limb [-]."""
    holding: float = 50.0
    """Of tips that hold on staying where they are [-]."""
    resting: float = 1.0
    """Of tips of limbs that do nothing coming to rest [-]."""
    posture: float = 1e-3
    """Of joints leaning to their posture [-]."""
    wrench: float = 0.1
    """Of wrenches beside the wanted ones, per mass of the robot [-]."""
    base_rate: float = 10.0
    """At which errors of the base die away [1/s]."""
    swing_rate: float = 20.0
    """The same of a swinging tip [1/s]."""
    posture_rate: float = 5.0
    """The same of a posture [1/s]."""
    rest_rate: float = 20.0
    """At which motion of tips that hold on or rest dies away [1/s]."""
    limit_rate: float = 10.0
    """At which a joint may come nearer to its limit, of what is left [1/s]."""
    speed_rate: float = 40.0
    """At which a joint's speed may change to what it may be [1/s]."""
    integral: float = 0.2
    """Rate at which errors that last are added up, of that at which they die away [-]."""
    moving: float = 0.05
    """Speed from which on a joint's gear rubs with its whole friction [rad/s], of slides per arm."""

    def packed(self) -> Floats:
        """As the kernel reads them, in the order of the fields."""
        return np.array(astuple(self))


GAINS: Final = tuple(Gains.__dataclass_fields__)
"""Names in the order that they are packed in."""
(
    ARM, BASE, SWING, HOLDING, RESTING, POSTURE, WRENCH, BASE_RATE, SWING_RATE, POSTURE_RATE, REST_RATE, LIMIT_RATE, SPEED_RATE,
    INTEGRAL, MOVING,
) = range(len(GAINS))  # fmt: skip


class Programme(NamedTuple):
    """Room for the largest programme of a robot: 1/2 x.H x + f.x, lower <= [x; A x] <= upper, matrices flat, row by row.

    A programme of fewer contacts takes the first part of each.
    """

    h: Floats
    f: Floats
    a: Floats
    lower: Floats
    upper: Floats
    sense: Ints
    """Of each bound and row: 5 for equations, 8 for what may give way."""
    at: Ints
    """First unknown of each limb's wrench; -1: it bears none, shape (limbs,)."""
    x: Floats
    """Of the equations alone."""
    factor: Floats
    """Scratch of `programme_kernels.solve_equations`, shape (6 + n, 6 + n) ..."""
    z: Floats
    """... (unknowns, 7) ..."""
    square: Floats
    """... and (7, 6)."""

    @classmethod
    def of(cls, tree: Tree, most_rows: int) -> "Programme":
        """For a tree whose contacts have so many rows each at most."""
        n = tree.speeds + 6 * tree.limbs
        rows = tree.speeds + most_rows * tree.limbs
        return cls(
            h=np.zeros(n * n),
            f=np.zeros(n),
            a=np.zeros(rows * n),
            lower=np.zeros(n + rows),
            upper=np.zeros(n + rows),
            sense=np.zeros(n + rows, np.int32),
            at=np.zeros(tree.limbs, np.int32),
            x=np.zeros(n),
            factor=np.zeros((tree.speeds, tree.speeds)),
            z=np.zeros((n, FREE + 1)),
            square=np.zeros((FREE + 1, FREE)),
        )
