"""Kernels of circles, lines and conics that bound plane regions: points on them, their crossings, and those of a walker's reach.

A region is what satisfies every one of its curves. A row of `curves` is its kind and seven numbers, zero where not used:

- INSIDE or OUTSIDE a circle: x, y of its centre, radius. Its parameter is the angle [rad].
- BELOW a line: n_x, n_y, c, for n . p <= c with |n| = 1. Its parameter is the distance from c n along n turned by a right angle [m].
- ELLIPSE: x, y of its centre, semiaxes a and b, direction u of the first one, +1 for its inside, -1 for its outside. With v to the left
  of u its points are a cos t u + b sin t v off the centre.
- BRANCH of a hyperbola, likewise with a cosh t u + b sinh t v, a > 0 for one branch and a < 0 for the other; both are given, next to each
  other. +1 is for the two convex sides, -1 for what is between.
"""

import math

import numpy as np

from ....compiled import inlined, kernel
from .two_frames import singular_measure

INSIDE, OUTSIDE, BELOW, ELLIPSE, BRANCH = 0.0, 1.0, 2.0, 3.0, 4.0
CURVE_NUMBERS = 8
MOST_CURVES = 16
SAME = 1e-12
"""Curves that differ by less in every number are one; shorter arcs are none [m], [rad]."""
TURN = 2.0 * math.pi


@inlined
def local_x(curves, i, x, y):
    """A point along the first axis of conic i, from its centre [m]."""
    return (x - curves[i, 1]) * curves[i, 5] + (y - curves[i, 2]) * curves[i, 6]


@inlined
def local_y(curves, i, x, y):
    """A point along the second axis of conic i, from its centre [m]."""
    return (y - curves[i, 2]) * curves[i, 5] - (x - curves[i, 1]) * curves[i, 6]


@kernel
def point(curves, i, t):
    """The point at parameter t of curve i [m]."""
    if curves[i, 0] == BELOW:
        return (
            curves[i, 3] * curves[i, 1] - t * curves[i, 2],
            curves[i, 3] * curves[i, 2] + t * curves[i, 1],
        )
    if curves[i, 0] == ELLIPSE or curves[i, 0] == BRANCH:
        if curves[i, 0] == ELLIPSE:
            along = curves[i, 3] * math.cos(t)
            across = curves[i, 4] * math.sin(t)
        else:
            along = curves[i, 3] * math.cosh(t)
            across = curves[i, 4] * math.sinh(t)
        return (
            curves[i, 1] + along * curves[i, 5] - across * curves[i, 6],
            curves[i, 2] + along * curves[i, 6] + across * curves[i, 5],
        )
    return curves[i, 1] + curves[i, 3] * math.cos(t), curves[i, 2] + curves[i, 3] * math.sin(t)


@inlined
def conic_value(curves, i, x, y):
    """Positive on the region's side of conic i, zero on it [-]."""
    along = local_x(curves, i, x, y) / curves[i, 3]
    across = local_y(curves, i, x, y) / curves[i, 4]
    if curves[i, 0] == ELLIPSE:
        return curves[i, 7] * (1.0 - along * along - across * across)
    return curves[i, 7] * (along * along - across * across - 1.0)


@kernel
def clearance(curves, i, x, y):
    """Signed distance of a point from curve i, positive on the region's side [m]; for a conic to first order near it."""
    if curves[i, 0] == BELOW:
        return curves[i, 3] - curves[i, 1] * x - curves[i, 2] * y
    if curves[i, 0] == ELLIPSE or curves[i, 0] == BRANCH:
        a = curves[i, 3]
        b = curves[i, 4]
        slope = 2.0 * math.hypot(local_x(curves, i, x, y) / (a * a), local_y(curves, i, x, y) / (b * b))
        return conic_value(curves, i, x, y) / max(slope, 1.0 / max(abs(a), b))
    apart = math.hypot(x - curves[i, 1], y - curves[i, 2])
    return curves[i, 3] - apart if curves[i, 0] == INSIDE else apart - curves[i, 3]


@kernel
def depth(curves, n, x, y):
    """Least signed distance of a point from the curves: positive inside the region [m]."""
    least = math.inf
    for i in range(n):
        least = min(least, clearance(curves, i, x, y))
    return least


@inlined
def is_same(curves, i, j):
    """Whether two curves are one, or branches of one hyperbola, so that one says nothing of the other's points."""
    off = 0.0
    for k in range(1, CURVE_NUMBERS):
        size = curves[j, k] - curves[i, k]
        if k == 3 and curves[i, 0] == BRANCH:
            size = abs(curves[j, k]) - abs(curves[i, k])
        off = max(off, abs(size))
    return curves[i, 0] == curves[j, 0] and off < SAME


@inlined
def is_repeated(curves, i):
    """Whether curve i stands before, too."""
    repeated = False
    for j in range(i):
        repeated |= is_same(curves, i, j) and curves[i, 3] * curves[j, 3] >= 0.0
    return repeated


@kernel
def line_conic(curves, j, x, y, dx, dy, at):
    """Write where conic j cuts the line from a point along a unit direction [m]; return how often."""
    ax = local_x(curves, j, x, y) / curves[j, 3]
    ay = local_y(curves, j, x, y) / curves[j, 4]
    bx = (dx * curves[j, 5] + dy * curves[j, 6]) / curves[j, 3]
    by = (dy * curves[j, 5] - dx * curves[j, 6]) / curves[j, 4]
    sign = 1.0 if curves[j, 0] == ELLIPSE else -1.0
    square = bx * bx + sign * by * by
    half = ax * bx + sign * ay * by
    rest = ax * ax + sign * ay * ay - 1.0
    if abs(square) * max(abs(half), abs(rest)) < 1e-300 or abs(square) < 1e-12 * (bx * bx + by * by):
        if half == 0.0:
            return 0
        at[0] = -0.5 * rest / half
        return 1
    under = half * half - square * rest
    if under <= 0.0:
        return 0
    root = -half - math.copysign(math.sqrt(under), half)
    at[0] = root / square
    at[1] = rest / root if root != 0.0 else 0.0
    return 2


@kernel
def circle_conic(curves, i, j, at):
    """Write the angles on circle i where conic j cuts it; return how many there are.

    The conic along the circle is trigonometric of degree two, so its zeros are the roots of size one of a quartic in e^(i t).
    """
    x = local_x(curves, j, curves[i, 1], curves[i, 2])
    y = local_y(curves, j, curves[i, 1], curves[i, 2])
    r = curves[i, 3]
    p = 1.0 / (curves[j, 3] * curves[j, 3])
    q = 1.0 / (curves[j, 4] * curves[j, 4])
    if curves[j, 0] == BRANCH:
        q = -q
    turn = math.atan2(curves[j, 6], curves[j, 5])
    quartic = np.empty(5, np.complex128)
    quartic[0] = 0.25 * r * r * (p - q)
    quartic[1] = r * (p * x - 1j * q * y)
    quartic[2] = p * x * x + q * y * y - 1.0 + 0.5 * r * r * (p + q)
    quartic[3] = quartic[1].conjugate()
    quartic[4] = quartic[0]
    size = abs(quartic[1]) + abs(quartic[2])
    if abs(quartic[0]) < 1e-14 * size:
        if abs(quartic[1]) < 1e-14 * size:
            return 0
        roots = np.roots(quartic[1:4])
    else:
        roots = np.roots(quartic)
    count = 0
    for root in roots:
        if abs(abs(root) - 1.0) > 1e-6:
            continue
        t = math.atan2(root.imag, root.real)
        for _ in range(3):
            c = math.cos(t)
            s = math.sin(t)
            value = p * (x + r * c) * (x + r * c) + q * (y + r * s) * (y + r * s) - 1.0
            slope = 2.0 * r * (q * (y + r * s) * c - p * (x + r * c) * s)
            if abs(value) < 0.1 * abs(slope):
                t -= value / slope
        at[count] = t + turn
        count += 1
    return count


@inlined
def conic_parameter(curves, i, x, y):
    """Parameter of conic i at a point of it; nan if that is on a hyperbola's other branch."""
    along = local_x(curves, i, x, y)
    across = local_y(curves, i, x, y)
    if curves[i, 0] == ELLIPSE:
        return math.atan2(across / curves[i, 4], along / curves[i, 3])
    if along * curves[i, 3] < 0.0:
        return math.nan
    return math.asinh(across / curves[i, 4])


@kernel
def crossings(curves, i, j, at):
    """Write the parameters on curve i where it crosses curve j, shape (4,); return how many there are. Two conics are never both given."""
    conic_i = curves[i, 0] == ELLIPSE or curves[i, 0] == BRANCH
    conic_j = curves[j, 0] == ELLIPSE or curves[j, 0] == BRANCH
    if conic_i:
        if conic_j:
            return 0
        if curves[j, 0] == BELOW:
            x, y = point(curves, j, 0.0)
            found = line_conic(curves, i, x, y, -curves[j, 2], curves[j, 1], at)
        else:
            found = circle_conic(curves, j, i, at) if curves[j, 3] > 0.0 else 0
        count = 0
        for k in range(found):
            x, y = point(curves, j, at[k])
            t = conic_parameter(curves, i, x, y)
            if not math.isnan(t):
                at[count] = t
                count += 1
        return count
    if curves[i, 0] == BELOW:
        x, y = curves[i, 3] * curves[i, 1], curves[i, 3] * curves[i, 2]
        dx, dy = -curves[i, 2], curves[i, 1]
        if curves[j, 0] == BELOW:
            turn = curves[j, 1] * dx + curves[j, 2] * dy
            if abs(turn) < SAME:
                return 0
            at[0] = (curves[j, 3] - curves[j, 1] * x - curves[j, 2] * y) / turn
            return 1
        if conic_j:
            return line_conic(curves, j, x, y, dx, dy, at)
        along = (curves[j, 1] - x) * dx + (curves[j, 2] - y) * dy
        off = (curves[j, 1] - x) * dy - (curves[j, 2] - y) * dx
        half = curves[j, 3] * curves[j, 3] - off * off
        if half <= 0.0:
            return 0
        at[0] = along - math.sqrt(half)
        at[1] = along + math.sqrt(half)
        return 2
    radius = curves[i, 3]
    if radius <= 0.0:
        return 0
    if conic_j:
        return circle_conic(curves, i, j, at)
    if curves[j, 0] == BELOW:
        towards = math.atan2(curves[j, 2], curves[j, 1])
        cosine = (curves[j, 3] - curves[j, 1] * curves[i, 1] - curves[j, 2] * curves[i, 2]) / radius
    else:
        dx, dy = curves[j, 1] - curves[i, 1], curves[j, 2] - curves[i, 2]
        square = dx * dx + dy * dy
        if square <= SAME * SAME:
            return 0
        towards = math.atan2(dy, dx)
        cosine = (square + radius * radius - curves[j, 3] * curves[j, 3]) / (2.0 * radius * math.sqrt(square))
    if abs(cosine) >= 1.0:
        return 0
    at[0] = towards - math.acos(cosine)
    at[1] = towards + math.acos(cosine)
    return 2


@inlined
def runs_back(curves, i):
    """Whether the region is to the left of curve i where its parameter falls."""
    if curves[i, 0] == BRANCH:
        return curves[i, 3] * curves[i, 7] > 0.0
    return curves[i, 0] == OUTSIDE or (curves[i, 0] == ELLIPSE and curves[i, 7] < 0.0)


@kernel
def reach_curves(delta, y, theta, shortest, longest, guard, curves):
    """Write the curves of all places p of the Y-frame at one angle: three rings of the actuators, and the guard; return how many.

    Args:
        delta, y: Attachments, shape (3, 2) [m].
        theta: Angle of the Y-frame in the Delta-frame [rad].
        shortest, longest: Lengths of the actuators [m].
        guard: Largest nearness of a singular pose [-]; 0 for no such limit.
        curves: Written, shape (MOST_CURVES, CURVE_NUMBERS).
    """
    c = math.cos(theta)
    s = math.sin(theta)
    curves[:] = 0.0
    for i in range(3):
        for k in range(2):
            curves[2 * i + k, 0] = INSIDE if k == 0 else OUTSIDE
            curves[2 * i + k, 1] = delta[i, 0] - c * y[i, 0] + s * y[i, 1]
            curves[2 * i + k, 2] = delta[i, 1] - s * y[i, 0] - c * y[i, 1]
            curves[2 * i + k, 3] = longest if k == 0 else shortest
    if guard <= 0.0:
        return 6
    return guard_curves(delta, y, theta, guard, curves)


@kernel
def guard_curves(delta, y, theta, guard, curves):
    """Add the curve on which the nearness is the guard to the six of the rings; return how many there are then.

    D / D_0 - 1 + guard^2, with D the singular measure and D_0 that of the origin, is quadratic: k + l_u X^2 + l_v Y^2 about its centre.
    """
    at_centre = singular_measure(delta, y, 0.0, 0.0, theta)
    size = 1e-3
    for i in range(6):
        size = max(size, max(abs(curves[i, 1]), abs(curves[i, 2])))
    if abs(at_centre) < 1e-14 * size * size * size * size:  # the origin itself is singular: a disc of no size
        return 7
    right = singular_measure(delta, y, size, 0.0, theta) / at_centre
    left = singular_measure(delta, y, -size, 0.0, theta) / at_centre
    above = singular_measure(delta, y, 0.0, size, theta) / at_centre
    below = singular_measure(delta, y, 0.0, -size, theta) / at_centre
    corner = singular_measure(delta, y, size, size, theta) / at_centre
    square = size * size
    xx = (right + left - 2.0) / (2.0 * square)
    yy = (above + below - 2.0) / (2.0 * square)
    bx = (right - left) / (2.0 * size)
    by = (above - below) / (2.0 * size)
    xy = (corner - 1.0 - (bx + by) * size - (xx + yy) * square) / square
    spread = 0.5 * math.hypot(xx - yy, xy)
    mean = 0.5 * (xx + yy)
    ux, uy = 1.0, 0.0
    if spread > 1e-10 * abs(mean):
        half = 0.5 * math.atan2(xy, xx - yy)
        ux, uy = math.cos(half), math.sin(half)
    first = keep_off_zero(mean + spread, square)
    second = keep_off_zero(mean - spread, square)
    cx = -0.5 * (bx * ux + by * uy) / first
    cy = -0.5 * (by * ux - bx * uy) / second
    value = keep_off_zero(guard * guard - first * cx * cx - second * cy * cy, 1.0)
    curves[6, 1], curves[6, 2] = cx * ux - cy * uy, cx * uy + cy * ux
    if first * second > 0.0:
        if first * value > 0.0:  # nowhere zero
            return 6 if value > 0.0 else 7
        if spread <= 1e-10 * abs(mean):
            curves[6, 0] = INSIDE if value > 0.0 else OUTSIDE
            curves[6, 3] = math.sqrt(-value / mean)
            return 7
        curves[6, 0], curves[6, 7] = ELLIPSE, 1.0 if value > 0.0 else -1.0
        curves[6, 3], curves[6, 4] = math.sqrt(-value / first), math.sqrt(-value / second)
        curves[6, 5], curves[6, 6] = ux, uy
        return 7
    if first * value > 0.0:  # the branches lie along the other axis
        first, second = second, first
        ux, uy = -uy, ux
    curves[6, 0], curves[6, 7] = BRANCH, 1.0 if value < 0.0 else -1.0
    curves[6, 3], curves[6, 4] = math.sqrt(-value / first), math.sqrt(value / second)
    curves[6, 5], curves[6, 6] = ux, uy
    for k in range(CURVE_NUMBERS):
        curves[7, k] = curves[6, k]
    curves[7, 3] = -curves[6, 3]
    return 8


@inlined
def keep_off_zero(value, per):
    """A number that is not too small to divide by: parabolas and crossing lines become the nearest conics proper."""
    least = 1e-12 / per
    return value if abs(value) > least else math.copysign(least, value)
