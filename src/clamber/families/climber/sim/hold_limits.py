"""Holds that give way: above their strength, or pulled outside their direction, a hold is gone for good."""

import math
from typing import Any, Final

import numpy as np

from ....execution.plant import HoldBreak
from ....sim.contact_forces import add_forces
from ..world.board import Board
from .grippers import GIVING_WAY, Grippers

TOUCH: Final = 0.05
"""A pull outside a hold's direction of less than this part of the robot's weight is a touch and breaks nothing [-]."""


class HoldLimits:
    """Strengths and directions of a board's holds in contact dynamics.

    The force on a hold is the sum of all contacts with it and of the gripper that is closed about it, looked at once a control period,
    that of its last physics step. A hold breaks when it has been too large, or outside its cone, for `GIVING_WAY`, as a gripper slips.

    Args:
        board: Whose holds they are.
        weight: Of the robot [N].
        grippers: Of the robot.
        model, data: MuJoCo's, of `climber_spec`.
        period: Of the control [s].
    """

    def __init__(self, board: Board, weight: float, grippers: Grippers, model: Any, data: Any, period: float) -> None:
        self._model, self._data, self._grippers, self._period = model, data, grippers, period
        holds = board.holds
        self._numbers = board.numbers()
        self._geoms = np.array([model.geom(f"peg {hold.number}").id for hold in holds])
        self._bits = model.geom_contype[self._geoms].copy(), model.geom_conaffinity[self._geoms].copy()
        self._hold_of = np.full(model.ngeom, -1)
        self._hold_of[self._geoms] = np.arange(len(holds))
        self._own = np.array([math.inf if hold.strength is None else hold.strength for hold in holds])
        self._strength = self._own.copy()
        self._direction = np.array([0.0 if hold.direction is None else hold.direction for hold in holds])
        self._cone = np.array([math.inf if hold.cone is None else hold.cone for hold in holds])
        self._touch = TOUCH * weight
        self._forces, self._over = np.zeros((len(holds), 3)), np.zeros(len(holds))
        self._gone = np.zeros(len(holds), bool)
        self.broken: tuple[HoldBreak, ...] = ()
        """Since the reset, in the order in which they broke."""
        self._any = self._are_limited()

    def reset(self) -> None:
        """Make every hold whole again, with the strength that the board states."""
        self._over[:], self._gone[:], self.broken = 0.0, False, ()
        self._strength[:] = self._own
        self._model.geom_contype[self._geoms], self._model.geom_conaffinity[self._geoms] = self._bits
        self._any = self._are_limited()

    def weaken(self, number: int, strength: float) -> None:
        """Give hold `number` another strength [N] than the board states."""
        self._strength[int(np.flatnonzero(self._numbers == number)[0])] = strength
        self._any = True

    def feel(self, time: float) -> None:
        """Break what is overloaded: after the physics of a control period that ends at `time` [s]."""
        if not self._any:
            return
        forces, contact = self._forces, self._data.contact
        forces[:] = 0.0
        add_forces(contact.efc_address, contact.geom, contact.frame, self._data.efc_force, self._hold_of, forces)
        for limb in self._grippers.limbs:
            if self._grippers.gripped[limb]:
                forces[self._grippers.caught[limb]] += self._grippers.pulls[limb]
        sizes = np.hypot(forces[:, 0], forces[:, 1])
        off = np.abs(np.remainder(np.arctan2(forces[:, 1], forces[:, 0]) - self._direction + np.pi, 2 * np.pi) - np.pi)
        astray = (off > self._cone) & (sizes > self._touch)
        over = ((sizes > self._strength) | astray) & ~self._gone
        self._over = np.where(over, self._over + self._period, 0.0)
        for k in np.flatnonzero(self._over >= GIVING_WAY):
            self._break(int(k), time, float(sizes[k]), float(off[k]))

    def _break(self, k: int, time: float, force: float, off: float) -> None:
        self._gone[k] = True
        self._model.geom_contype[self._geoms[k]] = self._model.geom_conaffinity[self._geoms[k]] = 0
        self._grippers.lose(k)
        if force > self._strength[k]:
            why = f"{force:.1f} N on it, and it takes {self._strength[k]:g} N"
        else:
            why = f"pulled {math.degrees(off):.0f} deg from its direction, and it holds within {math.degrees(self._cone[k]):.0f} deg"
        self.broken = (*self.broken, HoldBreak(time, int(self._numbers[k]), force, why))

    def _are_limited(self) -> bool:
        return bool(np.isfinite(self._strength).any() or np.isfinite(self._cone).any())
