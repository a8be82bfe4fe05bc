"""Judging a stance: posture of every limb, and the signed margin of every check."""

import math

from ....compiled import inlined, kernel
from ....planning.problem.check import TOLERANCE, UNLIMITED
from .alignment_kernels import reach_aligned
from .checks import EQUILIBRIUM, JOINT, JUMP, LIMB_BODY, LIMB_LIMB, REACH, TILT
from .collision_kernels import body_gap, limbs_gap
from .equilibrium_kernels import balance_forces, contact_frame, fill_levers
from .gravity_kernels import base_weight, limb_weight
from .kinematics_kernels import limb_frames, reach_point, stretched_beyond, tip_jacobian
from .records import CHECKS_OF_STANCE, PATH_PARTS, PATH_POINTS
from .seeds_kernels import seed_beside, seed_index, take_seed

NEAR = 1e-6
"""Where searches of postures end, per size of the robot."""
OTHER_SEEDS = 6
"""Seeds of the cells beside that a limb that has to be aligned is tried from where its own fails."""
OFF = 0.15
"""Share of a lifted path in which the tip only lifts, and in which it only comes down [-]."""
RISE = 0.4
"""Share of it in which the tip rises, and in which it sinks [-]."""
KEPT_LIFT = 0.5
"""Share of its lift that a tip keeps over solids on its way [-]: the rest is for bumps, and for a law to stray."""
SHARPEST = 0.1
"""Of an edge that a path goes around, one more than the cosine of its normals [-]."""
PATH_JUMP = 0.5
"""Largest change of a joint from one posture on a lifted path to the next [rad] or [m]: beyond, postures between are solved, too."""
LEAST_STRIDE = 4
"""Parts of a path (`PATH_PARTS`) within which a limb that is aligned may not jump, where others may not within one: it would hurry by a
posture that can't turn its end effector as it is to, and could take another one for the same place behind it."""
PATH_NEAR = 1e-4
PATH_REACHED = 1e-3
"""Per size of the robot."""


@inlined
def into_base(rotation, x, y, z, to):
    """A world vector in the base frame."""
    to[0] = rotation[0] * x + rotation[3] * y + rotation[6] * z
    to[1] = rotation[1] * x + rotation[4] * y + rotation[7] * z
    to[2] = rotation[2] * x + rotation[5] * y + rotation[8] * z


@kernel
def aim_limb(body, place, normal, limb, work):
    """Target and normal of a limb in the base frame, from the world's."""
    x, y, z = place[0] - body.place[0], place[1] - body.place[1], place[2] - body.place[2]
    into_base(body.rotation, x, y, z, work.target[limb])
    into_base(body.rotation, normal[0], normal[1], normal[2], work.normal[limb])


@kernel
def solve_limb(robot, tables, limb, work):
    """Posture of a limb for its target in `work`, from the table's seed alone.

    Returns:
        Error left [m] (`reach_point`, `reach_aligned`), or what the tip is farther from a joint than it may be, if that is more; infinity
        where the table has no seed.
    """
    index = seed_index(robot, tables, limb, work)
    if index < 0:
        return math.inf
    near = NEAR * robot.size
    take_seed(robot, tables, limb, index, work)
    if not robot.aligned[limb]:
        error = reach_point(robot, limb, work, near)
        return max(error, stretched_beyond(robot, limb, work))
    error = reach_aligned(robot, limb, work, near)
    for side in range(1, 1 + OTHER_SEEDS):  # most often a wrist at its limit, which has another branch beside it
        if error < near:
            break
        other = seed_beside(tables, limb, index, side)
        if other >= 0:
            take_seed(robot, tables, limb, other, work)
            error = reach_aligned(robot, limb, work, near)
    return max(error, stretched_beyond(robot, limb, work))


@kernel
def tilt_of(limb, work):
    """Angle of a limb's end effector from the inward normal [rad]."""
    end = work.tip_turn[limb]
    normal = work.normal[limb]
    cosine = -(end[2] * normal[0] + end[5] * normal[1] + end[8] * normal[2])
    return math.acos(min(1.0, max(-1.0, cosine)))


@kernel
def limb_in_world(robot, body, limb, origin, to):
    """A limb's joints and tip in the world frame, from the base frame."""
    r = body.rotation
    for k in range(robot.n_joints[limb] + 1):
        p = origin[k]
        for a in range(3):
            to[k, a] = body.place[a] + r[3 * a] * p[0] + r[3 * a + 1] * p[1] + r[3 * a + 2] * p[2]


@kernel
def place_in_world(robot, body, work, out):
    """Origins of all joints and tips in the world frame (`origin` of `out`), after the limbs were solved."""
    for limb in range(robot.n_limbs):
        limb_in_world(robot, body, limb, work.origin[limb], out.origin[limb])


@inlined
def violated(rules, margins, check):
    """Whether a hard check is violated."""
    return rules.hard >> check & 1 == 1 and not margins[check] >= -TOLERANCE


@kernel
def judge_postures(robot, tables, body, contacts, before, rules, out, work):
    """Solve all limbs: margins `reach`, `joint`, `tilt` and `jump`; false as soon as a limb does not reach its hold."""
    margins = out.margins
    reach, joint, tilt, jump = UNLIMITED, UNLIMITED, UNLIMITED, UNLIMITED
    for limb in range(robot.n_limbs):
        contact = contacts[limb]
        aim_limb(body, contact.place, contact.normal, limb, work)
        if contact.known:
            error = contact.error
            for k in range(robot.n_joints[limb]):
                work.posture[limb, k] = out.posture[limb, k]
            limb_frames(robot, limb, work)
            tip_jacobian(robot, limb, work)
        else:
            error = solve_limb(robot, tables, limb, work)
        reach = min(reach, rules.reach * robot.size - error)
        if reach < -TOLERANCE:
            margins[REACH] = max(reach, -UNLIMITED)
            return False
        most = rules.jump_moved if contact.moved else rules.jump
        for k in range(robot.n_joints[limb]):
            q = work.posture[limb, k]
            out.posture[limb, k] = q
            joint = min(joint, q - robot.lower[limb, k], robot.upper[limb, k] - q)
            if before.judged:
                jump = min(jump, most - abs(q - before.posture[limb, k]))
        bears = contact.bears
        work.bears[limb] = bears
        if bears:
            work.friction[limb] = min(robot.friction[limb], contact.friction)
            pull = robot.pull[limb]
            if robot.tilt[limb] < math.inf or robot.tilt_loss[limb] > 0.0:
                angle = tilt_of(limb, work)
                tilt = min(tilt, robot.tilt[limb] - angle)
                pull *= max(0.0, 1.0 - robot.tilt_loss[limb] * angle)
            work.pull[limb] = min(pull, contact.strength)
            contact_frame(robot, contact, body.rotation, limb, work)
    margins[REACH] = reach
    margins[JOINT] = joint - rules.joint_room
    margins[TILT] = tilt
    margins[JUMP] = jump
    return True


@kernel
def judge_shape(robot, tables, body, contacts, before, rules, out, work):
    """All checks of a stance that forces don't matter to, as `judge` takes and tells them; `out.judged` is 0 if a limb does not reach."""
    margins = out.margins
    for check in range(CHECKS_OF_STANCE):
        margins[check] = math.nan
    out.judged = 0
    out.s = math.nan
    if not judge_postures(robot, tables, body, contacts, before, rules, out, work):
        return REACH
    out.judged = 1
    first = -1
    for check in range(JOINT, LIMB_LIMB):
        if violated(rules, margins, check) and first < 0:
            first = check
    if first >= 0 and not rules.exact:
        return first
    margins[LIMB_LIMB] = limbs_gap(robot, work.origin, -1, UNLIMITED) - robot.limb_room
    if violated(rules, margins, LIMB_LIMB) and first < 0:
        first = LIMB_LIMB
        if not rules.exact:
            return first
    margins[LIMB_BODY] = body_gap(robot, work.origin, -1, UNLIMITED)
    if violated(rules, margins, LIMB_BODY) and first < 0:
        first = LIMB_BODY
    return first


@kernel
def weigh(robot, body, work):
    """What acts on base and limbs in the postures that `work` has: gravity, the wrench on the base, the motors' loads and levers."""
    into_base(body.rotation, body.gravity[0], body.gravity[1], body.gravity[2], work.gravity)
    w = body.wrench
    into_base(body.rotation, w[0], w[1], w[2], work.wrench[:3])
    into_base(body.rotation, w[3], w[4], w[5], work.wrench[3:])
    base_weight(robot, work)
    for limb in range(robot.n_limbs):
        limb_weight(robot, limb, work)
    fill_levers(robot, work)


@kernel
def judge_forces(robot, rules, out, work):
    """The checks from `equilibrium` on, after `weigh`, for the limbs that `bears` of `work` names; the first violated hard check, or -1."""
    balance_forces(robot, work, rules, out)
    for check in range(EQUILIBRIUM, CHECKS_OF_STANCE):
        if violated(rules, out.margins, check):
            return check
    return -1


@kernel
def judge(robot, tables, body, contacts, before, rules, out, work):
    """All margins of a stance. The posture depends on the stance alone, not on how the robot came there.

    Args:
        robot: Record of `ROBOT`.
        tables: Record of `SEEDS`.
        body: Record of `BODY`.
        contacts: Records of `CONTACT`, shape (n_limbs,).
        before: Record of `JUDGED`, or any with such a `posture` and `judged`: the stance before; `judged` is 0 if there is none.
        rules: Record of `RULES`.
        out: Record of `JUDGED` that is written. Margins behind the check that ended the judging are NaN.
        work: Record of `WORK`.

    Returns:
        Number of the first hard check that is violated (`checks.STANCE_CHECKS`), -1 if none is. With `exact` rules all margins are
        written, unless a limb does not reach its hold.
    """
    first = judge_shape(robot, tables, body, contacts, before, rules, out, work)
    if not out.judged or (first >= 0 and not rules.exact):
        out.judged = 0
        return first
    weigh(robot, body, work)
    broken = judge_forces(robot, rules, out, work)
    place_in_world(robot, body, work, out)
    r = body.rotation
    m = work.moments
    for a in range(3):
        out.centre[a] = body.place[a] + (r[3 * a] * m[1] + r[3 * a + 1] * m[2] + r[3 * a + 2] * m[3]) / m[0]
    return first if first >= 0 else broken


@inlined
def smooth(u):
    """Quintic from 0 to 1 with no speed and no acceleration at its ends."""
    u = min(1.0, max(0.0, u))
    return u * u * u * (10.0 - 15.0 * u + 6.0 * u * u)


@kernel
def lift_over(start, end, first, last, lift, up):
    """Write how far a path between two places is lifted off the straight line at its highest, along the mean of their normals.

    Where each place lies behind the other's surface, as on both sides of an edge, the path is that much higher that it passes the edge with
    `KEPT_LIFT` of its lift.

    Args:
        start, end: The places [m].
        first, last: Their normals, out of the surfaces.
        lift: Height over a plane [m].
        up: Output, shape (3,).
    """
    behind, before, cosine = 0.0, 0.0, 0.0
    for a in range(3):
        way = end[a] - start[a]
        behind -= first[a] * way
        before += last[a] * way
        cosine += first[a] * last[a]
    if behind > 0.0 and before > 0.0 and 1.0 + cosine > SHARPEST:
        lift += max(0.0, max(behind, before) / (1.0 + cosine) - (1.0 - KEPT_LIFT) * lift)
    for a in range(3):
        up[a] = 0.5 * lift * (first[a] + last[a])


@inlined
def lifted_share(u):
    """Share of its lift that a path has at the share u of its way."""
    return smooth((u if u < 0.5 else 1.0 - u) / RISE)


@kernel
def path_point(start, end, up, u, to):
    """Place of a lifted tip [m] at the share u of its way between two contacts (`CONTACT`): off along the normals first, on last."""
    along = smooth((u - OFF) / (1.0 - 2.0 * OFF))
    height = lifted_share(u)
    for a in range(3):
        to[a] = start.place[a] + along * (end.place[a] - start.place[a]) + height * up[a]


@kernel
def follow_path(robot, body, limb, swing, up, u, work):
    """Solve a limb at one point of the lifted path between two contacts (`path_point`), from the posture in `work`, which it replaces.

    An aligned limb also turns its end effector from the one inward normal to the other.

    Args:
        robot: Record of `ROBOT`.
        body: Record of `BODY`.
        limb: Index of the limb.
        swing: Two records of `CONTACT`: where it is and where it goes.
        up: How far the path is lifted (`lift_over`).
        u: Share of the path from 0 to 1.
        work: Record of `WORK`; afterwards `origin` has the limb's joints in the base frame.

    Returns:
        Error left [m].
    """
    place = work.full[:3]
    normal = work.entering[:3]
    path_point(swing[0], swing[1], up, u, place)
    square = 0.0
    for a in range(3):
        normal[a] = swing[0].normal[a] + smooth(u) * (swing[1].normal[a] - swing[0].normal[a])
        square += normal[a] * normal[a]
    scale = 1.0 / math.sqrt(square) if square > 1e-12 else 0.0
    for a in range(3):
        normal[a] = normal[a] * scale if scale > 0.0 else swing[0].normal[a]
    aim_limb(body, place, normal, limb, work)
    near = PATH_NEAR * robot.size
    return reach_aligned(robot, limb, work, near) if robot.aligned[limb] else reach_point(robot, limb, work, near)


@inlined
def keep_way(robot, limb, work):
    """Put where the joints of a limb are behind what there is of its way."""
    for k in range(robot.n_joints[limb] + 1):
        for a in range(3):
            work.way[work.n_way, k, a] = work.origin[limb, k, a]
    work.n_way += 1


@kernel
def swing_reach(robot, tables, body, limb, swing, before, lift, work):
    """How well a limb's tip follows the lifted path between two contacts, from its posture before to that of the stance it goes to.

    Where postures are free, as those of more joints than the path needs, they lean to the last one.

    Args:
        robot: Record of `ROBOT`.
        tables: Record of `SEEDS`.
        body: Record of `BODY`.
        limb: Index of the limb.
        swing: Two records of `CONTACT`: where it is and where it goes.
        before: Record of `JUDGED`, or any with such a `posture`: the limb's at the first contact.
        lift: Height of the path [m].
        work: Record of `WORK`; afterwards it describes the limb at the last point that was solved, and `way` has the joints at the
            start and at each of them.

    Returns:
        Distance that counts as reached less the largest error of the points [m]; where a joint would have to jump, what is missing of
        `PATH_JUMP`, negative. The points behind a violated one are not looked at.
    """
    n = robot.n_joints[limb]
    posture, last, goal, up = work.posture[limb], work.price, work.solution, work.six[:3]
    aim_limb(body, swing[1].place, swing[1].normal, limb, work)
    solve_limb(robot, tables, limb, work)
    for k in range(n):
        goal[k] = posture[k]
        posture[k] = before.posture[limb, k]
    limb_frames(robot, limb, work)
    work.n_way = 0
    keep_way(robot, limb, work)
    lift_over(swing[0].place, swing[1].place, swing[0].normal, swing[1].normal, lift, up)
    room, parts, at = PATH_REACHED * robot.size, PATH_PARTS * PATH_POINTS, 0
    least = LEAST_STRIDE if robot.aligned[limb] else 1
    while at < parts:
        for k in range(n):
            last[k] = posture[k]
        stride = PATH_PARTS - at % PATH_PARTS
        while True:
            share = stride / (parts - at)
            for k in range(n):
                posture[k] = last[k] + share * (goal[k] - last[k])
            error = follow_path(robot, body, limb, swing, up, (at + stride) / parts, work)
            jump = 0.0
            for k in range(n):
                jump = max(jump, abs(posture[k] - last[k]))
            if jump <= PATH_JUMP or stride <= least:
                break
            stride = (stride + 1) >> 1
        if jump > PATH_JUMP:
            return PATH_JUMP - jump
        room = min(room, PATH_REACHED * robot.size - error)
        if room < 0.0:
            return room
        at += stride
        keep_way(robot, limb, work)
    return room


@kernel
def judge_each(robot, tables, stances, before, rules, work):
    """Judge stances (bodies, contacts, what is written, reasons) from one stance before (`judge`)."""
    bodies, contacts, out, reasons = stances
    for i in range(len(bodies)):
        reasons[i] = judge(robot, tables, bodies[i], contacts[i], before, rules, out[i], work)
