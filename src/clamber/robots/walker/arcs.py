"""Kernels of plane regions bounded by circles and lines: their boundaries as exact arcs, loops of them, areas, chords.

A region is what satisfies every one of its curves. A row of `curves` is its kind and three numbers: INSIDE or OUTSIDE a circle (x, y of its
centre, radius), or BELOW a line (n_x, n_y, c: n . p <= c with |n| = 1). On circles the parameter is the angle [rad], on lines the distance
from c n along n turned by a right angle [m]. Arcs are traversed with the region on their left.
"""

import math

from ...compiled import inlined, kernel

INSIDE, OUTSIDE, BELOW = 0.0, 1.0, 2.0
COLUMNS = 8
"""Floats of an arc: curve, first and last parameter as traversed, loop, x, y of its first and of its last point."""
MOST_ARCS = 256
MOST_CURVES = 16
SAME = 1e-12
"""Curves that differ by less in every number are one; shorter arcs are none [m], [rad]."""
TURN = 2.0 * math.pi


@inlined
def point_x(curves, i, t):
    """First coordinate of the point at parameter t of curve i [m]."""
    if curves[i, 0] == BELOW:
        return curves[i, 3] * curves[i, 1] - t * curves[i, 2]
    return curves[i, 1] + curves[i, 3] * math.cos(t)


@inlined
def point_y(curves, i, t):
    """Second coordinate of the point at parameter t of curve i [m]."""
    if curves[i, 0] == BELOW:
        return curves[i, 3] * curves[i, 2] + t * curves[i, 1]
    return curves[i, 2] + curves[i, 3] * math.sin(t)


@inlined
def clearance(curves, i, x, y):
    """Signed distance of a point from curve i, positive on the region's side [m]."""
    if curves[i, 0] == BELOW:
        return curves[i, 3] - curves[i, 1] * x - curves[i, 2] * y
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
def is_repeated(curves, i):
    """Whether curve i stands before, too."""
    for j in range(i):
        if curves[i, 0] == curves[j, 0]:
            apart = max(abs(curves[i, 1] - curves[j, 1]), abs(curves[i, 2] - curves[j, 2]))
            if max(apart, abs(curves[i, 3] - curves[j, 3])) < SAME:
                return True
    return False


@kernel
def crossings(curves, i, j, at):
    """Write the parameters on curve i where it crosses curve j, shape (2,); return how many there are."""
    if curves[i, 0] == BELOW:
        x, y = curves[i, 3] * curves[i, 1], curves[i, 3] * curves[i, 2]
        dx, dy = -curves[i, 2], curves[i, 1]
        if curves[j, 0] == BELOW:
            turn = curves[j, 1] * dx + curves[j, 2] * dy
            if abs(turn) < SAME:
                return 0
            at[0] = (curves[j, 3] - curves[j, 1] * x - curves[j, 2] * y) / turn
            return 1
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


@kernel
def boundary(curves, n, arcs, params, at):
    """Write the arcs of the region's boundary, each as long as no other curve crosses it; return how many there are.

    Args:
        curves: Shape (MOST_CURVES, 4).
        n: Curves in use.
        arcs: Written, shape (MOST_ARCS, COLUMNS); loops are not set yet.
        params: Scratch, shape (2 * MOST_CURVES + 1,).
        at: Scratch, shape (2,).
    """
    count = 0
    for i in range(n):
        if is_repeated(curves, i):
            continue
        line = curves[i, 0] == BELOW
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
            x = point_x(curves, i, middle)
            y = point_y(curves, i, middle)
            held = True
            for j in range(n):
                if j != i and not (clearance(curves, j, x, y) >= 0.0) and not is_same(curves, i, j):
                    held = False
                    break
            if not held or count == arcs.shape[0]:
                continue
            first = high if curves[i, 0] == OUTSIDE else low
            last = low if curves[i, 0] == OUTSIDE else high
            arcs[count, 0] = i
            arcs[count, 1] = first
            arcs[count, 2] = last
            arcs[count, 3] = -1.0
            arcs[count, 4] = point_x(curves, i, first)
            arcs[count, 5] = point_y(curves, i, first)
            arcs[count, 6] = point_x(curves, i, last)
            arcs[count, 7] = point_y(curves, i, last)
            count += 1
    return count


@inlined
def is_same(curves, i, j):
    """Whether two curves are one."""
    apart = max(abs(curves[i, 1] - curves[j, 1]), abs(curves[i, 2] - curves[j, 2]))
    return curves[i, 0] == curves[j, 0] and max(apart, abs(curves[i, 3] - curves[j, 3])) < SAME


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
    radius = curves[i, 3]
    return 0.5 * (radius * radius * (arcs[k, 2] - arcs[k, 1]) + curves[i, 1] * (y1 - y0) - curves[i, 2] * (x1 - x0))


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
        within = math.hypot(x - curves[i, 1], y - curves[i, 2]) < curves[i, 3]
        if abs(swept) >= TURN - SAME:
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
        room: Scratch, shape (2 * MOST_CURVES + 3,).
    """
    count = boundary(curves, n, arcs, room[2:], room[:2])
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
    for i in range(n):
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
        if curves[i, 0] == INSIDE and (towards - arcs[k, 1]) % TURN <= arcs[k, 2] - arcs[k, 1]:
            most = max(most, curves[i, 1] * dx + curves[i, 2] * dy + curves[i, 3])
    return most


@kernel
def reach_curves(delta, y, theta, shortest, longest, guard, curves):
    """Write the curves of all places p of the Y-frame at one angle: three rings of the actuators, and the guard; return how many.

    Args:
        delta, y: Attachments, shape (3, 2) [m]; directly similar triangles unless the guard is 0.
        theta: Angle of the Y-frame in the Delta-frame [rad].
        shortest, longest: Lengths of the actuators [m].
        guard: Largest nearness of a singular pose [-]; 0 for no such limit.
        curves: Written, shape (MOST_CURVES, 4).
    """
    c = math.cos(theta)
    s = math.sin(theta)
    for i in range(3):
        for k in range(2):
            curves[2 * i + k, 0] = INSIDE if k == 0 else OUTSIDE
            curves[2 * i + k, 1] = delta[i, 0] - c * y[i, 0] + s * y[i, 1]
            curves[2 * i + k, 2] = delta[i, 1] - s * y[i, 0] - c * y[i, 1]
            curves[2 * i + k, 3] = longest if k == 0 else shortest
    if guard <= 0.0:
        return 6
    # The singular curve is the circle through the rings' middles: where |p - m| = r, D is zero, and D is proportional to r^2 - |p - m|^2
    ux, uy = curves[2, 1] - curves[0, 1], curves[2, 2] - curves[0, 2]
    vx, vy = curves[4, 1] - curves[0, 1], curves[4, 2] - curves[0, 2]
    twice = 2.0 * (ux * vy - uy * vx)
    if abs(twice) < SAME * SAME:  # all in one point: singular everywhere
        curves[6, 0], curves[6, 1], curves[6, 2], curves[6, 3] = INSIDE, 0.0, 0.0, 0.0
        return 7
    u2, v2 = ux * ux + uy * uy, vx * vx + vy * vy
    mx, my = (vy * u2 - uy * v2) / twice, (ux * v2 - vx * u2) / twice
    square = mx * mx + my * my
    mx += curves[0, 1]
    my += curves[0, 2]
    centre = square - mx * mx - my * my  # D of the origin, but for a factor
    curves[6, 0] = INSIDE if centre > 0.0 else OUTSIDE
    curves[6, 1], curves[6, 2] = mx, my
    curves[6, 3] = math.sqrt(max(0.0, square - (1.0 - guard * guard) * centre))
    return 7
