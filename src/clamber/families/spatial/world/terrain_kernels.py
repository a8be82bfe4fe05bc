"""Signed distances of points from the solid things of a world."""

import math

from ....compiled import inlined, kernel
from .solids import BAR, BOX, PLANE, TUBE


@inlined
def distance_to(solid, x, y, z):
    """Signed distance of a point from one solid [m], positive outside; inside a box or cylinder that to the nearest face."""
    dx = x - solid.centre[0]
    dy = y - solid.centre[1]
    dz = z - solid.centre[2]
    axes = solid.axes
    a = axes[0, 0] * dx + axes[0, 1] * dy + axes[0, 2] * dz
    b = axes[1, 0] * dx + axes[1, 1] * dy + axes[1, 2] * dz
    c = axes[2, 0] * dx + axes[2, 1] * dy + axes[2, 2] * dz
    if solid.kind == PLANE:
        return c
    size = solid.size
    if solid.kind == BOX:
        a = abs(a) - size[0]
        b = abs(b) - size[1]
        c = abs(c) - size[2]
        out = math.sqrt(max(a, 0.0) ** 2 + max(b, 0.0) ** 2 + max(c, 0.0) ** 2)
        return out + min(max(a, max(b, c)), 0.0)
    radial = math.sqrt(a * a + b * b)
    if solid.kind == TUBE:
        return size[0] - radial
    beyond = abs(c) - size[1]
    if solid.kind == BAR:
        return math.sqrt(radial * radial + max(beyond, 0.0) ** 2) - size[0]
    aside = radial - size[0]
    return math.sqrt(max(aside, 0.0) ** 2 + max(beyond, 0.0) ** 2) + min(max(aside, beyond), 0.0)


@kernel
def terrain_distance(solids, x, y, z):
    """Signed distance of a point from the nearest of many solids [m]: an array of `SOLID`; 1e9 where there is none."""
    near = 1.0e9
    for k in range(solids.shape[0]):
        near = min(near, distance_to(solids[k], x, y, z))
    return near
