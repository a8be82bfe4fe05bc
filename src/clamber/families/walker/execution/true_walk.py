"""What truly happens in a walk, tick by tick: a plant that writes itself down, and what follows from what was written."""

import math
from dataclasses import dataclass
from itertools import permutations
from typing import Final

import numpy as np

from ....execution.plant import PlantLayer
from ....types import Floats, Ints
from .plant import WalkerPlant, WalkerSensed, WalkerTruth

ROWS: Final = 4096
"""Room for so many ticks is made at a time."""
SHAPES: Final[dict[str, tuple[int, ...]]] = {
    "time": (), "pose": (6,), "place": (3,), "feet": (2, 3, 3), "forces": (2, 3, 3), "centre": (3,), "tool": (3,), "thrusts": (3,),
    "inclines": (2,),
}  # fmt: skip
"""Of a row of each field of a walk, in the order in which a tick is kept."""
WIDTH: Final = sum(map(math.prod, SHAPES.values()))


@dataclass(frozen=True, slots=True, eq=False)
class TrueWalk:
    """A walk as it truly was, world frame, a row a tick."""

    time: Floats
    """Since the start, shape (rows,) [s]."""
    pose: Floats
    """Of the plate, shape (rows, 6) [m], [rad]."""
    place: Floats
    """Of the Y-frame in the Delta-frame, shape (rows, 3) [m], [rad]."""
    feet: Floats
    """Middles of the soles, shape (rows, 2, 3, 3) [m]."""
    forces: Floats
    """Of the ground on each foot, shape (rows, 2, 3, 3) [N]; zero in the air."""
    centre: Floats
    """Centre of mass, shape (rows, 3) [m]."""
    tool: Floats
    """The arm's tool point, shape (rows, 3) [m]; NaN without an arm."""
    thrusts: Floats
    """Of the actuators, shape (rows, 3) [N]; positive pushes the frames' attachments apart."""
    inclines: Floats
    """By the inclinometers, shape (rows, 2) [rad]."""

    @property
    def touching(self) -> Ints:
        """1 for feet on the ground, shape (rows, 2, 3)."""
        touching: Ints = (self.forces != 0.0).any(axis=-1).astype(np.int32)
        return touching

    @property
    def tilts(self) -> Floats:
        """Angle of the plate's normal to the vertical, shape (rows,) [rad]."""
        tilts: Floats = np.arccos(np.clip(np.cos(self.pose[:, 4]) * np.cos(self.pose[:, 5]), -1.0, 1.0))
        return tilts

    @property
    def margins(self) -> Floats:
        """How far the centre of mass lies inside the hull of the feet on the ground, from above, shape (rows,) [m]; see `hull_margins`."""
        rows = len(self.time)
        return hull_margins(self.feet.reshape(rows, 6, 3), self.touching.reshape(rows, 6), self.centre)


class TracedPlant(PlantLayer[WalkerPlant, WalkerTruth | None]):
    """A walker's plant that keeps what truly happens; a `WalkerPlant` itself.

    Args:
        plant: It tells the truth.
    """

    def __init__(self, plant: WalkerPlant) -> None:
        super().__init__(plant)
        self._table = np.empty((ROWS, WIDTH))
        self._rows = self._ticks = 0
        self._inclines = np.zeros(2)

    def reset(self, pose: Floats, place: Floats, legs: Floats, arm: Floats) -> None:
        """See `WalkerPlant`; what was kept is forgotten."""
        self.plant.reset(pose, place, legs, arm)
        self._rows = self._ticks = 0
        self._inclines = self.plant.sense().inclines
        self._keep()

    def sense(self) -> WalkerSensed:
        """See `WalkerPlant`."""
        sensed = self.plant.sense()
        self._inclines = sensed.inclines
        return sensed

    def actuate(self, actuators: Floats, legs: Floats, arm: Floats) -> None:
        """See `WalkerPlant`."""
        self.plant.actuate(actuators, legs, arm)

    def step(self) -> None:
        """See `WalkerPlant`."""
        self.plant.step()
        self._ticks += 1
        self._keep()

    def trace(self) -> TrueWalk:
        """All ticks since the reset."""
        parts: dict[str, Floats] = {}
        start = 0
        for field, shape in SHAPES.items():
            end = start + math.prod(shape)
            parts[field] = self._table[: self._rows, start:end].reshape(self._rows, *shape).copy()
            start = end
        return TrueWalk(**parts)

    def _keep(self) -> None:
        true = self.plant.truth()
        if true is None:
            return
        if self._rows == len(self._table):
            self._table = np.concatenate([self._table, np.empty_like(self._table)])
        row = self._table[self._rows]
        row[0] = self._ticks * self.period
        start = 1
        parts = true.pose, true.place, true.feet, true.forces, true.centre, true.tool, true.thrusts, self._inclines
        for part in parts:
            row[start : start + part.size] = part.ravel()
            start += part.size
        self._rows += 1


def hull_margins(feet: Floats, stands: Ints, points: Floats) -> Floats:
    """How far points lie inside the hulls of standing feet, seen from above, shape (rows,) [m]; negative outside.

    Outside it is minus the distance from the farthest edge's line. Fewer than three feet, or three in line, have no inside: -inf.

    Args:
        feet: Shape (rows, n, 2 or 3) [m].
        stands: 1 for feet that stand, shape (rows, n).
        points: Shape (rows, 2 or 3) [m].
    """
    best = np.full(len(points), math.inf)
    up = stands.astype(bool)
    for a, b in permutations(range(feet.shape[1]), 2):
        way = feet[:, b, :2] - feet[:, a, :2]
        length = np.hypot(way[:, 0], way[:, 1])
        length[length == 0.0] = math.nan
        left = np.stack((-way[:, 1], way[:, 0]), axis=-1) / length[:, None]
        sides = np.einsum("rk,rnk->rn", left, feet[..., :2] - feet[:, a, None, :2])
        others = np.where(up, sides, math.inf).min(axis=1)
        # an edge of the hull: all that stand are to its left, and something is off its line
        edge = up[:, a] & up[:, b] & (others >= -1e-9) & (np.where(up, sides, -math.inf).max(axis=1) > 1e-9)
        inside = np.einsum("rk,rk->r", left, points[:, :2] - feet[:, a, :2])
        np.minimum(best, inside, out=best, where=edge)
    best[np.isinf(best)] = -math.inf
    return best
