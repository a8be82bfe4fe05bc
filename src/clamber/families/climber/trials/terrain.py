"""Unknown, uneven terrain of a climber: a board that is warped and turned against its map, and what its controller knows of that."""

import math
from typing import Final

import numpy as np
import numpy.typing as npt

from ....types import Floats
from ..planning.task import LimbedTask

WAVES: Final = 3
"""Waves that a warp is made of, along each axis."""
LENGTHS: Final = (4.0, 8.0)
"""Of these waves, over the robot's longest reach (chosen): neighbouring holds move alike, those of another stance differently."""
ABSENT: Final = (0.0, -100.0)
"""Where a hold that is missing is put, from where it would be [m]."""


def centre_of(task: LimbedTask) -> Floats:
    """Where the robot starts: there the map is right, and displacements count from there; shape (2,) [m]."""
    return np.array((task.start.x, task.start.y))


def warp(task: LimbedTask, rng: np.random.Generator) -> Floats:
    """A smooth displacement of every hold, none at the start, within -1 to 1 along each axis; shape (n_holds, 2) [-]."""
    places = np.vstack((task.world.positions(), centre_of(task)))
    shortest, longest = (part * task.robot.longest_reach for part in LENGTHS)
    out = np.zeros(places.shape)
    for axis in range(2):
        shares = rng.dirichlet(np.ones(WAVES))
        turns, phases = rng.uniform(0.0, math.tau, (2, WAVES))
        waves = math.tau / rng.uniform(shortest, longest, WAVES)
        along = places @ np.array((np.cos(turns), np.sin(turns)))
        out[:, axis] = 0.5 * (shares * np.sin(along * waves + phases)).sum(axis=1)
    return np.asarray(out[:-1] - out[-1])


def turned(task: LimbedTask, angle: float) -> Floats:
    """Displacement of every hold of a board that is turned about the start by an angle [rad], shape (n_holds, 2) [m]."""
    arms = task.world.positions() - centre_of(task)
    c, s = math.cos(angle), math.sin(angle)
    return np.asarray(arms @ np.array(((c, s), (-s, c))) - arms)


def may_be_missing(task: LimbedTask) -> npt.NDArray[np.bool_]:
    """Holds other than those that the robot starts on or a goal names, shape (n_holds,)."""
    kept = {*task.start.holds.values(), *(number for goal in task.goals for number in goal.holds.values())}
    return np.array([hold.number not in kept for hold in task.world.holds])


def terrain_covariance(task: LimbedTask, warped: float, tilt: float) -> Floats | None:
    """What a controller knows of a terrain: common uncertainty of the holds' places, x and y in turn, shape (2 n, 2 n) [m^2].

    A warp counts as a Gaussian process of that size and smoothness that is nothing at the start, a turn as one angle for all.

    Args:
        task: With the board as mapped.
        warped: Largest displacement, either way along each axis [m].
        tilt: Largest angle, either way [rad].

    Returns:
        None where the board is as mapped.
    """
    if warped == 0.0 and tilt == 0.0:
        return None
    places, centre = task.world.positions(), centre_of(task)
    # of waves of these lengths in any direction: the mean of (k . d)^2 is (2 pi d)^2 / (2 L_0 L_1)
    smooth = math.sqrt(2.0 * LENGTHS[0] * LENGTHS[1]) * task.robot.longest_reach / math.tau

    def alike(a: Floats, b: Floats) -> Floats:
        squares = ((a[:, None] - b[None]) ** 2).sum(axis=2)
        out: Floats = np.exp(-squares / (2.0 * smooth**2))
        return out

    to_start = alike(places, centre[None])
    common = warped**2 / 6.0 * (alike(places, places) - to_start @ to_start.T)
    arms = places - centre
    swept = np.stack((-arms[:, 1], arms[:, 0]), axis=1).ravel()
    return np.asarray(np.kron(common, np.eye(2)) + tilt**2 / 3.0 * np.outer(swept, swept))
