"""Kinematics of one limb: frames of its links, Jacobians, inverse kinematics by damped least squares within the joints' limits."""

import math

from ....compiled import kernel

MOST_STEPS = 20
LARGEST_STEP = 0.6
"""Of a joint in one step of a search [rad]."""
DAMPING = 1e-6
"""Of the squared Jacobian, per its trace."""
STALLED = 0.97
"""A step that leaves more than this of the error after a few others ends the search."""


@kernel
def limb_frames(robot, limb, work):
    """Frames of a limb's links, its joints' axes and its tip in the base frame, for the posture in `work`."""
    n = robot.n_joints[limb]
    r0, r1, r2, r3, r4, r5, r6, r7, r8 = 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0
    x, y, z = 0.0, 0.0, 0.0
    offset = robot.offset[limb]
    rotation = robot.rotation[limb]
    turn = work.turn[limb]
    origin = work.origin[limb]
    axis = work.axis[limb]
    for k in range(n + 1):
        a, b, c = offset[k, 0], offset[k, 1], offset[k, 2]
        x += r0 * a + r1 * b + r2 * c
        y += r3 * a + r4 * b + r5 * c
        z += r6 * a + r7 * b + r8 * c
        q0, q1, q2 = rotation[k, 0], rotation[k, 1], rotation[k, 2]
        q3, q4, q5 = rotation[k, 3], rotation[k, 4], rotation[k, 5]
        q6, q7, q8 = rotation[k, 6], rotation[k, 7], rotation[k, 8]
        s0, s1, s2 = r0 * q0 + r1 * q3 + r2 * q6, r0 * q1 + r1 * q4 + r2 * q7, r0 * q2 + r1 * q5 + r2 * q8
        s3, s4, s5 = r3 * q0 + r4 * q3 + r5 * q6, r3 * q1 + r4 * q4 + r5 * q7, r3 * q2 + r4 * q5 + r5 * q8
        s6, s7, s8 = r6 * q0 + r7 * q3 + r8 * q6, r6 * q1 + r7 * q4 + r8 * q7, r6 * q2 + r7 * q5 + r8 * q8
        if k == n:
            end = work.tip_turn[limb]
            end[0], end[1], end[2], end[3], end[4], end[5], end[6], end[7], end[8] = s0, s1, s2, s3, s4, s5, s6, s7, s8
        else:
            value = work.posture[limb, k]
            axis[k, 0], axis[k, 1], axis[k, 2] = s2, s5, s8
            if robot.sliding[limb, k] == 0:
                cq, sq = math.cos(value), math.sin(value)
                r0, r1 = s0 * cq + s1 * sq, s1 * cq - s0 * sq
                r3, r4 = s3 * cq + s4 * sq, s4 * cq - s3 * sq
                r6, r7 = s6 * cq + s7 * sq, s7 * cq - s6 * sq
            else:
                r0, r1, r3, r4, r6, r7 = s0, s1, s3, s4, s6, s7
                x += s2 * value
                y += s5 * value
                z += s8 * value
            r2, r5, r8 = s2, s5, s8
            link = turn[k]
            link[0], link[1], link[2], link[3], link[4] = r0, r1, r2, r3, r4
            link[5], link[6], link[7], link[8] = r5, r6, r7, r8
        origin[k, 0], origin[k, 1], origin[k, 2] = x, y, z


@kernel
def tip_jacobian(robot, limb, work):
    """Motion of a limb's tip per joint in the base frame (`jacobian`); its rotation per hinge is the hinge's axis."""
    n = robot.n_joints[limb]
    origin = work.origin[limb]
    axis = work.axis[limb]
    jacobian = work.jacobian[limb]
    x, y, z = origin[n, 0], origin[n, 1], origin[n, 2]
    for k in range(n):
        a, b, c = axis[k, 0], axis[k, 1], axis[k, 2]
        if robot.sliding[limb, k] == 0:
            dx, dy, dz = x - origin[k, 0], y - origin[k, 1], z - origin[k, 2]
            jacobian[k, 0], jacobian[k, 1], jacobian[k, 2] = b * dz - c * dy, c * dx - a * dz, a * dy - b * dx
        else:
            jacobian[k, 0], jacobian[k, 1], jacobian[k, 2] = a, b, c


@kernel
def reach_point(robot, limb, work, near):
    """Search the posture of a limb whose tip is at its target, from the posture in `work`, which it replaces.

    Damped least squares with projected limits: joints that a step would push past a limit are left out of it.

    Args:
        robot: Record of `ROBOT`.
        limb: Index of the limb.
        work: Scratch with `posture` and `target` of the limb.
        near: Distance that counts as there [m].

    Returns:
        Distance of tip and target that is left [m]; frames and Jacobian in `work` are those of the posture found.
    """
    n = robot.n_joints[limb]
    lower = robot.lower[limb]
    upper = robot.upper[limb]
    posture = work.posture[limb]
    origin = work.origin[limb]
    jacobian = work.jacobian[limb]
    far = 0.02 * robot.size
    last = math.inf
    for attempt in range(MOST_STEPS):
        limb_frames(robot, limb, work)
        tip_jacobian(robot, limb, work)
        ex = work.target[limb, 0] - origin[n, 0]
        ey = work.target[limb, 1] - origin[n, 1]
        ez = work.target[limb, 2] - origin[n, 2]
        error = math.sqrt(ex * ex + ey * ey + ez * ez)
        if error < near or (attempt > 5 and error > STALLED * last):
            return error
        last = error
        stuck = 0
        y0, y1, y2 = 0.0, 0.0, 0.0
        for _ in range(3):
            a00, a01, a02, a11, a12, a22 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
            for k in range(n):
                if stuck >> k & 1:
                    continue
                j0, j1, j2 = jacobian[k, 0], jacobian[k, 1], jacobian[k, 2]
                a00 += j0 * j0
                a01 += j0 * j1
                a02 += j0 * j2
                a11 += j1 * j1
                a12 += j1 * j2
                a22 += j2 * j2
            damping = DAMPING * (a00 + a11 + a22)
            if error > far:
                damping *= 1e3
            damping += 1e-15
            a00 += damping
            a11 += damping
            a22 += damping
            c00, c01, c02 = a11 * a22 - a12 * a12, a02 * a12 - a01 * a22, a01 * a12 - a02 * a11
            c11, c12, c22 = a00 * a22 - a02 * a02, a01 * a02 - a00 * a12, a00 * a11 - a01 * a01
            determinant = a00 * c00 + a01 * c01 + a02 * c02
            if determinant <= 0.0:
                return error
            scale = 1.0 / determinant
            y0 = (c00 * ex + c01 * ey + c02 * ez) * scale
            y1 = (c01 * ex + c11 * ey + c12 * ez) * scale
            y2 = (c02 * ex + c12 * ey + c22 * ez) * scale
            now = stuck
            for k in range(n):
                step = jacobian[k, 0] * y0 + jacobian[k, 1] * y1 + jacobian[k, 2] * y2
                if (posture[k] <= lower[k] and step < 0.0) or (posture[k] >= upper[k] and step > 0.0):
                    now |= 1 << k
            if now == stuck:
                break
            stuck = now
        for k in range(n):
            if not stuck >> k & 1:
                step = jacobian[k, 0] * y0 + jacobian[k, 1] * y1 + jacobian[k, 2] * y2
                step = min(LARGEST_STEP, max(-LARGEST_STEP, step))
                posture[k] = min(upper[k], max(lower[k], posture[k] + step))
    limb_frames(robot, limb, work)
    tip_jacobian(robot, limb, work)
    ex = work.target[limb, 0] - origin[n, 0]
    ey = work.target[limb, 1] - origin[n, 1]
    ez = work.target[limb, 2] - origin[n, 2]
    return math.sqrt(ex * ex + ey * ey + ez * ez)


@kernel
def stretched_beyond(robot, limb, work):
    """How much farther from its joints a limb's tip is than it may be [m], not below 0."""
    n, beyond = robot.n_joints[limb], 0.0
    tip = work.origin[limb, n]
    for k in range(n - 1):
        if robot.farthest[limb, k] < math.inf:
            joint = work.origin[limb, k]
            x, y, z = tip[0] - joint[0], tip[1] - joint[1], tip[2] - joint[2]
            beyond = max(beyond, math.sqrt(x * x + y * y + z * z) - robot.farthest[limb, k])
    return beyond
