"""Laws of a whole body: the face that all have, and whole-body control by a quadratic programme of accelerations and contact wrenches."""

from abc import ABC, abstractmethod
from typing import Any, Final

import numpy as np

from ...compiled import Handle, ready
from ...types import Floats
from .programme import Aims, Gains, Limits, Programme
from .programme_kernels import hold_torques, read_solution, write_and_solve
from .tree import Dynamics, State, Tree
from .tree_kernels import look

DAMPED: Final = 0.1
"""Of a joint's largest torque that motion of 1 rad/s takes where a law finds no torques [s]."""


class BodyLaw(ABC):
    """The law of one robot, with its memory.

    Args:
        tree: The robot as it is believed to be.
        limits: Of its joints.
        gains: Weights and feedback.
        most_rows: Of a contact's polytope.
    """

    def __init__(self, tree: Tree, limits: Limits, gains: Gains, most_rows: int) -> None:
        self.tree, self.limits, self.gains = tree, limits, gains
        self.state, self.dynamics = State.of(tree), Dynamics.of(tree)
        self.aims = Aims.of(tree, most_rows)
        self.torques: Floats = np.zeros(tree.joints)
        """Of the last tick, shape (n,)."""
        self.wrenches: Floats = np.zeros((tree.limbs, 6))
        """That contacts are meant to bear, each in its own frame, shape (limbs, 6)."""
        self.failures = 0
        """Ticks in which the law found no torques."""
        self.packed, self._damping = gains.packed(), DAMPED * float(np.min(limits.torque))
        self._own = Handle(tree, self.state, self.dynamics)

    def look(self) -> None:
        """Work out the dynamics of `state`."""
        look(self._own)

    @abstractmethod
    def tick(self) -> Floats:
        """Torques for `aims` in `state`, after `look`; shape (n,), the law's own."""

    def _fail(self) -> Floats:
        """Torques that hold the robot by the wrenches that are wanted."""
        self.failures += 1
        hold_torques(self.dynamics, self.aims, self.limits, self._damping, self.state, self.torques)
        return self.torques


class WholeBody(BodyLaw):
    """Whole-body control: at each tick the accelerations and contact wrenches that come nearest to what is asked for, as motor torques.

    All limits are kept: of torques, of contacts, and, as far as that can be, of joints. Where none binds, as at most ticks, the programme
    is its equations, which a kernel solves; all others are DAQP's.
    """

    def __init__(self, tree: Tree, limits: Limits, gains: Gains, most_rows: int) -> None:
        import daqp

        super().__init__(tree, limits, gains, most_rows)
        self._solve: Any = daqp.solve
        self.told: dict[str, Any] = {}
        """What the solver says of the last tick that it solved: `setup_time`, `solve_time` [s], `iterations`."""
        self._programme = Programme.of(tree, most_rows)
        own = tree, self.state, self.dynamics, self.aims, limits, self.packed
        self._all = Handle(*own, self._programme, self.torques, self.wrenches)
        self._write_and_solve = ready(write_and_solve, self._all)
        self._views: dict[tuple[int, int], tuple[Any, ...]] = {}

    def tick(self) -> Floats:
        """See `BodyLaw`."""
        n, m, solved = self._write_and_solve()
        if solved:
            return self.torques
        x, _, flag, self.told = self._solve(*(self._views.get((n, m)) or self._view(n, m)))
        if flag < 1:
            return self._fail()
        read_solution(self._all, m, x)
        return self.torques

    def _view(self, n: int, m: int) -> tuple[Any, ...]:
        """The programme of so many unknowns and rows as the solver takes it: H, f, A, upper, lower, sense."""
        of = self._programme
        made = self._views[n, m] = (
            of.h[: n * n].reshape(n, n),
            of.f[:n],
            of.a[: m * n].reshape(m, n),
            of.upper[: n + m],
            of.lower[: n + m],
            of.sense[: n + m],
        )
        return made
