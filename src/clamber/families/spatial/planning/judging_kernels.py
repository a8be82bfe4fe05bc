"""Judging a stance of a task in space: where its limbs are, what statics says of it, and how near it comes to solids."""

import math

import numpy as np

from ....compiled import carray, inlined, kernel, pointer
from ....planning.problem.check import TOLERANCE, UNLIMITED
from ..statics.records import BODY, CONTACT, JOINTS, JUDGED, LIMBS, ROBOT, RULES, SEEDS, WORK
from ..statics.stance_kernels import judge, swing_reach
from ..world.solids import SOLID
from ..world.terrain_kernels import terrain_distance
from .checks import CLEARANCE
from .poses_kernels import holds_of
from .records import AXES

SCRATCH = 256
"""Floats of a thread's scratch."""
BETWEEN = 3
"""Places of a link between its ends that are held against solids."""


@inlined
def robot_of(p):
    """The robot."""
    return carray(pointer(p.robot_at), 1, ROBOT)[0]


@inlined
def scratch_of(p):
    """Scratch of the thread."""
    return carray(pointer(p.work_at), SCRATCH, np.float64)


@kernel
def copy(s, t):
    """Copy a stance."""
    for k in range(AXES):
        t.pose[k] = s.pose[k]
    for i in range(LIMBS):
        t.hold[i] = s.hold[i]
        for k in range(JOINTS):
            t.q[i, k] = s.q[i, k]
        for k in range(6):
            t.wrench[i, k] = s.wrench[i, k]
    t.stage, t.count, t.postured = s.stage, s.count, s.postured
    t.x, t.y, t.angle, t.torque, t.share = s.x, s.y, s.angle, s.torque, s.share
    for k in range(3):
        t.place[k] = s.place[k]
    for k in range(9):
        t.turn[k] = s.turn[k]


@kernel
def set_contacts(p, s, swinging, moved):
    """Write body and contacts of a stance to where statics reads them.

    Args:
        p, s: Parameters and stance.
        swinging: Limb that bears nothing though its tip is at its hold, -1: none.
        moved: Limb whose hold was another one before, -1: none.
    """
    body = carray(pointer(p.work_body_at), 1, BODY)[0]
    contacts = carray(pointer(p.work_contacts_at), LIMBS, CONTACT)
    holds = holds_of(p)
    for k in range(9):
        body.rotation[k] = s.turn[k]
    for k in range(3):
        body.place[k] = s.place[k]
    for i in range(p.n_limbs):
        contact, hold = contacts[i], holds[s.hold[i]]
        for k in range(3):
            contact.place[k] = hold.place[k]
            contact.normal[k] = hold.normal[k]
        contact.strength = hold.strength
        contact.friction = hold.friction
        contact.bears = 0 if i == swinging else 1
        contact.moved = 1 if i == moved else 0


@kernel
def solids_gap(p, s, judged):
    """Least distance of links and of the base's corners from solids, less the clearance asked for [m].

    Of each link its ends and `BETWEEN` places in between are looked at; of the last one, which touches a solid with its tip, the half
    that is nearer to the joint; first links lie beside the base.
    """
    if p.n_solids == 0:
        return UNLIMITED
    robot = robot_of(p)
    solids = carray(pointer(p.solids_at), p.n_solids, SOLID)
    gap = UNLIMITED
    for i in range(p.n_limbs):
        for k in range(1, robot.n_joints[i]):
            at, to = judged.origin[i, k], judged.origin[i, k + 1]
            x, y, z = to[0] - at[0], to[1] - at[1], to[2] - at[2]
            near = terrain_distance(solids, at[0], at[1], at[2]) - robot.radius[i, k]
            gap = min(gap, near)
            part = 1.0 if k + 1 < robot.n_joints[i] else 0.5
            if near - part * math.sqrt(x * x + y * y + z * z) > gap:
                continue
            for step in range(1, BETWEEN + 1):
                share = part * step / (BETWEEN + 1)
                away = terrain_distance(solids, at[0] + share * x, at[1] + share * y, at[2] + share * z)
                gap = min(gap, away - robot.radius[i, k])
    for corner in range(8):
        x = robot.base_half[0] * (1 - 2 * (corner & 1))
        y = robot.base_half[1] * (1 - (corner & 2))
        z = robot.base_half[2] * (1 - (corner >> 1 & 2))
        wx = s.place[0] + s.turn[0] * x + s.turn[1] * y + s.turn[2] * z
        wy = s.place[1] + s.turn[3] * x + s.turn[4] * y + s.turn[5] * z
        wz = s.place[2] + s.turn[6] * x + s.turn[7] * y + s.turn[8] * z
        gap = min(gap, terrain_distance(solids, wx, wy, wz))
    return gap - p.clearance


@inlined
def world_wrench(turn, frame, wrench, to):
    """A wrench in its contact's frame, whose axes are of the base frame, in the world frame."""
    for part in range(0, 6, 3):
        for a in range(3):
            to[part + a] = 0.0
            for b in range(3):
                along = frame[b] * wrench[part] + frame[3 + b] * wrench[part + 1] + frame[6 + b] * wrench[part + 2]
                to[part + a] += turn[3 * a + b] * along


@kernel
def judge_stance(p, before, s, swinging, moved, margins):
    """Judge a placed stance and write its posture, wrenches and margins; returns the first violated hard check, or -1.

    Args:
        p: Parameters.
        before: The stance before, whose posture limits jumps.
        s: The stance.
        swinging: Limb that bears nothing, -1: none.
        moved: Limb whose hold was another one before, -1: none.
        margins: Output, all but `swing`.
    """
    set_contacts(p, s, swinging, moved)
    judged = carray(pointer(p.work_judged_at), 2, JUDGED)
    last, out = judged[0], judged[1]
    last.judged = before.postured
    for i in range(p.n_limbs):
        for k in range(JOINTS):
            last.posture[i, k] = before.q[i, k]
    rules = carray(pointer(p.rules_at), 1, RULES)[0]
    broken = judge(
        robot_of(p),
        carray(pointer(p.seeds_at), 1, SEEDS)[0],
        carray(pointer(p.work_body_at), 1, BODY)[0],
        carray(pointer(p.work_contacts_at), LIMBS, CONTACT),
        last,
        rules,
        out,
        carray(pointer(p.work_statics_at), 1, WORK)[0],
    )
    for k in range(CLEARANCE):
        margins[k] = out.margins[k]
    s.postured = 1
    s.share = out.s
    s.torque = out.torque
    for i in range(p.n_limbs):
        for k in range(JOINTS):
            s.q[i, k] = out.posture[i, k]
        if swinging < 0:
            world_wrench(s.turn, out.frame[i], out.wrench[i], s.wrench[i])
    if broken >= 0:
        return broken
    margins[CLEARANCE] = solids_gap(p, s, out)
    return CLEARANCE if p.hard >> CLEARANCE & 1 and margins[CLEARANCE] < -TOLERANCE else -1


@kernel
def swing_margin(p, s, limb, hold):
    """Error that is allowed on the lifted path of a limb from its hold to another, less the largest that postures leave [m]."""
    holds = holds_of(p)
    swing = carray(pointer(p.work_contacts_at), LIMBS + 2, CONTACT)[LIMBS:]
    for end in range(2):
        which = holds[hold if end else s.hold[limb]]
        for k in range(3):
            swing[end].place[k] = which.place[k]
            swing[end].normal[k] = which.normal[k]
    judged = carray(pointer(p.work_judged_at), 2, JUDGED)[0]
    for k in range(JOINTS):
        judged.posture[limb, k] = s.q[limb, k]
    body = carray(pointer(p.work_body_at), 1, BODY)[0]
    work = carray(pointer(p.work_statics_at), 1, WORK)[0]
    return swing_reach(robot_of(p), body, limb, swing, judged, p.lift, work)
