"""Poses in the plane, x, y [m] and heading [rad], and what is fixed to a frame that has one."""

import math
from collections.abc import Sequence

import numpy as np

from ....types import Floats


def compose(a: Floats, b: Floats) -> Floats:
    """Pose `b`, given in `a`, in the frame that `a` is given in; shapes (..., 3)."""
    c, s = np.cos(a[..., 2]), np.sin(a[..., 2])
    x, y = b[..., 0], b[..., 1]
    return np.stack([a[..., 0] + c * x - s * y, a[..., 1] + s * x + c * y, a[..., 2] + b[..., 2]], axis=-1)


def seen_from(a: Floats, b: Floats) -> Floats:
    """Pose `b` as seen from `a`, both given in one frame; shapes (..., 3)."""
    c, s = np.cos(a[..., 2]), np.sin(a[..., 2])
    x, y = b[..., 0] - a[..., 0], b[..., 1] - a[..., 1]
    return np.stack([c * x + s * y, c * y - s * x, b[..., 2] - a[..., 2]], axis=-1)


def placed(points: Floats, pose: Floats | Sequence[float]) -> Floats:
    """Points of a frame at a pose, shape (3,), in the frame that the pose is given in; shapes (..., 2) [m]."""
    c, s = math.cos(pose[2]), math.sin(pose[2])
    out: Floats = points @ np.array(((c, s), (-s, c))) + pose[:2]
    return out
