"""The reachable place nearest to a target: damped Gauss-Newton steps through the programme of the law, from several postures of the arm."""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from .....types import Floats
from ...robot import WalkerRobot
from .cooperator import Cooperator
from .limits import Kept
from .planted_feet import LimitError, PlantedFeet
from .settings import Cooperation
from .tool_chain import POSE

REACHED: Final = 1e-6
"""A place as near as this counts as the target [m]."""
STEPS: Final = 300
TRUST: Final = (0.03, 0.03, 0.03, 0.1, 0.1, 0.1)
"""Farthest that the plate goes in one step of the search [m, rad]."""
TURN: Final = 0.3
"""Likewise a joint of the arm [rad]."""
INSIDE: Final = (3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5, 1e-7)
"""Distances from the limits of the plate's pose that the search keeps, one after the other [m]: along a curved limit it can take long
steps only where it is not close to it."""
ENOUGH: Final = 1e-7
"""A step counts if it brings the tool nearer by this part of the distance."""
SMALLEST: Final = 1e-6
"""The search ends when its steps have shrunk to this part of the above."""
HOLDS: Final = 1e-4
"""A limit is named if its multiplier is at least this part of the largest one."""


@dataclass(frozen=True, slots=True, eq=False)
class Reach:
    """The nearest place to a target that the tool can have, and what keeps it from being nearer."""

    q: Floats
    """Freedoms there, shape (m,)."""
    place: Floats
    """Of the tool, world [m], shape (3,)."""
    distance: float
    """From the target [m]."""
    held_by: tuple[str, ...]
    """Limits that hold it there; empty where it is reached, or where the chain is stretched out."""

    @property
    def reached(self) -> bool:
        """Whether that place is the target."""
        return self.distance <= REACHED

    @property
    def reason(self) -> str:
        """In words, for a person."""
        if self.reached:
            return "reached"
        why = ", ".join(self.held_by) if self.held_by else "the arm is stretched out"
        x, y, z = self.place.tolist()
        return f"out of reach: the closest reachable point is x {x:.3f}, y {y:.3f}, z {z:.3f} m, {1e3 * self.distance:.1f} mm away ({why})"


class ReachSearch:
    """Looks for the nearest reachable places with one stance and one set of freedoms."""

    def __init__(
        self, robot: WalkerRobot, footing: PlantedFeet, weights: Floats, *, balance: float = 0.0, kept: Kept = "places"
    ) -> None:
        """Starts no search.

        Args:
            robot: With an arm.
            footing: What it stands on.
            weights: 1 for freedoms that may move, 0 for the others, shape (m,).
            balance: Least distance of the centre of mass from the support's edges [m].
            kept: Which limits bound the places.
        """
        arm = robot.own_arm
        speeds = np.array([*TRUST, *np.full(arm.n_joints, TURN)])
        settings = Cooperation(
            speeds=speeds,
            tool_speeds=np.ones(3),
            gain=0.0,
            feedback=1.0,
            period=1.0,
            approach=1.0,
            balance=balance,
            damping=0.0,
        )
        self._laws = [Cooperator(robot, replace(settings, inside=inside), footing, kept) for inside in INSIDE]
        self._law = self._laws[-1]
        self._law.check_weights(weights)
        self._weights = weights
        low, high = np.array(arm.lowest), np.array(arm.highest)
        rng = np.random.default_rng(0)
        own = 0.5 * (low + high) + 0.45 * (high - low) * rng.uniform(-1.0, 1.0, (10, arm.n_joints))
        self._postures = [np.array(arm.rest), *own]

    def find(self, q: Floats, target: Floats, *, postures: bool = True) -> Reach:
        """The nearest reachable place to a target.

        Gauss-Newton steps end in a place that is nearest among its neighbours; the postures from which they start make it likely, not
        certain, that none is nearer.

        Args:
            q: Freedoms to start from, within the limits, shape (m,).
            target: World [m], shape (3,).
            postures: Whether to start from postures of the arm across its range too, not from `q` alone.
        """
        best, chain = self._descend(q, target), self._law.chain
        for joints in self._postures if postures else ():
            if best.reached:
                break
            start = q.copy()
            start[POSE:] = joints
            away = target - start[:3]
            turn = np.arctan2(away[1], away[0]) - q[3]  # towards the target, where the joint can
            start[POSE] = np.clip(np.remainder(turn + np.pi, 2 * np.pi) - np.pi, chain.lowest[0], chain.highest[0])
            try:
                self._law.check_start(start)
            except LimitError:
                continue
            found = self._descend(start, target)
            if found.distance < best.distance:
                best = found
        return best

    def _descend(self, q: Floats, target: Floats) -> Reach:
        still = np.zeros(3)
        here = self._law.place(q)
        distance = float(np.linalg.norm(target - here))
        tight: tuple[int, ...] = ()
        for law in self._laws:
            trust = 1.0
            for _ in range(STEPS):
                if distance <= REACHED * 1e-3 or trust < SMALLEST:
                    break
                step = law.step(q, target, still, trust * self._weights)
                place = law.place(step.q)
                nearer = float(np.linalg.norm(target - place))
                if nearer < distance * (1.0 - ENOUGH):
                    trust = min(1.0, 2.0 * trust) if step.share == 1.0 else trust
                    q, here, distance, tight = step.q, place, nearer, step.tight
                else:
                    trust *= 0.25
        names = tuple(self._law.names[k] for k in tight if k < self._law.n_ranges) if distance > REACHED else ()
        return Reach(q, here, distance, names)
