"""Gaps between links as capsules, and between links and the base's box."""

import math

from ....compiled import kernel
from ....planning.problem.check import UNLIMITED
from .records import BESIDE, FIXED

SHORTEST = 1e-14
"""Square of a segment that counts as a point [m^2]."""
NARROWINGS = 24
"""Steps of the golden section that finds the nearest point of a segment to a box: a 1e-5th of the segment."""
GOLDEN = 0.6180339887498949


@kernel
def segment_gap(a, b, c, d):
    """Distance of the segments a-b and c-d [m] (Ericson, Real-Time Collision Detection, 5.1.9)."""
    u0, u1, u2 = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    v0, v1, v2 = d[0] - c[0], d[1] - c[1], d[2] - c[2]
    w0, w1, w2 = a[0] - c[0], a[1] - c[1], a[2] - c[2]
    uu, uv, vv = u0 * u0 + u1 * u1 + u2 * u2, u0 * v0 + u1 * v1 + u2 * v2, v0 * v0 + v1 * v1 + v2 * v2
    uw, vw = u0 * w0 + u1 * w1 + u2 * w2, v0 * w0 + v1 * w1 + v2 * w2
    s, t = 0.0, 0.0
    if vv <= SHORTEST:
        s = min(1.0, max(0.0, -uw / uu)) if uu > SHORTEST else 0.0
    else:
        if uu > SHORTEST:
            parallel = uu * vv - uv * uv
            if parallel > SHORTEST * uu * vv:
                s = min(1.0, max(0.0, (uv * vw - vv * uw) / parallel))
        t = (uv * s + vw) / vv
        if t < 0.0 or t > 1.0:
            t = min(1.0, max(0.0, t))
            s = min(1.0, max(0.0, (uv * t - uw) / uu)) if uu > SHORTEST else 0.0
    x, y, z = w0 + s * u0 - t * v0, w1 + s * u1 - t * v1, w2 + s * u2 - t * v2
    return math.sqrt(x * x + y * y + z * z)


@kernel
def box_distance(a, b, t, half):
    """Distance of a point of the segment a-b from a box about the origin [m]; inside, minus the way out."""
    x = abs(a[0] + t * (b[0] - a[0])) - half[0]
    y = abs(a[1] + t * (b[1] - a[1])) - half[1]
    z = abs(a[2] + t * (b[2] - a[2])) - half[2]
    outer = math.sqrt(max(x, 0.0) ** 2 + max(y, 0.0) ** 2 + max(z, 0.0) ** 2)
    return outer + min(max(x, y, z), 0.0)


@kernel
def box_gap(a, b, half):
    """Distance of the segment a-b from a box about the origin [m], negative inside: the distance is convex along the segment."""
    low, high = 0.0, 1.0
    t0, t1 = 1.0 - GOLDEN, GOLDEN
    f0, f1 = box_distance(a, b, t0, half), box_distance(a, b, t1, half)
    best = min(box_distance(a, b, 0.0, half), box_distance(a, b, 1.0, half))
    for _ in range(NARROWINGS):
        if f0 < f1:
            high = t1
            t1, f1 = t0, f0
            t0 = high - GOLDEN * (high - low)
            f0 = box_distance(a, b, t0, half)
        else:
            low = t0
            t0, f0 = t1, f1
            t1 = low + GOLDEN * (high - low)
            f1 = box_distance(a, b, t1, half)
    return min(best, f0, f1)


@kernel
def pair_gap(robot, i, j, p, q):
    """Smallest gap between links of the limbs i and j, whose joints are at p and q [m]; first links lie side by side and are left out."""
    gap = UNLIMITED
    for k in range(BESIDE, robot.n_joints[i]):
        for h in range(BESIDE, robot.n_joints[j]):
            between = segment_gap(p[k], p[k + 1], q[h], q[h + 1])
            gap = min(gap, between - robot.radius[i, k] - robot.radius[j, h])
    return gap


@kernel
def boxes_apart(robot, i, j, p, q):
    """Distance that the boxes about two limbs' links keep, along the axes of the frame of their joints p and q, less the links' radii [m].

    No link of the one is nearer to one of the other.
    """
    square, thick, other = 0.0, 0.0, 0.0
    for a in range(3):
        low, high = math.inf, -math.inf
        for k in range(BESIDE, robot.n_joints[i] + 1):
            low, high = min(low, p[k, a]), max(high, p[k, a])
        under, over = math.inf, -math.inf
        for h in range(BESIDE, robot.n_joints[j] + 1):
            under, over = min(under, q[h, a]), max(over, q[h, a])
        away = max(0.0, under - high, low - over)
        square += away * away
    for k in range(BESIDE, robot.n_joints[i]):
        thick = max(thick, robot.radius[i, k])
    for h in range(BESIDE, robot.n_joints[j]):
        other = max(other, robot.radius[j, h])
    return math.sqrt(square) - thick - other


@kernel
def limbs_gap(robot, origin, only, gap):
    """Smallest gap between links of different limbs, or of one of them and all others, if less than `gap` [m].

    Args:
        robot: Record of `ROBOT`.
        origin: Of all limbs' joints.
        only: Limb whose links alone are held against the others', -1: all.
        gap: What is returned where nothing is nearer.
    """
    for i in range(robot.n_limbs):
        for j in range(i):
            if (only < 0 or only in (i, j)) and boxes_apart(robot, i, j, origin[i], origin[j]) < gap:
                gap = min(gap, pair_gap(robot, i, j, origin[i], origin[j]))
    return gap


@kernel
def limb_body_gap(robot, i, p, gap):
    """Smallest gap between the base's box and the links of limb i, whose joints are at p, if less than `gap` [m].

    The first links, which are fixed to the base and beside it, are left out.
    """
    half = robot.base_half
    for k in range(FIXED, robot.n_joints[i]):
        a, b = p[k], p[k + 1]
        if gap < UNLIMITED:  # two spheres first: most links are far away
            reach = math.sqrt((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2 + (b[2] - a[2]) ** 2)
            if box_distance(a, b, 0.0, half) - reach - robot.radius[i, k] > gap:
                continue
        gap = min(gap, box_gap(a, b, half) - robot.radius[i, k])
    return gap


@kernel
def body_gap(robot, origin, only, gap):
    """Smallest gap between the base's box and links, whose joints are at `origin`, or those of one limb, if less than `gap` [m]."""
    for i in range(robot.n_limbs):
        if only < 0 or only == i:
            gap = limb_body_gap(robot, i, origin[i], gap)
    return gap
