"""Judging a stance of a task in space: where its limbs are, and what statics says of it."""

import numpy as np

from ....compiled import carray, inlined, kernel, pointer
from ....planning.problem.check import TOLERANCE, UNLIMITED
from ....planning.problem.randoms import scramble
from ..statics.checks import JOINT, JUMP, REACH
from ..statics.records import JOINTS, LIMBS
from ..statics.stance_kernels import (
    aim_limb,
    judge,
    judge_forces,
    judge_postures,
    judge_shape,
    place_in_world,
    solve_limb,
    weigh,
)
from .checks import CLEARANCE
from .passing_kernels import ARRIVING, judge_swing, lessen
from .poses_kernels import body_of, contacts_of, holds_of, judged_of, robot_of, rules_of, seeds_of, work_of
from .records import AXES, KNOWN, LIFTED
from .solids_kernels import base_corners, solids_gap

SCRATCH = 256
"""Floats of a thread's scratch."""


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
    body = body_of(p)
    contacts = contacts_of(p)
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
        contact.known = 0


@inlined
def row_at(s, value, n):
    """Row of a table of n, a power of two, for what is known of something in the pose of a stance."""
    for k in range(AXES):
        value = scramble(value ^ np.uint64(s.pose[k]))
    return np.int64(value & np.uint64(n - 1))


@kernel
def know_posture(p, s, limb):
    """Posture of a limb of a placed stance, and the error that it leaves: solved, or as it was kept; after `set_contacts`.

    Returns:
        The record of `KNOWN`, good until the next one is asked for.
    """
    named = limb + 1 | np.int64(s.hold[limb]) << 16
    kept = carray(pointer(p.work_known_at), p.n_work_known, KNOWN)
    known = kept[row_at(s, scramble(np.uint64(named)), p.n_work_known)]
    same = known.limb == named
    for k in range(AXES):
        same = same and known.pose[k] == s.pose[k]
    if not same:
        robot = robot_of(p)
        work = work_of(p)
        contact = contacts_of(p)[limb]
        aim_limb(body_of(p), contact.place, contact.normal, limb, work)
        known.error = solve_limb(robot, seeds_of(p), limb, work)
        known.limb = named
        for k in range(AXES):
            known.pose[k] = s.pose[k]
        for k in range(robot.n_joints[limb]):
            known.posture[k] = work.posture[limb, k]
    return known


@kernel
def know_postures(p, s, out):
    """Put the postures of a placed stance where `judge` finds them, up to a limb that does not reach its hold; after `set_contacts`."""
    contacts = contacts_of(p)
    robot = robot_of(p)
    most = rules_of(p).reach * robot.size + TOLERANCE
    for i in range(p.n_limbs):
        known = know_posture(p, s, i)
        contacts[i].known = 1
        contacts[i].error = known.error
        for k in range(robot.n_joints[i]):
            out.posture[i, k] = known.posture[k]
        if known.error > most:
            return


@kernel
def weigh_known(p):
    """Weigh a stance whose postures are known; after `set_contacts` and them, before `judge_forces`."""
    judged = judged_of(p)
    robot = robot_of(p)
    body = body_of(p)
    work = work_of(p)
    judge_postures(robot, seeds_of(p), body, contacts_of(p), judged[0], rules_of(p), judged[1], work)
    weigh(robot, body, work)


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
    remember(p, before)
    judged = judged_of(p)
    out = judged[1]
    know_postures(p, s, out)
    broken = judge(robot_of(p), seeds_of(p), body_of(p), contacts_of(p), judged[0], rules_of(p), out, work_of(p))
    for k in range(CLEARANCE):
        margins[k] = out.margins[k]
    keep_judged(p, s, out, swinging < 0)
    if broken >= 0:
        return broken
    margins[CLEARANCE] = judge_clearance(p, out)
    return CLEARANCE if p.hard >> CLEARANCE & 1 and margins[CLEARANCE] < -TOLERANCE else -1


@kernel
def judge_clearance(p, judged):
    """Least distance of links and of the base's corners from solids in the stance that was judged, less the clearance asked for [m]."""
    if p.n_solids == 0:
        return UNLIMITED
    corners = work_of(p).corners[ARRIVING]
    base_corners(robot_of(p), body_of(p), corners)
    return solids_gap(p, judged.origin, corners, -1, UNLIMITED) - p.clearance


@inlined
def remember(p, before):
    """Put the posture of a stance where `judge` finds the one before."""
    last = judged_of(p)[0]
    last.judged = before.postured
    for i in range(p.n_limbs):
        for k in range(JOINTS):
            last.posture[i, k] = before.q[i, k]


@inlined
def keep_judged(p, s, out, bears):
    """Write what judging found into a stance, wrenches where all its limbs bear."""
    s.postured = 1
    s.share = out.s
    s.torque = out.torque
    for i in range(p.n_limbs):
        for k in range(JOINTS):
            s.q[i, k] = out.posture[i, k]
        if bears:
            world_wrench(s.turn, out.frame[i], out.wrench[i], s.wrench[i])


@kernel
def judge_lifted(p, s, limb):
    """The first force check that a valid stance violates while a limb bears nothing, -1 if none: judged, or as it was kept."""
    value = np.uint64(0)
    for i in range(p.n_limbs):
        value = scramble(value ^ np.uint64(s.hold[i]))
    kept = carray(pointer(p.work_lifted_at), p.n_work_lifted, LIFTED)
    lifted = kept[row_at(s, value, p.n_work_lifted)]
    same = lifted.known != 0
    for k in range(AXES):
        same = same and lifted.pose[k] == s.pose[k]
    for i in range(p.n_limbs):
        same = same and lifted.hold[i] == s.hold[i]
    if not same:
        lifted.known = 0
        for k in range(AXES):
            lifted.pose[k] = s.pose[k]
        for i in range(p.n_limbs):
            lifted.hold[i] = s.hold[i]
    if not lifted.known >> limb & 1:
        contacts = contacts_of(p)
        out = judged_of(p)[1]
        set_contacts(p, s, limb, -1)
        for i in range(p.n_limbs):
            contacts[i].known = 1
            contacts[i].error = 0.0
            for k in range(JOINTS):
                out.posture[i, k] = s.q[i, k]
        remember(p, s)
        weigh_known(p)
        lifted.verdict[limb] = judge_forces(robot_of(p), rules_of(p), out, work_of(p))
        lifted.known |= 1 << limb
    return lifted.verdict[limb]


@kernel
def judge_posture(p, before, s, limb):
    """The first check that a limb's own posture on its other hold violates, -1 if none; after `set_contacts`."""
    known = know_posture(p, s, limb)
    robot = robot_of(p)
    rules = rules_of(p)
    if rules.reach * robot.size - known.error < -TOLERANCE:
        return REACH
    joint, jump = UNLIMITED, UNLIMITED
    for k in range(robot.n_joints[limb]):
        q = known.posture[k]
        joint = min(joint, q - robot.lower[limb, k], robot.upper[limb, k] - q)
        jump = min(jump, rules.jump_moved - abs(q - before.q[limb, k]))
    if p.hard >> JOINT & 1 and joint - rules.joint_room < -TOLERANCE:
        return JOINT
    return JUMP if p.hard >> JUMP & 1 and before.postured and jump < -TOLERANCE else -1


@kernel
def judge_taken(p, before, s, limb, margins):
    """Judge a placed stance in which a limb has come to another hold, without it and with it, and write its posture and wrenches.

    Returns:
        A violated hard check, or -1; `margins` are written as far as the verdict needs them.
    """
    set_contacts(p, s, -1, limb)
    broken = judge_posture(p, before, s, limb)
    if broken < 0:  # early, as it is known for all the limb's ways on at once, and most often what fails
        broken = judge_lifted(p, before, limb)
    if broken >= 0:
        return broken
    set_contacts(p, s, -1, limb)
    remember(p, before)
    robot = robot_of(p)
    body = body_of(p)
    rules = rules_of(p)
    judged = judged_of(p)
    out = judged[1]
    work = work_of(p)
    know_postures(p, s, out)
    broken = judge_shape(robot, seeds_of(p), body, contacts_of(p), judged[0], rules, out, work)
    if broken < 0 and out.judged and p.n_solids > 0:
        place_in_world(robot, body, work, out)
        margins[CLEARANCE] = judge_clearance(p, out)
        if p.hard >> CLEARANCE & 1 and margins[CLEARANCE] < -TOLERANCE:
            broken = CLEARANCE
    if broken >= 0:
        return broken
    broken = judge_swing(p, before, limb, s.hold[limb], margins)
    if broken >= 0:
        return broken
    weigh_known(p)
    work.bears[limb] = 0
    broken = judge_forces(robot, rules, out, work)
    if broken >= 0:
        return broken
    work.bears[limb] = 1
    broken = judge_forces(robot, rules, out, work)
    if broken < 0:
        keep_judged(p, s, out, True)
        for k in range(CLEARANCE):
            lessen(margins, k, out.margins[k])
    return broken
