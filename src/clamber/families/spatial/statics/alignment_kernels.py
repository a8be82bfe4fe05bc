"""Inverse kinematics of limbs whose end effector must also point into the surface: five constraints, any turn about the normal."""

import math

from ....compiled import kernel
from .kinematics_kernels import DAMPING, LARGEST_STEP, MOST_STEPS, STALLED, limb_frames, tip_jacobian

ARM = 0.3
"""Length that an angle is weighed by, per size of the robot: an error of 1 rad counts as this distance."""
ROWS = 5


@kernel
def task_error(robot, limb, work):
    """Error of tip and direction in `task` (position, then rotation about two tangents, times `ARM`), and its Jacobian.

    Returns:
        Length of the error [m].
    """
    n = robot.n_joints[limb]
    arm = ARM * robot.size
    normal = work.normal[limb]
    a, b, c = -normal[0], -normal[1], -normal[2]
    if abs(a) < 0.7:
        u, v, w = 0.0, c, -b
    else:
        u, v, w = -c, 0.0, a
    scale = 1.0 / math.sqrt(u * u + v * v + w * w)
    u, v, w = u * scale, v * scale, w * scale
    p, q, r = b * w - c * v, c * u - a * w, a * v - b * u
    end = work.tip_turn[limb]
    x, y, z = end[2], end[5], end[8]
    rx, ry, rz = y * c - z * b, z * a - x * c, x * b - y * a
    if x * a + y * b + z * c < 0.0:  # more than a quarter turn away: as fast as for a quarter
        sine = math.sqrt(rx * rx + ry * ry + rz * rz)
        if sine < 1e-9:
            rx, ry, rz, sine = u, v, w, 1.0
        rx, ry, rz = rx / sine, ry / sine, rz / sine
    task = work.task
    for i in range(3):
        task[i] = work.target[limb, i] - work.origin[limb, n, i]
    task[3] = arm * (rx * u + ry * v + rz * w)
    task[4] = arm * (rx * p + ry * q + rz * r)
    for k in range(n):
        row = work.task_jacobian[k]
        for i in range(3):
            row[i] = work.jacobian[limb, k, i]
        turns = arm * (1 - robot.sliding[limb, k])
        axis = work.axis[limb, k]
        row[3] = turns * (axis[0] * u + axis[1] * v + axis[2] * w)
        row[4] = turns * (axis[0] * p + axis[1] * q + axis[2] * r)
    total = 0.0
    for i in range(ROWS):
        total += task[i] * task[i]
    return math.sqrt(total)


@kernel
def solve_normal(work, n, stuck, damping):
    """Damped least-squares multipliers of the joints that are not `stuck` (bits), in `task`'s place of `full`: false if singular."""
    matrix = work.normal_matrix
    trace = 0.0
    for i in range(ROWS):
        for j in range(i + 1):
            total = 0.0
            for k in range(n):
                if not stuck >> k & 1:
                    total += work.task_jacobian[k, i] * work.task_jacobian[k, j]
            matrix[i, j] = total
        trace += matrix[i, i]
    for i in range(ROWS):
        matrix[i, i] += damping * trace + 1e-15
    for j in range(ROWS):
        for i in range(j, ROWS):
            total = matrix[i, j]
            for k in range(j):
                total -= matrix[i, k] * matrix[j, k]
            if i == j:
                if total <= 0.0:
                    return False
                matrix[j, j] = math.sqrt(total)
            else:
                matrix[i, j] = total / matrix[j, j]
    full = work.full
    for i in range(ROWS):
        total = work.task[i]
        for k in range(i):
            total -= matrix[i, k] * full[k]
        full[i] = total / matrix[i, i]
    for i in range(ROWS - 1, -1, -1):
        total = full[i]
        for k in range(i + 1, ROWS):
            total -= matrix[k, i] * full[k]
        full[i] = total / matrix[i, i]
    return True


@kernel
def reach_aligned(robot, limb, work, near):
    """As `reach_point`, with the end effector's z along the inward normal; the error left counts 1 rad as `ARM` times the size [m]."""
    n = robot.n_joints[limb]
    lower = robot.lower[limb]
    upper = robot.upper[limb]
    posture = work.posture[limb]
    far = 0.02 * robot.size
    last = math.inf
    for attempt in range(MOST_STEPS + 1):
        limb_frames(robot, limb, work)
        tip_jacobian(robot, limb, work)
        error = task_error(robot, limb, work)
        if error < near or attempt == MOST_STEPS or (attempt > 7 and error > STALLED * last):
            return error
        last = error
        stuck = 0
        for _ in range(3):
            if not solve_normal(work, n, stuck, DAMPING * (1e3 if error > far else 1.0)):
                return error
            now = stuck
            for k in range(n):
                step = 0.0
                for i in range(ROWS):
                    step += work.task_jacobian[k, i] * work.full[i]
                work.step[k] = step
                if (posture[k] <= lower[k] and step < 0.0) or (posture[k] >= upper[k] and step > 0.0):
                    now |= 1 << k
            if now == stuck:
                break
            stuck = now
        for k in range(n):
            if not stuck >> k & 1:
                step = min(LARGEST_STEP, max(-LARGEST_STEP, work.step[k]))
                posture[k] = min(upper[k], max(lower[k], posture[k] + step))
    return last
