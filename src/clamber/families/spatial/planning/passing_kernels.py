"""Judging ways from one solved posture to the next: what limbs come near, each other, the base, solids, and whether tips get along."""

import math

from ....compiled import carray, inlined, kernel, pointer
from ....planning.problem.check import TOLERANCE, UNLIMITED
from ..statics.checks import LIMB_BODY, LIMB_LIMB
from ..statics.collision_kernels import body_gap, limbs_gap
from ..statics.kinematics_kernels import limb_frames
from ..statics.records import CONTACT, JOINTS, LIMBS
from ..statics.stance_kernels import limb_in_world, swing_reach
from .checks import CLEARANCE, SWING
from .poses_kernels import body_of, holds_of, judged_of, robot_of, seeds_of, work_of
from .solids_kernels import base_corners, solids_gap, tip_room

LEAVING, ARRIVING, PASSING = range(3)
"""Which of the places of limbs in the scratch."""
OF_LIMBS, OF_BASE, OF_SOLIDS = range(3)
"""Which of the least gaps on a way."""


@kernel
def put_places(p, which, limb, origin, work):
    """Keep where the joints of a limb are, in the base frame and, for the body that is set, in the world frame."""
    robot = robot_of(p)
    places = work.places[which, limb]
    for k in range(robot.n_joints[limb] + 1):
        for a in range(3):
            places[k, a] = origin[k, a]
    if p.n_solids > 0:
        limb_in_world(robot, body_of(p), limb, places, work.world[which, limb])


@kernel
def put_stance(p, which, work):
    """Keep where the joints of all limbs, as solved, and the base's corners are, for the pose of the body that is set."""
    for limb in range(p.n_limbs):
        put_places(p, which, limb, work.origin[limb], work)
    if p.n_solids > 0:
        base_corners(robot_of(p), body_of(p), work.corners[which])


@kernel
def begin_way(p, work):
    """Have no gap be the least one yet, and put all limbs where they stand, as solved: those that a way does not move stay there."""
    for k in range(3):
        work.least[k] = UNLIMITED
    put_stance(p, PASSING, work)


@inlined
def distance(a, b):
    """Of two points [m]."""
    return math.sqrt((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2 + (b[2] - a[2]) ** 2)


@inlined
def pass_point(points, i, share):
    """Put a point where it is at a share of its way."""
    for a in range(3):
        points[PASSING, i, a] = points[LEAVING, i, a] + share * (points[ARRIVING, i, a] - points[LEAVING, i, a])


@kernel
def apart_at_most(robot, only, places):
    """Length that no two joints of different limbs move by more to each other on their way: across the box of all their moves [m]."""
    square = 0.0
    for a in range(3):
        low, high = 0.0, 0.0
        for limb in range(robot.n_limbs):
            if only >= 0 and only != limb:
                continue
            for k in range(robot.n_joints[limb] + 1):
                moved = places[ARRIVING, limb, k, a] - places[LEAVING, limb, k, a]
                low, high = min(low, moved), max(high, moved)
        square += (high - low) ** 2
    return math.sqrt(square)


@kernel
def moved_at_most(robot, only, places):
    """Largest distance by which a joint or tip moves on its way [m]."""
    most = 0.0
    for limb in range(robot.n_limbs):
        if only < 0 or only == limb:
            for k in range(robot.n_joints[limb] + 1):
                most = max(most, distance(places[LEAVING, limb, k], places[ARRIVING, limb, k]))
    return most


@kernel
def pass_at(p, only, share, work):
    """Put limbs, and the base's corners with all of them, where they are at a share of their way."""
    robot = robot_of(p)
    for limb in range(p.n_limbs):
        if only < 0 or only == limb:
            for k in range(robot.n_joints[limb] + 1):
                pass_point(work.places[:, limb], k, share)
                if p.n_solids > 0:
                    pass_point(work.world[:, limb], k, share)
    if only < 0 and p.n_solids > 0:
        for corner in range(8):
            pass_point(work.corners, corner, share)


@kernel
def follow(p, only, work):
    """Lessen the least gaps by those on the way of limbs from where they leave to where they arrive, every joint straight on.

    Nothing moves farther than its way: where that is less than what the least gap has to spare, all of it is clear. Else limbs are looked
    at again as soon as they could be too near, after no less than the robot's `fine`. The end is left to what comes next.

    Args:
        p: Parameters.
        only: Limb that moves while all else stands, -1: all do, and the body.
        work: Record of `WORK`, with the places of all limbs as they leave and arrive; `least` is lessened.
    """
    robot, least = robot_of(p), work.least
    apart, moved, away = apart_at_most(robot, only, work.places), moved_at_most(robot, only, work.places), 0.0
    if p.n_solids > 0:
        away = moved_at_most(robot, only, work.world)
        for corner in range(8 if only < 0 else 0):
            away = max(away, distance(work.corners[LEAVING, corner], work.corners[ARRIVING, corner]))
    share = 0.0
    while True:
        pass_at(p, only, share, work)
        gap = limbs_gap(robot, work.places[PASSING], only, max(least[OF_LIMBS], robot.limb_room + apart))
        least[OF_LIMBS] = min(least[OF_LIMBS], gap)
        share_on = max(robot.fine, gap - robot.limb_room) / max(apart, TOLERANCE)
        gap = body_gap(robot, work.places[PASSING], only, max(least[OF_BASE], moved))
        least[OF_BASE] = min(least[OF_BASE], gap)
        share_on = min(share_on, max(robot.fine, gap) / max(moved, TOLERANCE))
        gap = solids_gap(p, work.world[PASSING], work.corners[PASSING], only, max(least[OF_SOLIDS], p.clearance + away))
        least[OF_SOLIDS] = min(least[OF_SOLIDS], gap)
        share += min(share_on, max(robot.fine, gap - p.clearance) / max(away, TOLERANCE))
        if share >= 1.0:
            return


@inlined
def lessen(margins, check, margin):
    """Take a margin where it is less than that of its check, or where there is none yet."""
    if not margins[check] <= margin:
        margins[check] = margin


@kernel
def take_gaps(p, least, margins):
    """Take the least gaps of a way where they are less than the margins of their checks; the first hard one violated, or -1."""
    lessen(margins, LIMB_LIMB, least[OF_LIMBS] - robot_of(p).limb_room)
    lessen(margins, LIMB_BODY, least[OF_BASE])
    lessen(margins, CLEARANCE, least[OF_SOLIDS] - p.clearance)
    for check in (LIMB_LIMB, LIMB_BODY, CLEARANCE):
        if p.hard >> check & 1 and margins[check] < -TOLERANCE:
            return check
    return -1


@kernel
def judge_move(p, before, s, margins):
    """Judge the body's way from one valid stance to another over the same holds, just after `judge_stance` of that.

    Args:
        p, before, s: Parameters and stances.
        margins: `limb_limb`, `limb_body` and `clearance` become what they are on the way, if that is less.

    Returns:
        The first violated hard check, or -1.
    """
    work = work_of(p)
    body = body_of(p)
    put_stance(p, ARRIVING, work)
    for a in range(9):
        body.rotation[a] = before.turn[a]
    for a in range(3):
        body.place[a] = before.place[a]
    for limb in range(p.n_limbs):
        for k in range(JOINTS):
            work.posture[limb, k] = before.q[limb, k]
        limb_frames(robot_of(p), limb, work)
    put_stance(p, LEAVING, work)
    begin_way(p, work)
    follow(p, -1, work)
    return take_gaps(p, work.least, margins)


@kernel
def judge_swing(p, s, limb, hold, margins):
    """Judge the lifted path of a limb from its hold to another, while the others stand as `origin` of the scratch has them.

    Args:
        p: Parameters.
        s: The stance that the limb leaves.
        limb: Which swings.
        hold: Where it goes.
        margins: `swing` is written: error that is allowed less the largest that postures leave [m]; `limb_limb`, `limb_body` and
            `clearance` become what they are on the path, if that is less, unless `swing` is violated.

    Returns:
        The first violated hard check, or -1.
    """
    robot, holds = robot_of(p), holds_of(p)
    swing = carray(pointer(p.work_contacts_at), LIMBS + 2, CONTACT)[LIMBS:]
    for end in range(2):
        which = holds[hold if end else s.hold[limb]]
        for k in range(3):
            swing[end].place[k] = which.place[k]
            swing[end].normal[k] = which.normal[k]
    before = judged_of(p)[0]
    work = work_of(p)
    for k in range(JOINTS):
        before.posture[limb, k] = s.q[limb, k]
    margins[SWING] = swing_reach(robot, seeds_of(p), body_of(p), limb, swing, before, p.lift, work)
    if margins[SWING] < -TOLERANCE:
        return SWING if p.hard >> SWING & 1 else -1
    begin_way(p, work)
    for point in range(work.n_way):
        put_places(p, LEAVING, limb, work.way[point], work)
        put_places(p, ARRIVING, limb, work.way[min(point + 1, work.n_way - 1)], work)
        follow(p, limb, work)
    if p.n_solids > 0:
        room = tip_room(p, swing, work)
        if room < 0.0:
            work.least[OF_SOLIDS] = min(work.least[OF_SOLIDS], p.clearance + room)
    return take_gaps(p, work.least, margins)
