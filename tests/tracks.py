"""Tracks of walkers that only tests walk."""

import numpy as np

from clamber.families.walker.control.track import Track
from clamber.families.walker.robot.plane_poses import seen_from
from clamber.types import Floats


def turn_about(start: Floats, centre: Floats, angle: float, radius: float) -> Track:
    """A turn by an angle [rad] about a point of the world, shape (2,) [m]."""
    offset = seen_from(start, np.array((centre[0], centre[1], start[2])))
    return Track.of(start, [angle * np.array((offset[1], -offset[0], 1.0))], radius)
