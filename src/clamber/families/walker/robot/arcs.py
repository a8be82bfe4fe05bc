"""Kernels of plane regions bounded by circles, lines and a conic (`curves`): their boundaries as exact arcs, loops of them, areas, chords.

Arcs are traversed with the region on their left.
"""

import math

import numpy as np

from ....compiled import inlined, kernel
from .curves import (
    BELOW,
    BRANCH,
    ELLIPSE,
    INSIDE,
    MOST_CURVES,
    SAME,
    TURN,
    clearance,
    conic_value,
    crossings,
    depth,
    is_repeated,
    is_same,
    line_conic,
    local_x,
    point,
    runs_back,
)

COLUMNS = 8
"""Floats of an arc: curve, first and last parameter as traversed, loop, x, y of its first and of its last point."""
MOST_ARCS = 256
ROOM = 4 * MOST_CURVES + 5
"""Floats of scratch of `outline`."""


@kernel
def boundary(curves, n, arcs, params, at):
    """Write the arcs of the region's boundary, each as long as no other curve crosses it; return how many there are.

    Args:
        curves: Shape (MOST_CURVES, 4).
        n: Curves in use.
        arcs: Written, shape (MOST_ARCS, COLUMNS); loops are not set yet.
        params: Scratch, shape (4 * MOST_CURVES + 1,).
        at: Scratch, shape (4,).
    """
    count = 0
    for i in range(n):
        if is_repeated(curves, i):
            continue
        line = curves[i, 0] == BELOW or curves[i, 0] == BRANCH  # without an end
        found = 0
        for j in range(n):
            if j == i:
                continue
            for k in range(crossings(curves, i, j, at)):
                value = at[k] if line else at[k] % TURN
                slot = found
                while slot > 0 and params[slot - 1] > value:
                    params[slot] = params[slot - 1]
                    slot -= 1
                params[slot] = value
                found += 1
        if found == 0:
            if line:
                continue
            params[0] = 0.0
            found = 1
        if not line:
            params[found] = params[0] + TURN
            found += 1
        for k in range(found - 1):
            low = params[k]
            high = params[k + 1]
            if high - low < SAME:
                continue
            middle = 0.5 * (low + high)
            x, y = point(curves, i, middle)
            held = True
            for j in range(n):
                if j != i and not (clearance(curves, j, x, y) >= 0.0) and not is_same(curves, i, j):
                    held = False
                    break
            if not held or count == arcs.shape[0]:
                continue
            first = high if runs_back(curves, i) else low
            last = low if runs_back(curves, i) else high
            arcs[count, 0] = i
            arcs[count, 1] = first
            arcs[count, 2] = last
            arcs[count, 3] = -1.0
            arcs[count, 4], arcs[count, 5] = point(curves, i, first)
            arcs[count, 6], arcs[count, 7] = point(curves, i, last)
            count += 1
    return count


@kernel
def link_loops(arcs, count):
    """Number the closed loops that the arcs form, by nearest ends; return how many there are."""
    loops = 0
    for begin in range(count):
        if arcs[begin, 3] >= 0.0:
            continue
        arc = begin
        while True:
            arcs[arc, 3] = loops
            nearest = begin
            least = math.hypot(arcs[begin, 4] - arcs[arc, 6], arcs[begin, 5] - arcs[arc, 7])
            for other in range(count):
                if arcs[other, 3] < 0.0:
                    apart = math.hypot(arcs[other, 4] - arcs[arc, 6], arcs[other, 5] - arcs[arc, 7])
                    if apart < least:
                        least = apart
                        nearest = other
            if nearest == begin:
                break
            arc = nearest
        loops += 1
    return loops


@inlined
def arc_area(curves, arcs, k):
    """An arc's part of the enclosed area: half the integral of x dy - y dx along it (Green) [m^2]."""
    i = int(arcs[k, 0])
    x0, y0, x1, y1 = arcs[k, 4], arcs[k, 5], arcs[k, 6], arcs[k, 7]
    if curves[i, 0] == BELOW:
        return 0.5 * (x0 * y1 - x1 * y0)
    square = curves[i, 3] * (curves[i, 3] if curves[i, 0] < BELOW else curves[i, 4])
    return 0.5 * (square * (arcs[k, 2] - arcs[k, 1]) + curves[i, 1] * (y1 - y0) - curves[i, 2] * (x1 - x0))


@inlined
def is_within(curves, i, x, y):
    """Whether a point is on the convex side of circle or conic i, of a branch on its own."""
    if curves[i, 0] < BELOW:
        return math.hypot(x - curves[i, 1], y - curves[i, 2]) < curves[i, 3]
    if curves[i, 0] == BRANCH and local_x(curves, i, x, y) * curves[i, 3] < 0.0:
        return False
    return curves[i, 7] * conic_value(curves, i, x, y) > 0.0


@kernel
def winding(curves, arcs, count, loop, x, y):
    """How often a loop goes round a point, anticlockwise: the angles of its chords, and a turn where chord and arc have it between them."""
    total = 0.0
    for k in range(count):
        if arcs[k, 3] != loop:
            continue
        i = int(arcs[k, 0])
        ax, ay = arcs[k, 4] - x, arcs[k, 5] - y
        bx, by = arcs[k, 6] - x, arcs[k, 7] - y
        cross = ax * by - ay * bx
        swept = arcs[k, 2] - arcs[k, 1]
        if curves[i, 0] == BELOW:
            total += math.atan2(cross, ax * bx + ay * by)
            continue
        within = is_within(curves, i, x, y)
        if curves[i, 0] == BRANCH:
            swept *= -curves[i, 3]  # round the convex side: anticlockwise is positive
        elif abs(swept) >= TURN - SAME:
            total += math.copysign(TURN, swept) if within else 0.0
            continue
        total += math.atan2(cross, ax * bx + ay * by)
        if within and swept > 0.0 and cross < 0.0:
            total += TURN
        elif within and swept < 0.0 and cross > 0.0:
            total -= TURN
    return int(round(total / TURN))


@kernel
def sort_loops(curves, arcs, count, loops, areas, owners):
    """Write each loop's signed area [m^2] and the outer loop that it belongs to, its own or the smallest around a hole.

    Args:
        areas, owners: Written, shape (MOST_ARCS,). Outer loops have positive areas, holes negative ones.
    """
    for loop in range(loops):
        areas[loop] = 0.0
        owners[loop] = loop
    for k in range(count):
        areas[int(arcs[k, 3])] += arc_area(curves, arcs, k)
    for k in range(count):
        hole = int(arcs[k, 3])
        if areas[hole] < 0.0 and owners[hole] == hole:
            least = math.inf
            for loop in range(loops):
                if 0.0 < areas[loop] < least and winding(curves, arcs, count, loop, arcs[k, 4], arcs[k, 5]) != 0:
                    least = areas[loop]
                    owners[hole] = loop


@kernel
def outline(curves, n, arcs, areas, owners, room):
    """Write the region's boundary, its loops' areas and owners; return how many arcs and loops there are.

    Args:
        curves: Shape (MOST_CURVES, 4).
        n: Curves in use.
        arcs: Written, shape (MOST_ARCS, COLUMNS).
        areas, owners: As of `sort_loops`.
        room: Scratch, shape (ROOM,).
    """
    count = boundary(curves, n, arcs, room[4:], room[:4])
    loops = link_loops(arcs, count)
    sort_loops(curves, arcs, count, loops, areas, owners)
    return count, loops


@kernel
def owner_of(curves, n, arcs, count, loops, areas, x, y):
    """The outer loop of the part of the region that has a point in it, or -1."""
    found = -1
    if depth(curves, n, x, y) >= 0.0:
        least = math.inf
        for loop in range(loops):
            if 0.0 < areas[loop] < least and winding(curves, arcs, count, loop, x, y) != 0:
                least = areas[loop]
                found = loop
    return found


@kernel
def ray(curves, n, x, y, dx, dy):
    """How far one gets from a point of the region along a unit direction before leaving it [m]; 0 outside it."""
    if not depth(curves, n, x, y) >= -SAME:
        return 0.0
    nearest = math.inf
    at = np.empty(4)
    for i in range(n):
        if curves[i, 0] == ELLIPSE or curves[i, 0] == BRANCH:
            for k in range(line_conic(curves, i, x, y, dx, dy, at)):
                after = at[k] + 1e-9  # where it leaves, not where it comes in
                if at[k] > -SAME and conic_value(curves, i, x + after * dx, y + after * dy) < 0.0:
                    nearest = min(nearest, max(0.0, at[k]))
            continue
        if curves[i, 0] == BELOW:
            rise = curves[i, 1] * dx + curves[i, 2] * dy
            if rise > 0.0:
                nearest = min(nearest, (curves[i, 3] - curves[i, 1] * x - curves[i, 2] * y) / rise)
            continue
        along = (curves[i, 1] - x) * dx + (curves[i, 2] - y) * dy
        off = (curves[i, 1] - x) * dy - (curves[i, 2] - y) * dx
        half = curves[i, 3] * curves[i, 3] - off * off
        if half < 0.0:
            continue
        if curves[i, 0] == INSIDE:
            nearest = min(nearest, along + math.sqrt(half))
        elif along > 0.0:
            nearest = min(nearest, along - math.sqrt(half))
    return max(0.0, nearest)


@kernel
def extent(curves, arcs, count, owners, owner, dx, dy):
    """Largest p . d over the part of the region with the outer loop `owner`, for a unit direction d [m]."""
    most = -math.inf
    towards = math.atan2(dy, dx)
    for k in range(count):
        if owners[int(arcs[k, 3])] != owner:
            continue
        most = max(most, arcs[k, 4] * dx + arcs[k, 5] * dy)
        i = int(arcs[k, 0])
        if curves[i, 0] == ELLIPSE or curves[i, 0] == BRANCH:
            along = curves[i, 3] * (dx * curves[i, 5] + dy * curves[i, 6])
            across = curves[i, 4] * (dy * curves[i, 5] - dx * curves[i, 6])
            low, high = min(arcs[k, 1], arcs[k, 2]), max(arcs[k, 1], arcs[k, 2])
            t = math.nan
            if curves[i, 0] == ELLIPSE:
                t = low + (math.atan2(across, along) - low) % TURN
            elif abs(across) < abs(along):
                t = math.atanh(-across / along)
            if low <= t <= high:
                x, y = point(curves, i, t)
                most = max(most, x * dx + y * dy)
        elif curves[i, 0] == INSIDE and (towards - arcs[k, 1]) % TURN <= arcs[k, 2] - arcs[k, 1]:
            most = max(most, curves[i, 1] * dx + curves[i, 2] * dy + curves[i, 3])
    return most
