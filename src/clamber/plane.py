"""Angles, points, segments and polygons of a plane, as kernels: distances [m] (page "The model", section 9) and wrapped angles [rad]."""

import math

from .compiled import inlined, kernel

TWO_PI = 2.0 * math.pi


@inlined
def wrap(angle):
    """`angle` brought into (-pi, pi] [rad]."""
    return angle - TWO_PI * math.ceil((angle - math.pi) / TWO_PI)


@kernel
def point_segment(px, py, ax, ay, bx, by):
    """Distance of a point from a segment [m]."""
    dx = bx - ax
    dy = by - ay
    square = dx * dx + dy * dy
    t = 0.0
    if square > 0.0:
        t = ((px - ax) * dx + (py - ay) * dy) / square
        t = min(1.0, max(0.0, t))
    ex = px - ax - t * dx
    ey = py - ay - t * dy
    return math.sqrt(ex * ex + ey * ey)


@inlined
def edge_distance(x, y, polygon):
    """Distance of a point from the nearest edge of a polygon, shape (n, 2) [m]."""
    near = math.inf
    j = polygon.shape[0] - 1
    for i in range(polygon.shape[0]):
        near = min(near, point_segment(x, y, polygon[j, 0], polygon[j, 1], polygon[i, 0], polygon[i, 1]))
        j = i
    return near


@kernel
def segment_segment(ax, ay, bx, by, cx, cy, dx, dy):
    """Distance of two segments [m]; 0 if they touch or cross."""
    ux = bx - ax
    uy = by - ay
    vx = dx - cx
    vy = dy - cy
    side_c = ux * (cy - ay) - uy * (cx - ax)
    side_d = ux * (dy - ay) - uy * (dx - ax)
    side_a = vx * (ay - cy) - vy * (ax - cx)
    side_b = vx * (by - cy) - vy * (bx - cx)
    if side_c * side_d < 0.0 and side_a * side_b < 0.0:
        return 0.0
    near = min(point_segment(ax, ay, cx, cy, dx, dy), point_segment(bx, by, cx, cy, dx, dy))
    return min(near, min(point_segment(cx, cy, ax, ay, bx, by), point_segment(dx, dy, ax, ay, bx, by)))


@kernel
def inside(px, py, polygon):
    """Whether a point lies inside a simple polygon, shape (n, 2) (even-odd rule; the edge itself is the distance's business)."""
    odd = False
    n = polygon.shape[0]
    j = n - 1
    for i in range(n):
        if (polygon[i, 1] > py) != (polygon[j, 1] > py):
            at = polygon[j, 0] + (py - polygon[j, 1]) * (polygon[i, 0] - polygon[j, 0]) / (
                polygon[i, 1] - polygon[j, 1]
            )
            if px < at:
                odd = not odd
        j = i
    return odd


@kernel
def segment_polygon(ax, ay, bx, by, polygon):
    """Distance of a segment from a polygon with its inside [m]."""
    if polygon.shape[0] > 2 and inside(ax, ay, polygon):
        return 0.0
    near = math.inf
    j = polygon.shape[0] - 1
    for i in range(polygon.shape[0]):
        near = min(near, segment_segment(ax, ay, bx, by, polygon[j, 0], polygon[j, 1], polygon[i, 0], polygon[i, 1]))
        j = i
    return near


@kernel
def polygon_polygon(first, second):
    """Distance of two polygons with their insides [m]."""
    if second.shape[0] > 2 and inside(first[0, 0], first[0, 1], second):
        return 0.0
    if first.shape[0] > 2 and inside(second[0, 0], second[0, 1], first):
        return 0.0
    near = math.inf
    j = first.shape[0] - 1
    for i in range(first.shape[0]):
        near = min(near, segment_polygon(first[j, 0], first[j, 1], first[i, 0], first[i, 1], second))
        j = i
    return near
