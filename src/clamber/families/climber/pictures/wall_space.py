"""Where the plane of a wall is in the viewer's space: x to the right, y up, and depth out of the wall towards the viewer."""

import math
from typing import Final

import numpy as np

from ....types import Floats

TURN: Final = (math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0)
"""Quaternion w, x, y, z that lifts what lies in the plane z = 0 onto the wall: its z points out of it."""


def in_space(points: Floats, depth: Floats | float) -> Floats:
    """Points of the wall, shape (..., 2) [m], some way in front of it [m]: shape (..., 3)."""
    deep = np.broadcast_to(-np.asarray(depth, dtype=np.float64), points.shape[:-1])
    return np.stack((points[..., 0], deep, points[..., 1]), axis=-1)


def on_wall(point: Floats) -> tuple[float, float]:
    """Where on the wall a point in space is, x and y, shape (3,) [m]."""
    return float(point[0]), float(point[2])


def turned(angle: float) -> tuple[float, float, float, float]:
    """Quaternion w, x, y, z of a body that is turned on the wall [rad], anticlockwise, and stands out of it."""
    c, s = math.cos(0.5 * angle), math.sin(0.5 * angle)
    w, x = TURN[0], TURN[1]
    return w * c, x * c, -x * s, w * s
