"""A way for a free two-joint limb past holds and body, by Dijkstra on a grid of its joint angles, and its joints' aims on it. Kernels."""

import math

import numpy as np

from ....compiled import inlined, kernel, opened

FAR = 1e9
PREFERRED = 0.03
"""Clearance beyond which a way costs no more than its length [m]."""
BESIDE = 0.35
"""So near an end of the way, in either joint, the clearance may be less than elsewhere: at the end as little as there [rad]."""
TIGHTER = 0.002
"""And that much less [m]."""
DEAR = 8.0
"""How many times longer a step counts where there is no clearance left [-]."""


@inlined
def foot_on(ax, ay, bx, by, px, py):
    """The point of a segment that is nearest to another point."""
    dx = bx - ax
    dy = by - ay
    square = dx * dx + dy * dy
    t = 0.0
    if square > 0.0:
        t = min(1.0, max(0.0, ((px - ax) * dx + (py - ay) * dy) / square))
    return ax + t * dx, ay + t * dy


@inlined
def segment_point(ax, ay, bx, by, px, py):
    """Distance of a point from a segment."""
    x, y = foot_on(ax, ay, bx, by, px, py)
    return math.hypot(x - px, y - py)


@inlined
def _crosses(ax, ay, bx, by, cx, cy, dx, dy):
    d1 = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    d2 = (bx - ax) * (dy - ay) - (by - ay) * (dx - ax)
    d3 = (dx - cx) * (ay - cy) - (dy - cy) * (ax - cx)
    d4 = (dx - cx) * (by - cy) - (dy - cy) * (bx - cx)
    return d1 * d2 < 0.0 and d3 * d4 < 0.0


@inlined
def segment_segment(ax, ay, bx, by, cx, cy, dx, dy):
    """Distance of two segments; 0 where they cross."""
    if _crosses(ax, ay, bx, by, cx, cy, dx, dy):
        return 0.0
    return min(
        min(segment_point(ax, ay, bx, by, cx, cy), segment_point(ax, ay, bx, by, dx, dy)),
        min(segment_point(cx, cy, dx, dy, ax, ay), segment_point(cx, cy, dx, dy, bx, by)),
    )


@kernel
def discs_in_body(discs, pose, within, out):
    """Fill `out` with discs x, y, radius of the world so near to a body at a pose, in its frame, shape (n, 3) [m]; how many."""
    c, s = math.cos(pose[2]), math.sin(pose[2])
    count = 0
    for k in range(discs.shape[0]):
        dx, dy = discs[k, 0] - pose[0], discs[k, 1] - pose[1]
        if math.hypot(dx, dy) < within:
            out[count, 0], out[count, 1], out[count, 2] = c * dx + s * dy, -s * dx + c * dy, discs[k, 2]
            count += 1
    return count


@kernel
def clearance(leg, t1, t2, obstacles):
    """Smallest distance of a limb's links and tip from all obstacles, less their radii [m].

    Args:
        leg: A record of `PLANAR_LIMB`.
        t1, t2: Its joint angles [rad].
        obstacles: Discs x, y, radius in the body frame, shape (n, 3) [m]; walls, segments x, y, x, y, radius there, shape (m, 5) [m],
            which the first link may touch (it starts at the body); the radius of the limb's links [m]; and of its hook the radius and
            how far that disc is before the tip, shape (2,) [m].
    """
    return _clearance_up_to(leg, t1, t2, obstacles, FAR)


@kernel
def clearances(leg, angles, obstacles, rooms):
    """`clearance` at joint angles, shape (n, 2) [rad], into `rooms`, shape (n,)."""
    for k in range(rooms.size):
        rooms[k] = clearance(leg, angles[k, 0], angles[k, 1], obstacles)


@inlined
def _may_be_within(ax, ay, bx, by, half, px, py, distance):
    """Whether a point may be so near to a segment, by the circle about both of its ends; `half` is half the segment's length."""
    dx = 0.5 * (ax + bx) - px
    dy = 0.5 * (ay + by) - py
    far = half + distance + 1e-9  # rounding never leaves one out
    return far > 0.0 and dx * dx + dy * dy < far * far


@kernel
def _clearance_up_to(leg, t1, t2, obstacles, most):
    """`clearance`, but `most` where there is more [m]: what is farther away than what has been seen is not looked at."""
    discs, walls, link_radius, hook = obstacles
    first = leg.port_angle + t1
    second = first + t2
    ex = leg.port_x + leg.l1 * math.cos(first)
    ey = leg.port_y + leg.l1 * math.sin(first)
    tx = ex + leg.l2 * math.cos(second + leg.beta)
    ty = ey + leg.l2 * math.sin(second + leg.beta)
    grab = second + leg.hook_angle
    hx = tx + hook[1] * math.cos(grab)
    hy = ty + hook[1] * math.sin(grab)
    least = most
    for k in range(discs.shape[0]):
        x = discs[k, 0]
        y = discs[k, 1]
        r = discs[k, 2]
        if _may_be_within(leg.port_x, leg.port_y, ex, ey, 0.5 * leg.l1, x, y, least + link_radius + r):
            least = min(least, segment_point(leg.port_x, leg.port_y, ex, ey, x, y) - link_radius - r)
        if _may_be_within(ex, ey, tx, ty, 0.5 * leg.l2, x, y, least + link_radius + r):
            least = min(least, segment_point(ex, ey, tx, ty, x, y) - link_radius - r)
        if _may_be_within(hx, hy, hx, hy, 0.0, x, y, least + hook[0] + r):
            least = min(least, math.hypot(hx - x, hy - y) - hook[0] - r)
    for k in range(walls.shape[0]):
        x = 0.5 * (walls[k, 0] + walls[k, 2])
        y = 0.5 * (walls[k, 1] + walls[k, 3])
        length = abs(walls[k, 2] - walls[k, 0]) + abs(walls[k, 3] - walls[k, 1])  # at most
        if _may_be_within(ex, ey, tx, ty, 0.5 * (leg.l2 + length), x, y, least + link_radius + walls[k, 4]):
            least = min(
                least,
                segment_segment(ex, ey, tx, ty, walls[k, 0], walls[k, 1], walls[k, 2], walls[k, 3])
                - link_radius
                - walls[k, 4],
            )
    return least


@kernel
def find_way(leg, grid, start, goal, obstacles, least, path):
    """Cheapest way over the grid of joint angles, length made dearer near obstacles.

    Args:
        leg: A record of `PLANAR_LIMB`.
        grid: Lower and upper limits of its joints, shape (2,) each [rad], and the number of grid points along each joint.
        start, goal: Joint angles, shape (2,) [rad].
        obstacles: See `clearance`.
        least: Clearance that a way must keep, but next to a start or goal that has less: where it can be, it rises from there on [m].
        path: Filled with joint angles from start to goal, shape (most, 2).

    Returns:
        Number of points, 0 where there is no way.
    """
    count = _search(leg, grid, start, goal, obstacles, least, True, path)
    return count if count else _search(leg, grid, start, goal, obstacles, least, False, path)


@kernel
def _search(leg, grid, start, goal, obstacles, least, rises, path):
    """`find_way`, with a clearance that rises away from a tight end, or only is not less than there."""
    lower, upper, cells = grid
    size = cells * cells
    room = np.full(size, math.nan)  # looked at where the search comes by: that is what takes the time
    pitch1 = (upper[0] - lower[0]) / (cells - 1)
    pitch2 = (upper[1] - lower[1]) / (cells - 1)
    origin = _nearest(start, lower, pitch1, pitch2, cells)
    target = _nearest(goal, lower, pitch1, pitch2, cells)
    # where an end itself is tight, the way next to it may be as tight
    at_start = min(least, clearance(leg, start[0], start[1], obstacles) - TIGHTER)
    at_goal = min(least, clearance(leg, goal[0], goal[1], obstacles) - TIGHTER)
    cost = np.full(size, FAR)
    came = np.full(size, -1, np.int64)
    lengths = np.array(((0.0, pitch2), (pitch1, math.hypot(pitch1, pitch2))))
    enough = max(PREFERRED, least)  # where there is more, how much makes no difference
    heap_cost = np.empty(8 * size)
    heap_node = np.empty(8 * size, np.int64)
    count = 1
    heap_cost[0] = 0.0
    heap_node[0] = origin
    cost[origin] = 0.0
    while count:
        here_cost = heap_cost[0]
        here = heap_node[0]
        count -= 1
        heap_cost[0] = heap_cost[count]
        heap_node[0] = heap_node[count]
        _sink(heap_cost, heap_node, count)
        if here_cost > cost[here]:
            continue
        if here == target:
            break
        i = here // cells
        j = here % cells
        for di in range(-1, 2):
            for dj in range(-1, 2):
                if (di == 0 and dj == 0) or not (0 <= i + di < cells and 0 <= j + dj < cells):
                    continue
                there = (i + di) * cells + j + dj
                if cost[there] <= here_cost:
                    continue
                a = lower[0] + (i + di) * pitch1
                b = lower[1] + (j + dj) * pitch2
                if math.isnan(room[there]):
                    room[there] = _clearance_up_to(leg, a, b, obstacles, enough)
                tight = room[there] < _floor(a, b, start, goal, at_start, at_goal, least, rises)
                if tight and there != target and there != origin:
                    continue
                lack = max(0.0, PREFERRED - room[there]) / PREFERRED
                step = lengths[abs(di), abs(dj)] * (1.0 + DEAR * lack * lack)
                if here_cost + step < cost[there]:
                    cost[there] = here_cost + step
                    came[there] = here
                    heap_cost[count] = here_cost + step
                    heap_node[count] = there
                    count += 1
                    _rise(heap_cost, heap_node, count - 1)
    if came[target] < 0 and target != origin:
        return 0
    length = 0
    node = target
    while node >= 0 and length < path.shape[0] - 2:
        length += 1
        node = came[node] if node != origin else -1
    node = target
    for k in range(length, 0, -1):
        path[k, 0] = lower[0] + (node // cells) * pitch1
        path[k, 1] = lower[1] + (node % cells) * pitch2
        node = came[node]
    path[0] = start
    path[length + 1] = goal
    return _straighten(leg, path, length + 2, (at_start, at_goal), least, rises, obstacles)


@inlined
def _floor(a, b, start, goal, at_start, at_goal, least, rises):
    """Clearance that joint angles must keep: less next to an end that has less itself, the more so the nearer where it `rises`."""
    from_start = max(abs(a - start[0]), abs(b - start[1])) / BESIDE
    if from_start < 1.0:
        return at_start + (from_start * (least - at_start) if rises else 0.0)
    to_goal = max(abs(a - goal[0]), abs(b - goal[1])) / BESIDE
    if to_goal < 1.0:
        return at_goal + (to_goal * (least - at_goal) if rises else 0.0)
    return least


@inlined
def _nearest(angles, lower, pitch1, pitch2, cells):
    i = min(max(int(round((angles[0] - lower[0]) / pitch1)), 0), cells - 1)
    j = min(max(int(round((angles[1] - lower[1]) / pitch2)), 0), cells - 1)
    return i * cells + j


@inlined
def _sink(costs, nodes, count):
    at = 0
    while True:
        child = 2 * at + 1
        if child >= count:
            return
        if child + 1 < count and costs[child + 1] < costs[child]:
            child += 1
        if costs[at] <= costs[child]:
            return
        costs[at], costs[child] = costs[child], costs[at]
        nodes[at], nodes[child] = nodes[child], nodes[at]
        at = child


@inlined
def _rise(costs, nodes, at):
    while at:
        above = (at - 1) // 2
        if costs[above] <= costs[at]:
            return
        costs[at], costs[above] = costs[above], costs[at]
        nodes[at], nodes[above] = nodes[above], nodes[at]
        at = above


@kernel
def _straighten(leg, path, length, at_ends, least, rises, obstacles):
    """Leave out points between which the straight way keeps the preferred clearance, or that of the points themselves."""
    at_start, at_goal = at_ends
    enough = max(PREFERRED, least)
    room = np.empty(length)
    for k in range(length):
        room[k] = _clearance_up_to(leg, path[k, 0], path[k, 1], obstacles, PREFERRED)
    kept = 1
    at = 0
    while at < length - 1:
        best = at + 1
        for to in range(length - 1, at + 1, -1):
            tight = room[at : to + 1].min()
            tight = max(min(tight, 0.6 * PREFERRED), min(at_start, at_goal))
            free = True
            for k in range(1, 40):
                part = k / 40.0
                a = path[at, 0] + part * (path[to, 0] - path[at, 0])
                b = path[at, 1] + part * (path[to, 1] - path[at, 1])
                floor = _floor(a, b, path[0], path[length - 1], at_start, at_goal, least, rises)
                if _clearance_up_to(leg, a, b, obstacles, enough) < max(tight, floor) - 1e-6:
                    free = False
                    break
            if free:
                best = to
                break
        path[kept] = path[best]
        kept += 1
        at = best
    return kept


ON_WAY = np.dtype(
    [
        ("gone", "f8"),  # how far along the way, in its rows
        ("speed", "f8"),  # part of full speed at which it goes
        ("waited", "f8"),  # for how long it has been slowed down in all [s]
        ("stands", "f8"),  # for how long it has stood nearly still [s]
        ("period", "f8"),  # of a tick [s]
        ("regained", "f8"),  # part of full speed that it comes back to in a tick
        ("patience", "f8"),  # for how long it may be slowed down in all [s]
        ("still", "f8"),  # part of full speed below which it stands nearly still
        ("held", "f8"),  # standing for longer than this it is held by something [s]
        ("lag", "f8", (2,)),  # behind by the first of these it is slowed down, by the second it stands [rad]
        ("square", "f8"),  # 2, of a pace in accelerations: the C library's power, not a product, which rounds otherwise
    ]
)
"""Where a limb is on its way."""
IS_THERE, GOES, IS_HELD = range(3)


@kernel
def go_along(handle):
    """Set the aims of a limb's joints for the next tick on a way, slower where the joints lag: IS_THERE, GOES, or IS_HELD by something.

    Args:
        handle: Holds a record of `ON_WAY`, changed, shape (1,); joint angles of the limb and how much their outputs lag, shape (2,) each
            [rad]; rows of the way, the step from each to the next, rates and accelerations at full speed, shape (n, 2) each; and the part
            of full speed at each row, shape (n,); aims, filled: angles, rates, accelerations, shape (3, 2); and the limb's record of
            `LIMB_TASK`, filled with them, shape (1,).
    """
    ways, q, play, rows, steps, rates, surges, paces, aims, jobs = opened(handle)
    way = ways[0]
    if way.gone >= rows.shape[0] - 1:
        return IS_THERE
    # a limb that lags with one joint more than the other leaves its way, and knocks against what it was to go round
    lag = max(abs(aims[0, 0] - q[0]), abs(aims[0, 1] - q[1])) if way.gone > 0.0 else 0.0
    wished = 1.0
    if way.waited < way.patience and lag > way.lag[0]:
        wished = -1.0 / (way.lag[1] - way.lag[0]) * (lag - way.lag[0]) + 1.0 if lag < way.lag[1] else 0.0
    way.speed = min(wished, way.speed + way.regained)
    way.waited += (1.0 - way.speed) * way.period
    way.stands = way.stands + way.period if wished < way.still else 0.0
    if way.stands > way.held:
        return IS_HELD
    at = int(way.gone)
    part = way.gone - at
    pace = way.speed * paces[at]
    for k in range(2):
        aims[0, k] = rows[at, k] + part * steps[at, k] + play[k]  # the way is that of the joints' outputs
        aims[1, k] = pace * rates[at, k]
        aims[2, k] = math.pow(pace, way.square) * surges[at, k]
        jobs[0].angles[k] = aims[0, k]
        jobs[0].rates[k] = aims[1, k]
        jobs[0].accelerations[k] = aims[2, k]
    way.gone += pace
    return GOES
