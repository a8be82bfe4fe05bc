"""Judge one stance of the two-frame walker: records, checks, and their kernels (page "The walker's model")."""

import math

import numpy as np

from ....compiled import carray, inlined, kernel, pointer
from ....plane import edge_distance, inside, wrap
from ....planning.problem.check import TOLERANCE, UNLIMITED

STROKE, SINGULAR, FOOTHOLD, BALANCE, LEGS = 0, 1, 2, 3, 4
N_CHECKS = 5
DELTA, Y = 0, 1
"""The frames, in the order of every array."""
FEATURE_SLOTS = 8

WALKER_PARAMS = np.dtype(
    [
        ("origin", "f8", (2, 3)),  # x, y [m] and angle [rad] of each frame at tick zero
        ("tick", "f8"),
        ("tick_angle", "f8"),
        ("turn_ticks", "i8"),
        ("joint", "f8", (2, 3, 2)),  # attachments of the actuators, each in its frame [m]
        ("rest", "f8", (2, 3, 2)),  # feet, each in its frame [m], anticlockwise
        ("foot_radius", "f8", (2,)),  # from the frame's origin to its farthest foot [m]
        ("shortest", "f8"),
        ("longest", "f8"),
        ("guard", "f8"),
        ("share", "f8", (2,)),  # of the whole mass at each frame's origin [-]
        (
            "load",
            "f8",
            (2,),
        ),  # moment of arm and payload about the Delta-frame's origin per whole mass, Delta-frame [m]
        ("leg_shortest", "f8"),
        ("leg_longest", "f8"),
        ("leg_nominal", "f8"),
        ("lift", "f8"),  # of a lifted foot over the ground [m]
        ("leg_speed", "f8"),
        ("speed", "f8"),  # of an actuator [m/s]
        ("clearance", "f8"),  # of a foot's centre from a patch or an edge
        ("least_balance", "f8"),
        ("least_stroke", "f8"),
        ("apart", "f8"),  # the origins are never farther apart in a valid stance; inf where nothing says so
        ("n_goals", "i4"),
        ("n_patches", "i4"),
        ("n_edges", "i4"),  # outlines of level parts of the ground: a foot keeps off them
        ("n_bricks", "i4"),
        ("hard", "i4"),
        ("kinds", "i4", (FEATURE_SLOTS,)),
        ("goals_at", "i8"),
        ("vertices_at", "i8"),
        ("patch_start_at", "i8"),  # patches first, then edges
        ("bricks_at", "i8"),
        ("down", "f8", (3, 3)),  # turns the world's coordinates into the ground's
        ("ends", "f8", (4,)),  # of the ground: x_min, x_max, y_min, y_max in its frame [m]
        ("depth", "f8"),
        ("n_vertices", "i8"),
    ],
    align=True,
)
"""What the walker's kernels read. Its type chooses the family while compiling."""

WALKER_GOAL = np.dtype(
    [
        ("x_min", "f8"),
        ("x_max", "f8"),
        ("y_min", "f8"),
        ("y_max", "f8"),
        ("a_mid", "f8"),
        ("a_half", "f8"),  # at least pi: any angle
        ("before", "f8"),  # way from the start to the goal before this one, along the goals [m]
        ("way", "f8"),  # way from the goal before to this one [m]
    ],
    align=True,
)

WALKER_STANCE = np.dtype(
    [
        ("ticks", "i8", (2, 3)),  # x, y, angle of each frame
        ("stands", "i4"),  # the frame whose feet are on the ground
        ("stage", "i4"),
        ("count", "i4"),
        ("spare", "i4"),
        ("x", "f8"),  # the body's pose, under the names that the stances of every family have: that of the Delta-frame
        ("y", "f8"),
        ("angle", "f8"),
        ("pose", "f8", (2, 3)),
        ("c", "f8", (2,)),
        ("s", "f8", (2,)),
        ("foot", "f8", (2, 3, 2)),  # feet over the ground, world [m]
        ("actuator", "f8", (3,)),  # lengths [m]
        ("mass_x", "f8"),  # centre of mass, world [m]
        ("mass_y", "f8"),
        ("foothold", "f8"),  # margins that feature or next action read
        ("balance", "f8"),
        ("legs", "f8"),
        ("height", "f8"),  # of the plate [m]
        ("strain", "f8"),  # distance of the origins per distance at which the mechanism is singular [-]
        ("duration", "f8"),  # of the last action [s]
    ],
    align=True,
)


@inlined
def walker_goals(p):
    """Records of `WALKER_GOAL`, in order."""
    return carray(pointer(p.goals_at), p.n_goals, WALKER_GOAL)


@inlined
def outline(p, k):
    """Corners of outline k, shape (n, 2) [m]: the patches first, then the edges."""
    start = carray(pointer(p.patch_start_at), p.n_patches + p.n_edges + 1, np.int64)
    return carray(pointer(p.vertices_at), (p.n_vertices, 2), np.float64)[start[k] : start[k + 1]]


@inlined
def bricks(p):
    """x_min, x_max, y_min, y_max, top of the bricks that the ground is made of, ground's frame [m], shape (n, 5)."""
    return carray(pointer(p.bricks_at), (p.n_bricks, 5), np.float64)


@inlined
def place(p, s, f):
    """World pose and feet of frame f from its ticks."""
    x = p.origin[f, 0] + s.ticks[f, 0] * p.tick
    y = p.origin[f, 1] + s.ticks[f, 1] * p.tick
    angle = wrap(p.origin[f, 2] + s.ticks[f, 2] * p.tick_angle)
    c = math.cos(angle)
    sine = math.sin(angle)
    s.pose[f, 0] = x
    s.pose[f, 1] = y
    s.pose[f, 2] = angle
    s.c[f] = c
    s.s[f] = sine
    for i in range(3):
        s.foot[f, i, 0] = x + c * p.rest[f, i, 0] - sine * p.rest[f, i, 1]
        s.foot[f, i, 1] = y + sine * p.rest[f, i, 0] + c * p.rest[f, i, 1]
    if f == DELTA:
        s.x = x
        s.y = y
        s.angle = angle


@kernel
def patch_distance(p, x, y):
    """Distance of a point of the ground, in its frame, from the nearest patch, edge or end [m]; negative in a patch or beyond an end."""
    best = min(min(x - p.ends[0], p.ends[1] - x), min(y - p.ends[2], p.ends[3] - y))
    for k in range(p.n_patches + p.n_edges):
        corners = outline(p, k)
        near = edge_distance(x, y, corners)
        best = min(best, -near if k < p.n_patches and inside(x, y, corners) else near)
    return best


@kernel
def ground_height(p, x, y):
    """Height of the ground at a place of the level plane [m]: where an upright line leaves the highest brick; very low beyond all."""
    best = -UNLIMITED
    for k in range(p.n_bricks):
        brick = bricks(p)[k]
        enter = -math.inf
        leave = math.inf
        for axis in range(3):
            start = p.down[axis, 0] * x + p.down[axis, 1] * y
            rise = p.down[axis, 2]
            low = -p.depth if axis == 2 else brick[2 * axis]
            high = brick[4] if axis == 2 else brick[2 * axis + 1]
            if abs(rise) < 1e-12:
                if start < low or start > high:
                    leave = -math.inf
                continue
            first = (low - start) / rise
            second = (high - start) / rise
            enter = max(enter, min(first, second))
            leave = min(leave, max(first, second))
        if enter <= leave:
            best = max(best, leave)
    return best


@kernel
def foothold(p, s):
    """Margin of the standing feet from patches, edges and the ground's ends [m]."""
    f = s.stands
    best = UNLIMITED
    for i in range(3):
        x = s.foot[f, i, 0]
        y = s.foot[f, i, 1]
        z = ground_height(p, x, y)
        u = p.down[0, 0] * x + p.down[0, 1] * y + p.down[0, 2] * z
        v = p.down[1, 0] * x + p.down[1, 1] * y + p.down[1, 2] * z
        best = min(best, patch_distance(p, u, v))
    return best - p.clearance


@kernel
def stand_height(p, s, landed):
    """Set the plate's height; return the range of heights at which all legs fit [m].

    The standing feet are on the ground, the others clear it by the lift. Where feet have just landed, all six were on the ground at once,
    which counts in the range, but not in the height: that depends on the stance alone, however it was come to.
    """
    low = -math.inf
    high = math.inf
    both = math.inf
    total = 0.0
    for f in range(2):
        for i in range(3):
            ground = ground_height(p, s.foot[f, i, 0], s.foot[f, i, 1])
            if f == s.stands:
                total += ground
                low = max(low, ground + p.leg_shortest)
                high = min(high, ground + p.leg_longest)
            else:
                low = max(low, ground + p.lift + p.leg_shortest)
                if landed:
                    both = min(both, ground + p.leg_longest)
    s.height = max(low, min(high, total / 3.0 + p.leg_nominal))
    return min(high, both) - low


@inlined
def stretch(p, s):
    """Set the actuators' lengths; return the stroke margin and the singular one [m]."""
    dx = s.pose[Y, 0] - s.pose[DELTA, 0]
    dy = s.pose[Y, 1] - s.pose[DELTA, 1]
    room = math.inf
    reach = 0.0
    for i in range(3):
        # c_i of the paper's geometry, turned into the world: its size rho is the same for all three
        cx = s.c[Y] * p.joint[Y, i, 0] - s.s[Y] * p.joint[Y, i, 1]
        cy = s.s[Y] * p.joint[Y, i, 0] + s.c[Y] * p.joint[Y, i, 1]
        cx -= s.c[DELTA] * p.joint[DELTA, i, 0] - s.s[DELTA] * p.joint[DELTA, i, 1]
        cy -= s.s[DELTA] * p.joint[DELTA, i, 0] + s.c[DELTA] * p.joint[DELTA, i, 1]
        length = math.sqrt((dx + cx) * (dx + cx) + (dy + cy) * (dy + cy))
        s.actuator[i] = length
        room = min(room, min(length - p.shortest, p.longest - length))
        reach = math.sqrt(cx * cx + cy * cy)
    apart = math.sqrt(dx * dx + dy * dy)
    s.strain = apart / reach if reach > 0.0 else 0.0
    return room - p.least_stroke, p.guard * reach - apart


@inlined
def balance(p, s):
    """Set the centre of mass; return how far it lies inside the standing feet [m], less what the task asks for."""
    f = s.stands
    s.mass_x = p.share[DELTA] * s.pose[DELTA, 0] + p.share[Y] * s.pose[Y, 0]
    s.mass_y = p.share[DELTA] * s.pose[DELTA, 1] + p.share[Y] * s.pose[Y, 1]
    s.mass_x += s.c[DELTA] * p.load[0] - s.s[DELTA] * p.load[1]
    s.mass_y += s.s[DELTA] * p.load[0] + s.c[DELTA] * p.load[1]
    least = math.inf
    j = 2
    for i in range(3):
        ex = s.foot[f, i, 0] - s.foot[f, j, 0]
        ey = s.foot[f, i, 1] - s.foot[f, j, 1]
        away = ex * (s.mass_y - s.foot[f, j, 1]) - ey * (s.mass_x - s.foot[f, j, 0])
        least = min(least, away / math.sqrt(ex * ex + ey * ey))
        j = i
    return least - p.least_balance


@kernel
def judge(p, s, landed, margins):
    """Write every margin of a placed stance; return the first hard check that is violated, or -1.

    Args:
        p: Record of `WALKER_PARAMS`.
        s: Stance record, both frames placed.
        landed: Whether the standing feet are new on the ground; else the foothold margin of the stance still counts.
        margins: Output, shape (N_CHECKS,).
    """
    if landed:
        s.foothold = foothold(p, s)
    s.legs = stand_height(p, s, landed)
    s.balance = balance(p, s)
    margins[STROKE], margins[SINGULAR] = stretch(p, s)
    margins[FOOTHOLD] = s.foothold
    margins[BALANCE] = s.balance
    margins[LEGS] = s.legs
    for check in range(N_CHECKS):
        if p.hard & (1 << check) and margins[check] < -TOLERANCE:
            return check
    return -1
