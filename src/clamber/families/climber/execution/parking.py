"""Where a free limb waits while the body moves: clear of every hold along the body's way, as near as can be to where it is."""

import math
from collections.abc import Sequence
from itertools import product
from typing import Final

import numpy as np

from ....types import Floats
from ..control.swing_path import clearances
from .approach import LEAST_CLEARANCE, Approaches, discs_near

SPARE: Final = 0.012
"""Clearance along the body's way at which a limb is left where it is [m]: the body sways by about as much."""
OUT: Final = 0.04
"""Clearance of a free limb that is not between two holds of a row: from there it comes to any [m]."""
TIGHT: Final = (LEAST_CLEARANCE, 0.0, -0.002)
"""Clearances of the way there, tried in turn where the body moves whatever comes of it: holds count with their doubt [m]."""
LOOKS: Final = 0.02
"""Between two poses of the way that are looked at [m], or [rad] at 0.2 m."""
PITCH: Final = 21
"""Postures along each joint that are tried."""


def poses_between(start: Floats, end: Floats) -> list[Floats]:
    """Poses of a straight way of the body, both ends with it."""
    change = end - start
    length = float(np.hypot(change[0], change[1])) + 0.2 * abs(float(change[2]))
    return [start + u * change for u in np.linspace(0.0, 1.0, 2 + int(length / LOOKS))]


def unwound(pose: Floats, angle: float) -> Floats:
    """A pose, its angle counted on from another [rad]."""
    return np.array((pose[0], pose[1], angle + math.remainder(pose[2] - angle, math.tau)))


def room_along(approaches: Approaches, i: int, angles: Floats, poses: Sequence[Floats], discs: Floats) -> float:
    """Clearance of a limb, joints at angles, shape (2,) [rad], from discs as the body goes along poses; negative: it meets one [m]."""
    every = np.concatenate([discs_near(discs, pose) for pose in poses])
    return float(_rooms(approaches, i, angles[None], every)[0])


def _rooms(approaches: Approaches, i: int, angles: Floats, discs: Floats) -> Floats:
    """Clearance of a limb from discs and body at each of its joint angles, shape (n, 2) [rad]; shape (n,) [m]."""
    rooms = np.empty(len(angles))
    clearances(approaches.legs[i], angles, approaches.obstacles(discs), rooms)
    return rooms


def passes(approaches: Approaches, i: int, angles: Floats, poses: Sequence[Floats], discs: Floats) -> bool:
    """Whether the body may go along poses with a free limb: it meets no hold, or can first go to where it meets none.

    Args: As `park`.
    """
    if room_along(approaches, i, angles, poses, discs) >= 0.0:
        return True
    way = park(approaches, i, angles, poses, discs)
    return way is not None and room_along(approaches, i, way[-1], poses, discs) >= 0.0


def park(
    approaches: Approaches,
    i: int,
    angles: Floats,
    poses: Sequence[Floats],
    discs: Floats,
    spare: float = SPARE,
    margins: Sequence[float] = (LEAST_CLEARANCE,),
) -> Floats | None:
    """A way of a free limb's joints to where it may wait, shape (n, 2) [rad]; None where it is well placed, or there is none better.

    Args:
        approaches: Of the robot.
        i: Index of the limb.
        angles: Where it is, shape (2,) [rad].
        poses: Of the body along its way, the present one first.
        discs: All holds with their doubt: x, y, radius, world frame, shape (n, 3) [m].
        spare: Clearance with which it is well placed [m].
        margins: Clearances that the way keeps but where it begins with less, the first with which there is one [m].
    """
    seen = [discs_near(discs, pose) for pose in poses]
    every = np.concatenate(seen)
    here = float(_rooms(approaches, i, angles[None], every)[0])
    if here >= spare:
        return None
    lower, upper = approaches.limits[i]
    grid = np.stack(np.meshgrid(*np.linspace(lower, upper, PITCH).T, indexing="ij"), axis=-1).reshape(-1, 2)
    rooms = _rooms(approaches, i, grid, every)
    enough = min(spare, float(rooms.max()))
    if enough <= here:
        return None
    fit = grid[rooms >= enough - 1e-9]
    near = fit[np.argsort(np.abs(fit - angles).max(axis=1), kind="stable")[:8]]
    for least, goal in product(margins, near):
        way = approaches.way(i, angles, goal, approaches.obstacles(seen[0]), least)
        if way is not None:
            return way
    return None
