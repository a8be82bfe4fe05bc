r"""A climber that hangs on one limb, as a pendulum: where its centre of gravity is, how fast it swings, and what joints do to the swing.

The hook turns freely on its peg, so nothing but weight brings moment about it. With M the mass, l the distance of the centre of gravity
from the peg, phi its angle from straight below, I the inertia about the peg with stiff joints, and q the joints of the limb,

    I phi'' + c . q'' + M g l phi = 0    (small swings, slow q)

where c . q' is the angular momentum about the peg that moving joints bring while phi stays. A point mass has c = 0: shifting it sideways
of its peg is a swing of its own, and damps none. The parts beyond a joint turn, and that is what the joints can push against.
"""

import math
from typing import Final

import numpy as np

from ....types import Floats
from ....units import GRAVITY
from ..control.limb_chain import chain_of_limb
from ..robot.robot import LimbedRobot, body_inertia, body_mass

DIFFERENCE: Final = 1e-5
"""Step of the joints over which slopes are taken [rad]."""
ARM: Final = 0.2
"""Of a turn that counts as much as a length [m]."""
SOFT: Final = 0.01
"""Damping of the inverse [m]."""


class Pendulum:
    """The masses of a climber about the hold of one limb.

    Args:
        robot: The climber; its limbs have two joints.
        limb: Index of the limb that holds.
    """

    def __init__(self, robot: LimbedRobot, limb: int) -> None:
        self.limb = limb
        self.mass = robot.weight / GRAVITY
        chains = [chain_of_limb(robot, one.name) for one in robot.limbs]
        self._ports = np.array([complex(one.port_x, one.port_y) for one in robot.limbs])
        self._turns = np.exp(1j * np.array([one.port_angle for one in robot.limbs]))
        self._l1 = np.array([one.l1 for one in robot.limbs])
        self._masses = np.array([chain.joints["mass"] for chain in chains])  # (limbs, 2)
        self._centres = np.array([chain.joints["centre"][:, 0] for chain in chains])
        self._inertias = np.array([chain.joints["inertia"][:, 2, 2] for chain in chains])
        self._tip = robot.limbs[limb].second_link
        self._body_mass, self._body_inertia = body_mass(robot), body_inertia(robot)

    def _parts(self, q: Floats) -> tuple[Floats, Floats, complex]:
        """Centres of the links in the body frame as complex numbers, their directions, and the tip that holds."""
        first = self._turns * np.exp(1j * q[:, 0])
        second = first * np.exp(1j * q[:, 1])
        elbows = self._ports + self._l1 * first
        centres = np.stack((self._ports + self._centres[:, 0] * first, elbows + self._centres[:, 1] * second), axis=1)
        directions = np.stack((first, second), axis=1)
        return centres, directions, complex(elbows[self.limb] + self._tip * second[self.limb])

    def arm(self, q: Floats) -> complex:
        """Centre of gravity less the hold, body frame, x + iy [m].

        Args:
            q: Joint angles, shape (limbs, 2) [rad].
        """
        centres, _, tip = self._parts(q)
        return complex((self._masses * centres).sum()) / self.mass - tip

    def length(self, q: Floats) -> float:
        """Distance of the centre of gravity from the hold [m]."""
        return abs(self.arm(q))

    def rest(self, q: Floats) -> float:
        """Body angle with the centre of gravity straight below the hold, in -pi .. pi [rad]."""
        arm = self.arm(q)
        return math.remainder(-math.pi / 2 - math.atan2(arm.imag, arm.real), math.tau)

    def swing(self, q: Floats, angle: float) -> float:
        """Angle of the centre of gravity from straight below, anticlockwise [rad]; `angle` is the body's."""
        return math.remainder(angle - self.rest(q), math.tau)

    def pose(self, q: Floats, hold: Floats, angle: float | None = None) -> Floats:
        """Body pose with the limb on its hold; at rest, unless the body's angle is given."""
        theta = self.rest(q) if angle is None else angle
        tip = self._parts(q)[2] * complex(math.cos(theta), math.sin(theta))
        return np.array((hold[0] - tip.real, hold[1] - tip.imag, theta))

    def angles_for(self, q: Floats, depth: float, angle: float, rounds: int = 1) -> Floats:
        """Joint angles of the holding limb with which the body, at rest, is so far below the hold and turned so, shape (2,) [rad].

        Newton's rounds from its angles in `q`, damped where the limb is stretched; x is what the weight makes of it.

        Args:
            q: Joint angles, shape (limbs, 2) [rad].
            depth: Of the body's origin below the hold [m].
            angle: Of the body [rad].
            rounds: One for following, more from afar.
        """
        moved = q.copy()
        for _ in range(rounds):
            here = self._depth_and_rest(moved)
            slopes = np.zeros((2, 2))
            for j in range(2):
                moved[self.limb, j] += DIFFERENCE
                there = self._depth_and_rest(moved)
                moved[self.limb, j] -= DIFFERENCE
                slopes[:, j] = there[0] - here[0], math.remainder(there[1] - here[1], math.tau) * ARM
            slopes /= DIFFERENCE
            lack = np.array((depth - here[0], math.remainder(angle - here[1], math.tau) * ARM))
            moved[self.limb] += slopes.T @ np.linalg.solve(slopes @ slopes.T + SOFT**2 * np.eye(2), lack)
        return np.array(moved[self.limb])

    def _depth_and_rest(self, q: Floats) -> tuple[float, float]:
        theta = self.rest(q)
        tip = self._parts(q)[2]
        return tip.imag * math.cos(theta) + tip.real * math.sin(theta), theta

    def inertia(self, q: Floats) -> float:
        """About the hold, with stiff joints [kg m^2]."""
        centres, _, tip = self._parts(q)
        about = self._body_mass * abs(tip) ** 2 + self._body_inertia + self._inertias.sum()
        return float(about + (self._masses * np.abs(centres - tip) ** 2).sum())

    def frequency(self, q: Floats) -> float:
        """Of small swings with stiff joints, sqrt(M g l / I) [rad/s]."""
        return math.sqrt(self.mass * GRAVITY * self.length(q) / self.inertia(q))

    def momentum(self, q: Floats) -> Floats:
        """c: angular momentum about the hold per speed of the holding limb's joints while phi stays, shape (2,) [kg m^2]."""
        c = np.zeros(2)
        for j in range(2):
            centres, directions, angles = [], [], []
            for sign in (-0.5, 0.5):
                moved = q.copy()
                moved[self.limb, j] += sign * DIFFERENCE
                theta = self.rest(moved)
                turn = complex(math.cos(theta), math.sin(theta))
                links, along, tip = self._parts(moved)
                centres.append(np.append((links - tip).ravel(), -tip) * turn)
                directions.append(along.ravel() * turn)
                angles.append(theta)
            masses = np.append(self._masses.ravel(), self._body_mass)
            middle, moved_by = (centres[0] + centres[1]) / 2, centres[1] - centres[0]
            turned = np.angle(directions[1] / directions[0])
            c[j] = float((masses * (np.conj(middle) * moved_by).imag).sum() + (self._inertias.ravel() * turned).sum())
            c[j] += self._body_inertia * math.remainder(angles[1] - angles[0], math.tau)
        return c / DIFFERENCE

    def loads(self, q: Floats, angle: float) -> Floats:
        """Torques of the holding limb's joints that bear the weight, the body still, shape (2,) [N m]."""
        turn = complex(math.cos(angle), math.sin(angle))
        out = np.zeros(2)
        for j in range(2):
            heights = []
            for sign in (-0.5, 0.5):
                moved = q.copy()
                moved[self.limb, j] += sign * DIFFERENCE
                heights.append((self.arm(moved) * turn).imag)
            out[j] = self.mass * GRAVITY * (heights[1] - heights[0]) / DIFFERENCE
        return out
