"""The laws of a whole body by name, and those of the field that solve no programme.

These look at no limit of contacts and joints; torques are cut off at theirs.
"""

from typing import Any, ClassVar, Final, NamedTuple

import numpy as np

from ....compiled import Handle, ready
from ....control.whole_body.law import BodyLaw, WholeBody
from ....control.whole_body.programme import Gains, Limits
from ....control.whole_body.tree import FREE, Dynamics, State, Tree
from ....errors import UnknownNameError
from ....types import Floats, Ints
from .laws_kernels import jacobian_transpose, joint_impedance, operational_space


class Room(NamedTuple):
    """Scratch of one law, and what it remembers."""

    upper: Floats
    """Cholesky factor of the mass matrix, shape (6 + n, 6 + n)."""
    basis: Floats
    """Directions that tasks have taken, orthonormal rows, shape (6 + n, 6 + n)."""
    row: Floats
    """Of a task, shape (6 + n,)."""
    wanted: Floats
    """Accelerations, shape (6 + n,)."""
    y: Floats
    """What is solved for, shape (6 + n,)."""
    forces: Floats
    """Generalised forces that contacts and motors bear together, shape (6 + n,)."""
    balance: Floats
    """Equations of the base, and their right side, shape (6, 7)."""
    columns: Floats
    """A contact's wrench on the base, component by component, shape (6, 6)."""
    wrenches: Floats
    """The law's, shape (limbs, 6)."""
    torques: Floats
    """The law's, shape (n,)."""
    did: Ints
    """What limbs did at the last tick; -1 before the first, shape (limbs,)."""
    place: Floats
    """Where tips that hold on were as they took hold [m], shape (limbs, 3) ..."""
    turn: Floats
    """... and how they were turned, shape (limbs, 3, 3)."""

    @classmethod
    def of(cls, law: BodyLaw) -> "Room":
        """For a law."""
        tree = law.tree
        n, limbs = tree.speeds, tree.limbs
        return cls(
            upper=np.zeros((n, n)),
            basis=np.zeros((n, n)),
            row=np.zeros(n),
            wanted=np.zeros(n),
            y=np.zeros(n),
            forces=np.zeros(n),
            balance=np.zeros((FREE, FREE + 1)),
            columns=np.zeros((6, FREE)),
            wrenches=law.wrenches,
            torques=law.torques,
            did=np.full(limbs, -1, np.int32),
            place=np.zeros((limbs, 3)),
            turn=np.zeros((limbs, 3, 3)),
        )


class Reference(NamedTuple):
    """Where joints are to be by inverse kinematics."""

    state: State
    dynamics: Dynamics
    speed: Floats
    """Of the joints, behind six zeros, shape (6 + n,)."""

    @classmethod
    def of(cls, tree: Tree) -> "Reference":
        """For a tree."""
        return cls(State.of(tree), Dynamics.of(tree), np.zeros(tree.speeds))


class DirectLaw(BodyLaw):
    """A law whose torques follow from the aims in one kernel."""

    kernel: ClassVar[Any]
    """Works the torques out; whether any contact bears."""

    def __init__(self, tree: Tree, limits: Limits, gains: Gains, most_rows: int) -> None:
        super().__init__(tree, limits, gains, most_rows)
        all_of = Handle(tree, self.state, self.dynamics, self.aims, limits, self.packed, Room.of(self))
        self._work_out = ready(type(self).kernel, all_of)

    def tick(self) -> Floats:
        """See `BodyLaw`."""
        return self.torques if self._work_out() else self._fail()


class OperationalSpace(DirectLaw):
    """Operational space with null space, consistent with the contacts: the base first, swinging tips next, then the posture.

    With Jc the contacts' Jacobian, P = 1 - Jc^+ Jc and S the selection of joints, the equations of motion free of contact wrenches are

        P (M qdd + h) = P S^T tau                                  (Aghili 2005; Mistry and Righetti 2011)

    The accelerations meet the contacts (Jc qdd + Jcdot qd = -rate Jc qd), and each task in the dynamically consistent null space
    of those before it (Khatib 1987; Sentis and Khatib 2005): as the mass matrix is L L^T, tasks are projected on each other by
    Gram and Schmidt in y = L^T qdd, where the inverse mass matrix of their equations is 1. Near singularities a task is damped.
    Of the torques that bring these accelerations about those are taken whose contact wrenches are nearest to the wanted ones.

    M. Mistry, L. Righetti, "Operational space control of constrained and underactuated systems", Robotics: Science and Systems VII, 2011.
    """

    kernel = operational_space


class JacobianTranspose(DirectLaw):
    """Jacobian transpose with gravity compensation: virtual springs and dampers on the base and on swinging tips (Pratt et al. 2001).

        tau = g + J_tips^T F - Jc^T lambda,    lambda nearest to the wanted wrenches with G lambda = g_base + M_base a

    where g are the forces that hold the robot at rest, a the acceleration that spring and damper of the base ask of the whole robot
    (M_base: its composite inertia), and F pulls a tip as a spring would whose stiffness is rate^2 times the mass that the limb's joints
    show at it, each by itself. No mass matrix is inverted, Coriolis forces are left out, and what a swinging limb does to the base.

    J. Pratt et al., "Virtual model control: an intuitive approach for bipedal locomotion", Int. J. of Robotics Research 20, 2001.
    """

    kernel = jacobian_transpose


class JointImpedance(BodyLaw):
    """Joint impedance: every joint a spring and a damper about where inverse kinematics of the aims have it (Hogan 1985).

        tau = g + K (q* - q) + D (qd* - qd) - Jc^T lambda,    lambda nearest to the wanted wrenches with G lambda = g_base

    With the base where it is to be, tips of limbs that hold on are where they took hold, and swinging ones on their paths; that is q*,
    by damped Newton steps from the last one. K is rate^2 times the inertia that a joint moves - of a limb that holds on, its part of the
    robot's mass at the tip's lever, too -, at most the joint's torque per 0.05 rad, and D is critical.

    N. Hogan, "Impedance control: an approach to manipulation", J. of Dynamic Systems, Measurement, and Control 107, 1985.
    """

    def __init__(self, tree: Tree, limits: Limits, gains: Gains, most_rows: int) -> None:
        super().__init__(tree, limits, gains, most_rows)
        self._reference = Reference.of(tree)
        held = tree, self.state, self.dynamics, self.aims, limits, self.packed, Room.of(self)
        self._work_out = ready(joint_impedance, Handle(*held, self._reference))
        self._begun = False

    def tick(self) -> Floats:
        """See `BodyLaw`."""
        if not self._begun:
            self._reference.state.joints[:], self._begun = self.state.joints, True
        return self.torques if self._work_out() else self._fail()


USUAL: Final = "whole-body"
"""That a robot has unless told otherwise."""
BODY_LAWS: Final[dict[str, type[BodyLaw]]] = {
    USUAL: WholeBody,
    "operational-space": OperationalSpace,
    "jacobian-transpose": JacobianTranspose,
    "joint-impedance": JointImpedance,
}
"""Name -> law; the command line, the bench and the tests read it."""


def body_law(name: str) -> type[BodyLaw]:
    """A law by name.

    Raises:
        UnknownNameError: If there is none of that name.
    """
    if name not in BODY_LAWS:
        raise UnknownNameError("law of a whole body", name, tuple(BODY_LAWS))
    return BODY_LAWS[name]
