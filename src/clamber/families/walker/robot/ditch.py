"""The widest ditch that a two-frame walker crosses at one angle of its frames."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ....errors import StatedError
from ....types import Floats
from .arcs import COLUMNS, MOST_ARCS, ROOM
from .crossing import SIDES, balance_curves, widest_map
from .curves import CURVE_NUMBERS, MOST_CURVES
from .geometry import TwoFrames
from .robot import WalkerRobot
from .weight import Weight, weight_of


@dataclass(frozen=True, slots=True, eq=False)
class Footing:
    """What decides where a walker stands and slides on level ground: its mechanism, its feet, and where its weight is."""

    frames: TwoFrames
    feet: Floats
    """Of both frames, each in its own frame, anticlockwise, shape (2, 3, 2) [m]."""
    pad_radius: float
    """Of a foot [m]; all of it is kept out of the ditch."""
    weight: Weight
    guard: float
    """Largest nearness of a singular pose [-]; 0 for no such limit."""
    margin: float
    """How far inside the standing feet the centre of mass is kept [m]."""

    @classmethod
    def of(
        cls, robot: WalkerRobot, *, weight: Weight | None = None, guard: float | None = None, margin: float = 0.0
    ) -> "Footing":
        """A robot's footing.

        Args:
            robot: The robot.
            weight: Its weight; that with the arm at rest and no payload unless given.
            guard: Largest nearness of a singular pose [-]; that of its file unless given; 0 for none.
            margin: How far inside the standing feet the centre of mass is kept [m].

        Raises:
            FootingError: If the margin is negative or not finite, or the guard is, or is above 1.
        """
        frames = TwoFrames.of(robot.mechanism)
        guard = frames.guard if guard is None else guard
        if not 0.0 <= margin < math.inf:
            raise FootingError("margin", margin)
        if not 0.0 <= guard <= 1.0:
            raise FootingError("guard", guard, "from 0 to 1")
        weight = weight_of(robot) if weight is None else weight
        return cls(frames, robot.feet(), robot.legs.pad_radius, weight, guard, margin)

    def balance_curves(self, theta: float) -> Floats:
        """The lines between which both frames can carry the robot, as rows for `workspace`, shape (6, CURVE_NUMBERS)."""
        curves = np.zeros((MOST_CURVES, CURVE_NUMBERS))
        load_x, load_y = self.weight.load
        share = self.weight.share[1]
        n = balance_curves(self.feet[0], self.feet[1], theta, share, load_x, load_y, self.margin, curves, 0)
        return curves[:n]

    def feet_at(self, poses: Floats) -> Floats:
        """Places of all feet on the ground, shape (2, 3, 2) [m], from the frames' poses there, shape (2, 3)."""
        c, s = np.cos(poses[:, 2]), np.sin(poses[:, 2])
        turns = np.stack([np.stack([c, s], axis=-1), np.stack([-s, c], axis=-1)], axis=1)  # turn rows by the angles
        placed: Floats = poses[:, None, :2] + self.feet @ turns
        return placed

    def balance(self, poses: Floats, standing: int) -> float:
        """How far the centre of mass lies inside the feet of the frame that stands [m]; negative outside. Poses have shape (2, 3)."""
        centre = self.weight.centre(poses)
        feet = self.feet_at(poses)[standing]
        sides = np.roll(feet, -1, axis=0) - feet
        off = centre - feet
        return float(((sides[:, 0] * off[:, 1] - sides[:, 1] * off[:, 0]) / np.hypot(*sides.T)).min())


class FootingError(StatedError):
    """A width, distance, margin or guard that means nothing."""

    says = "{what} = {value:.6g}: must be {allowed}"
    what: str
    value: float
    allowed: str = "finite and 0 or more"


def ditch_map(footing: Footing, thetas: npt.ArrayLike, directions: npt.ArrayLike, *, aside: bool = True) -> Floats:
    """The widest ditches that can be crossed, to 1e-10 m, shape (n_thetas, n_directions) [m].

    The ditch lies across the crossing direction, the angle of the frames stays. All that counts is which slides of either frame, from
    places where no foot is in the ditch to such places, with the actuators in range and the centre of mass over either frame's feet,
    connect both sides; the frames keep to the part of their region around its centre. 0 where they may not lie on each other.

    Args:
        footing: The robot.
        thetas: Angles of the Y-frame in the Delta-frame [rad], shape (n_thetas,).
        directions: Of crossing, in the Delta-frame [rad], shape (n_directions,).
        aside: Whether slides may also lead along the ditch; else they keep to the line through the origins, as in a straight walk.
    """
    thetas, directions = np.atleast_1d(np.asarray(thetas, float)), np.atleast_1d(np.asarray(directions, float))
    frames, (load_x, load_y) = footing.frames, footing.weight.load
    out = np.empty((len(thetas), len(directions)))
    widest_map(
        frames.delta, frames.y, frames.shortest, frames.longest, footing.guard,
        footing.feet[0], footing.feet[1], footing.weight.share[1], load_x, load_y, footing.margin, aside, thetas, directions, out,
        np.zeros((MOST_CURVES, CURVE_NUMBERS)), np.empty((MOST_ARCS, COLUMNS)), np.empty(MOST_ARCS), np.empty(MOST_ARCS, np.int64),
        np.empty(ROOM), np.empty((SIDES, SIDES), np.bool_), np.empty((SIDES * SIDES, 2), np.int64),
        np.empty((2, 3)),
    )  # fmt: skip
    widths: Floats = np.maximum(0.0, out - 2.0 * footing.pad_radius)
    return widths
