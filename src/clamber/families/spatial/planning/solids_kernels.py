"""How near a robot in space comes to the solids of its world: links, base, and tips on their lifted paths."""

import math

from ....compiled import carray, kernel, pointer
from ....planning.problem.check import TOLERANCE
from ..statics.records import CLEAR
from ..statics.stance_kernels import KEPT_LIFT, lift_over, lifted_share, path_point
from ..world.solids import SOLID
from ..world.terrain_kernels import terrain_distance
from .poses_kernels import robot_of

TIP_POINTS = 28
"""Of a lifted path, whose distance from solids is looked at."""
BETWEEN = 3
"""Places of a link between its ends that are held against solids."""


@kernel
def limb_solids_gap(robot, solids, i, origin, gap):
    """Least distance of a limb's links from solids, if less than `gap` [m]; `origin` has its joints, world frame.

    Of each link its ends and `BETWEEN` places in between are looked at; of the last one, which touches a solid with its tip, what is more
    than `CLEAR` radii from that, as the plant's colliders are; first links lie beside the base.
    """
    for k in range(1, robot.n_joints[i]):
        at, to = origin[k], origin[k + 1]
        x, y, z = to[0] - at[0], to[1] - at[1], to[2] - at[2]
        near = terrain_distance(solids, at[0], at[1], at[2]) - robot.radius[i, k]
        gap = min(gap, near)
        length = math.sqrt(x * x + y * y + z * z)
        part, places = 1.0, BETWEEN + 1
        if k + 1 == robot.n_joints[i]:
            part, places = max(0.0, 1.0 - CLEAR * robot.radius[i, k] / max(length, TOLERANCE)), BETWEEN
        if near - part * length > gap:
            continue
        for step in range(1, BETWEEN + 1):
            share = part * step / places
            away = terrain_distance(solids, at[0] + share * x, at[1] + share * y, at[2] + share * z)
            gap = min(gap, away - robot.radius[i, k])
    return gap


@kernel
def base_corners(robot, body, to):
    """Write the corners of the base's box in the world frame [m], shape (8, 3), for a pose of the body (`BODY`)."""
    place, turn = body.place, body.rotation
    for corner in range(8):
        x = robot.base_half[0] * (1 - 2 * (corner & 1))
        y = robot.base_half[1] * (1 - (corner & 2))
        z = robot.base_half[2] * (1 - (corner >> 1 & 2))
        for a in range(3):
            to[corner, a] = place[a] + turn[3 * a] * x + turn[3 * a + 1] * y + turn[3 * a + 2] * z


@kernel
def solids_gap(p, origin, corners, only, gap):
    """Least distance of links, whose joints are at `origin`, and of the base's corners from solids, if less than `gap` [m].

    Args:
        p: Parameters.
        origin: Of all limbs' joints and tips, world frame.
        corners: Of the base (`base_corners`).
        only: Limb whose links alone are looked at, -1: all, and the base.
        gap: What is returned where nothing is nearer.
    """
    if p.n_solids == 0:
        return gap
    solids = carray(pointer(p.solids_at), p.n_solids, SOLID)
    for i in range(p.n_limbs):
        if only < 0 or only == i:
            gap = limb_solids_gap(robot_of(p), solids, i, origin[i], gap)
    if only < 0:
        for corner in range(8):
            at = corners[corner]
            gap = min(gap, terrain_distance(solids, at[0], at[1], at[2]))
    return gap


@kernel
def tip_room(p, swing, work):
    """What a lifted path lacks of half its lift over solids where that is most [m], not above 0; both holds may lie a little inside."""
    solids = carray(pointer(p.solids_at), p.n_solids, SOLID)
    place, up = work.full[:3], work.six[:3]
    first, last = swing[0].place, swing[1].place
    inside = min(0.0, terrain_distance(solids, first[0], first[1], first[2]))
    inside = min(inside, terrain_distance(solids, last[0], last[1], last[2]))
    lift_over(first, last, swing[0].normal, swing[1].normal, p.lift, up)
    cosine = 0.0
    for a in range(3):
        cosine += swing[0].normal[a] * swing[1].normal[a]
    room = 0.0
    for point in range(1, TIP_POINTS):
        u = point / TIP_POINTS
        path_point(swing[0], swing[1], up, u, place)
        wanted = KEPT_LIFT * 0.5 * (1.0 + cosine) * lifted_share(u) * p.lift
        room = min(room, terrain_distance(solids, place[0], place[1], place[2]) - inside - wanted)
    return room
