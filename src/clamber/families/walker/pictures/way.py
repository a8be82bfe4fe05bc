"""Where a walk's way leads, seen from above."""

from typing import Final

import numpy as np

from ....types import Floats
from ..control.track import Track, straight
from ..planning import Walk
from ..trials.run_walk import lay_track

BEYOND: Final = 0.5
"""So far behind a ditch both frames have crossed it, for a picture [m]."""
PLACES: Final = 60
"""Along a way that is drawn."""


def way_poses(walk: Walk) -> Floats:
    """Poses of the Delta-frame along a walk's way: x, y [m], heading [rad], shape (n, 3).

    Raises:
        ClamberError: If there is no way to one of its places.
    """
    start = walk.start
    track = _track(walk, np.array((start.x, start.y, start.heading)))
    return np.array([track.pose(way) for way in np.linspace(0.0, track.length, PLACES)])


def _track(walk: Walk, pose: Floats) -> Track:
    first = walk.way[0]
    if first.ditch is None or first.ahead is None:
        return lay_track(walk, pose)
    whole = first.ahead + first.ditch + BEYOND
    return straight(pose, first.along or 0.0, whole, walk.robot.legs.radius_delta)
