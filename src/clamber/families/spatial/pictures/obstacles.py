"""Which solid things of a world stand between a place and the camera."""

from collections.abc import Callable
from typing import Final

import numpy as np

from ....types import Floats
from ..world.solids import BAR, BOX, CYLINDER, FIELD, PLANE, TUBE
from ..world.terrain_kernels import field_distances
from ..world.world import World

MARCHED: Final = 48
"""Places along each line of sight that are looked at."""


def clear_of_solids(world: World, eyes: Floats) -> Callable[[Floats], float]:
    """What gives the share of places that a camera sees past all solids, for a direction towards it.

    Planes that are seen from behind and the near side of tubes are drawn as glass, and bars are thin, so none of them hides anything.

    Args:
        world: Its solids.
        eyes: The places, outside all solids, world frame [m], shape (n, 3).
    """
    hiding = [solid for solid in world.solid_records if int(solid["kind"]) in (BOX, CYLINDER, FIELD)]
    span = float(np.ptp(eyes, axis=0).max()) + 1.0
    along = np.linspace(0.0, 3.0 * span, MARCHED)

    def share(towards: Floats) -> float:
        points = eyes[:, None] + along[:, None] * towards
        seen = np.ones(len(eyes), bool)
        for solid in hiding:
            seen &= (distances(solid, points) > -1e-9).all(axis=1)
        return float(seen.mean())

    return share


def distances(solid: np.void, points: Floats) -> Floats:
    """Signed distances of points from a solid [m], positive outside.

    Args:
        solid: A record of `solids.SOLID`.
        points: World frame [m], shape (..., 3).
    """
    own = (points - solid["centre"]) @ np.asarray(solid["axes"]).T
    kind, size = int(solid["kind"]), np.asarray(solid["size"])
    if kind == PLANE:
        plane: Floats = own[..., 2]
        return plane
    if kind == FIELD:
        field = np.empty(own.shape[:-1])
        field_distances(solid, own.reshape(-1, 3), field.reshape(-1))
        return field
    if kind == BOX:
        away = np.abs(own) - size
        box: Floats = np.linalg.norm(np.maximum(away, 0.0), axis=-1) + np.minimum(away.max(axis=-1), 0.0)
        return box
    radial = np.hypot(own[..., 0], own[..., 1])
    if kind == TUBE:
        hole: Floats = size[0] - radial
        return hole
    beyond = np.abs(own[..., 2]) - size[1]
    if kind == BAR:
        bar: Floats = np.hypot(radial, np.maximum(beyond, 0.0)) - size[0]
        return bar
    both = np.stack((radial - size[0], beyond), axis=-1)
    cylinder: Floats = np.linalg.norm(np.maximum(both, 0.0), axis=-1) + np.minimum(both.max(axis=-1), 0.0)
    return cylinder
