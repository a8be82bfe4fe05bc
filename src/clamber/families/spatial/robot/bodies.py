"""What can be said of rigid bodies by themselves: shapes as points and a radius, rotations, and which inertias a body can have."""

from typing import Final

import numpy as np

from ....types import Floats

ROUND: Final = 16
"""Points on each rim of a cylinder."""
DIRECTIONS: Final = 64
"""A mesh is told by its outermost points in so many directions."""


def shape_points(kind: str, size: Floats, box: Floats, vertices: Floats) -> tuple[Floats, float]:
    """Points of a shape in its own frame [m], shape (n, 3), and the radius by which their hull is blown up [m].

    Args:
        kind: As MuJoCo calls it, such as "capsule".
        size: What that kind is stated by [m].
        box: Centre and half extents of the box around it [m].
        vertices: Of a mesh [m], shape (n, 3).
    """
    if kind == "mesh":
        return _outermost(vertices), 0.0
    if kind == "sphere":
        return np.zeros((1, 3)), float(size[0])
    if kind == "capsule":
        return np.array([[0.0, 0.0, size[1]], [0.0, 0.0, -size[1]]]), float(size[0])
    if kind == "cylinder":
        angles = np.arange(ROUND) * (2 * np.pi / ROUND)
        rim = np.stack([size[0] * np.cos(angles), size[0] * np.sin(angles)], 1)
        return np.concatenate([np.insert(rim, 2, end, 1) for end in (-size[1], size[1])]), 0.0
    if kind == "ellipsoid":
        return np.concatenate([np.diag(size), -np.diag(size)]), 0.0
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    return box[:3] + corners * box[3:], 0.0


def _outermost(points: Floats) -> Floats:
    """The points that lie farthest in many directions, shape (n, 3)."""
    k = np.arange(DIRECTIONS) + 0.5
    z, around = 1.0 - 2.0 * k / DIRECTIONS, np.pi * (1.0 + np.sqrt(5.0)) * k
    level = np.sqrt(1.0 - z * z)
    directions = np.stack([level * np.cos(around), level * np.sin(around), z], 1)
    farthest: Floats = points[np.unique(np.argmax(points @ directions.T, axis=0))]
    return farthest


def rotation(quaternion: Floats) -> Floats:
    """Rotation of a unit quaternion w, x, y, z, shape (3, 3)."""
    w, x, y, z = quaternion
    turned: Floats = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
    return turned


def symmetric(six: Floats) -> Floats:
    """The matrix of xx, yy, zz, xy, xz, yz."""
    xx, yy, zz, xy, xz, yz = six
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def is_of_a_body(inertia: Floats) -> bool:
    """Whether a body can have this inertia: no principal moment is negative, or above the sum of the others."""
    least, middle, most = np.linalg.eigvalsh(inertia)
    slack = 1e-6 * abs(most)
    return bool(least >= -slack and least + middle >= most - slack)
