"""Signed distances of points from the solid things of a world, and the grids of distances of terrains."""

import math

import numpy as np

from ....compiled import carray, inlined, kernel, pointer
from .solids import BAR, BOX, FIELD, PLANE, TUBE


@kernel
def field_distance(solid, a, b, c):
    """Distance from a terrain at a place of its grid's frame [m]: linear between nodes; beyond the grid that of its edge and on."""
    grain = solid.size[0]
    nx, ny, nz = solid.nodes[0], solid.nodes[1], solid.nodes[2]
    nodes = carray(pointer(solid.nodes_at), (nx, ny, nz), np.float32)
    u = min(max(a / grain, 0.0), nx - 1.0)
    v = min(max(b / grain, 0.0), ny - 1.0)
    w = min(max(c / grain, 0.0), nz - 1.0)
    i, j, k = min(int(u), nx - 2), min(int(v), ny - 2), min(int(w), nz - 2)
    beyond = grain * math.sqrt((a / grain - u) ** 2 + (b / grain - v) ** 2 + (c / grain - w) ** 2)
    u, v, w = u - i, v - j, w - k
    near = 0.0
    for corner in range(8):
        p, q, r = corner & 1, corner >> 1 & 1, corner >> 2
        share = (u if p else 1.0 - u) * (v if q else 1.0 - v) * (w if r else 1.0 - w)
        near += share * nodes[i + p, j + q, k + r]
    return near + beyond if near > 0.0 else near


@kernel
def field_distances(solid, points, to):
    """Write the distances of points of a grid's frame, shape (n, 3), from its terrain [m]."""
    for n in range(points.shape[0]):
        to[n] = field_distance(solid, points[n, 0], points[n, 1], points[n, 2])


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
    if solid.kind == FIELD:
        return field_distance(solid, a, b, c)
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


@inlined
def nearest_on(corners, x, y, z, at):
    """Write the place of a triangle that is nearest a point (Ericson, Real-Time Collision Detection, 5.1.5)."""
    ax, ay, az = corners[0, 0], corners[0, 1], corners[0, 2]
    bx, by, bz = corners[1, 0] - ax, corners[1, 1] - ay, corners[1, 2] - az
    cx, cy, cz = corners[2, 0] - ax, corners[2, 1] - ay, corners[2, 2] - az
    px, py, pz = x - ax, y - ay, z - az
    d1, d2 = bx * px + by * py + bz * pz, cx * px + cy * py + cz * pz
    bb, bc, cc = bx * bx + by * by + bz * bz, bx * cx + by * cy + bz * cz, cx * cx + cy * cy + cz * cz
    d3, d4, d5, d6 = d1 - bb, d2 - bc, d1 - bc, d2 - cc
    u, v = 0.0, 0.0
    va, vb, vc = d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
    if d1 <= 0.0 and d2 <= 0.0:
        u, v = 0.0, 0.0
    elif d3 >= 0.0 and d4 <= d3:
        u, v = 1.0, 0.0
    elif d6 >= 0.0 and d5 <= d6:
        u, v = 0.0, 1.0
    elif vc <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
        u, v = d1 / (d1 - d3), 0.0
    elif vb <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
        u, v = 0.0, d2 / (d2 - d6)
    elif va <= 0.0 and d4 - d3 >= 0.0 and d5 - d6 >= 0.0:
        v = (d4 - d3) / ((d4 - d3) + (d5 - d6))
        u = 1.0 - v
    else:
        total = va + vb + vc
        u, v = vb / total, vc / total
    at[0] = ax + u * bx + v * cx
    at[1] = ay + u * by + v * cy
    at[2] = az + u * bz + v * cz


@kernel
def near_distances(triangles, normals, low, grain, band, values, feet):
    """Write signed distances from triangles at the nodes of a grid that are near one.

    Where an edge or a corner is nearest, the triangle that faces the node most gives the sign.

    Args:
        triangles: Corners, in the grid's frame [m], shape (n, 3, 3).
        normals: Shape (n, 3).
        low: First node [m], shape (3,).
        grain: Distance of nodes [m].
        band: Nodes up to this far from a triangle's box are looked at [m].
        values: Output: infinite at first; left so where no triangle is near, shape (nx, ny, nz).
        feet: Output: the nearest place of the surface, shape (nx, ny, nz, 3).
    """
    facing = np.zeros(values.shape)
    at = np.zeros(3)
    first, last = np.zeros(3, np.int64), np.zeros(3, np.int64)
    for t in range(triangles.shape[0]):
        corners = triangles[t]
        for k in range(3):
            least = min(corners[0, k], min(corners[1, k], corners[2, k])) - band
            most = max(corners[0, k], max(corners[1, k], corners[2, k])) + band
            first[k] = max(0, int(math.ceil((least - low[k]) / grain)))
            last[k] = min(values.shape[k] - 1, int(math.floor((most - low[k]) / grain)))
        for i in range(first[0], last[0] + 1):
            x = low[0] + grain * i
            for j in range(first[1], last[1] + 1):
                y = low[1] + grain * j
                for k in range(first[2], last[2] + 1):
                    z = low[2] + grain * k
                    nearest_on(corners, x, y, z, at)
                    dx, dy, dz = x - at[0], y - at[1], z - at[2]
                    away = math.sqrt(dx * dx + dy * dy + dz * dz)
                    if away > abs(values[i, j, k]) + 1e-9:
                        continue
                    over = dx * normals[t, 0] + dy * normals[t, 1] + dz * normals[t, 2]
                    turned = abs(over) / away if away > 1e-12 else 1.0
                    if away < abs(values[i, j, k]) - 1e-9 or turned > facing[i, j, k]:
                        values[i, j, k] = away if over >= 0.0 else -away
                        facing[i, j, k] = turned
                        for m in range(3):
                            feet[i, j, k, m] = at[m]


@kernel
def spread_distances(low, grain, values, feet):
    """Give nodes that are far from every triangle the nearest of the places that their neighbours have; sweeps along all diagonals.

    Args:
        low: First node [m], shape (3,).
        grain: Distance of nodes [m].
        values: Signed distances, infinite where none is known yet [m], shape (nx, ny, nz); all are known afterwards.
        feet: Nearest places of the surface, shape (nx, ny, nz, 3).
    """
    nx, ny, nz = values.shape
    for sweep in range(16):
        sx, sy, sz = 1 - 2 * (sweep & 1), 1 - (sweep & 2), 1 - (sweep >> 1 & 2)
        for i in range(nx):
            x = i if sx > 0 else nx - 1 - i
            for j in range(ny):
                y = j if sy > 0 else ny - 1 - j
                for k in range(nz):
                    z = k if sz > 0 else nz - 1 - k
                    for step in range(1, 8):
                        u, v, w = x - sx * (step & 1), y - sy * (step >> 1 & 1), z - sz * (step >> 2)
                        if u < 0 or v < 0 or w < 0 or u >= nx or v >= ny or w >= nz or math.isinf(values[u, v, w]):
                            continue
                        dx = low[0] + grain * x - feet[u, v, w, 0]
                        dy = low[1] + grain * y - feet[u, v, w, 1]
                        dz = low[2] + grain * z - feet[u, v, w, 2]
                        away = math.sqrt(dx * dx + dy * dy + dz * dz)
                        if away < abs(values[x, y, z]) - 1e-6:
                            known = not math.isinf(values[x, y, z])
                            sign = values[x, y, z] if known else values[u, v, w]
                            values[x, y, z] = away if sign >= 0.0 else -away
                            for m in range(3):
                                feet[x, y, z, m] = feet[u, v, w, m]
