"""Kernels of the planar 3-RPR mechanism: lengths of the actuators, their derivatives, and the branch that is followed.

Everywhere `delta` and `y` are the attachments of the Delta-frame and the Y-frame, each in its own frame, shape (3, 2) [m]; a pose is
that of the Y-frame in the Delta-frame: x, y [m], theta [rad]. L_i = |p + R(theta) B_i - A_i|.
"""

import math

from ....compiled import inlined, kernel

FOUND, SINGULAR = 0, 1
"""How following a branch ends."""
ROUNDS = 400
"""Pieces of a way at most; each is as long as the branch is provably unique on it, so only a singular end takes as many."""
POLISH = 12
"""Newton steps at most within a piece: they converge quadratically."""


@inlined
def actuator_lengths(delta, y, pose_x, pose_y, theta, lengths):
    """Write the actuators' lengths, shape (3,) [m]."""
    c = math.cos(theta)
    s = math.sin(theta)
    for i in range(3):
        across = pose_x + c * y[i, 0] - s * y[i, 1] - delta[i, 0]
        up = pose_y + s * y[i, 0] + c * y[i, 1] - delta[i, 1]
        lengths[i] = math.sqrt(across * across + up * up)


@inlined
def length_jacobian(delta, y, pose_x, pose_y, theta, lengths, jacobian):
    """Write the lengths, shape (3,) [m], and their derivatives by x, y, theta, shape (3, 3); every length must be more than 0.

    A row is the actuator's direction u_i and its moment (R B_i) x u_i about the Y-frame's origin.
    """
    c = math.cos(theta)
    s = math.sin(theta)
    for i in range(3):
        arm_x = c * y[i, 0] - s * y[i, 1]
        arm_y = s * y[i, 0] + c * y[i, 1]
        across = pose_x + arm_x - delta[i, 0]
        up = pose_y + arm_y - delta[i, 1]
        length = math.sqrt(across * across + up * up)
        lengths[i] = length
        jacobian[i, 0] = across / length
        jacobian[i, 1] = up / length
        jacobian[i, 2] = (arm_x * up - arm_y * across) / length


@inlined
def singular_measure(delta, y, pose_x, pose_y, theta):
    """Determinant of the Jacobian times the three lengths [m^4]: zero where the mechanism is singular, finite where a length is zero.

    Its sign tells the two kinds of assembly apart. At constant theta it is a polynomial of degree two in x and y.
    """
    c = math.cos(theta)
    s = math.sin(theta)
    a = (pose_x + c * y[0, 0] - s * y[0, 1] - delta[0, 0], pose_y + s * y[0, 0] + c * y[0, 1] - delta[0, 1])
    b = (pose_x + c * y[1, 0] - s * y[1, 1] - delta[1, 0], pose_y + s * y[1, 0] + c * y[1, 1] - delta[1, 1])
    d = (pose_x + c * y[2, 0] - s * y[2, 1] - delta[2, 0], pose_y + s * y[2, 0] + c * y[2, 1] - delta[2, 1])
    moment_a = (c * y[0, 0] - s * y[0, 1]) * a[1] - (s * y[0, 0] + c * y[0, 1]) * a[0]
    moment_b = (c * y[1, 0] - s * y[1, 1]) * b[1] - (s * y[1, 0] + c * y[1, 1]) * b[0]
    moment_d = (c * y[2, 0] - s * y[2, 1]) * d[1] - (s * y[2, 0] + c * y[2, 1]) * d[0]
    return (
        moment_a * (b[0] * d[1] - b[1] * d[0])
        + moment_b * (d[0] * a[1] - d[1] * a[0])
        + moment_d * (a[0] * b[1] - a[1] * b[0])
    )


@inlined
def invert(matrix, inverse):
    """Write the inverse of a 3x3 matrix; return its determinant, 0 for none."""
    for i in range(3):
        j = (i + 1) % 3
        k = (i + 2) % 3
        for row in range(3):
            after = (row + 1) % 3
            last = (row + 2) % 3
            inverse[row, i] = matrix[j, after] * matrix[k, last] - matrix[j, last] * matrix[k, after]
    determinant = matrix[0, 0] * inverse[0, 0] + matrix[0, 1] * inverse[1, 0] + matrix[0, 2] * inverse[2, 0]
    if determinant != 0.0:
        for i in range(3):
            for j in range(3):
                inverse[i, j] /= determinant
    return determinant


@inlined
def newton_step(inverse, lengths, aim, scale, change):
    """Write the change of pose (its angle times `scale`, so that all are [m]) that would close the gap; return its size [m]."""
    for k in range(3):
        change[k] = 0.0
        for i in range(3):
            change[k] += inverse[k, i] * (aim[i] - lengths[i])
    change[2] *= scale
    return math.sqrt(change[0] * change[0] + change[1] * change[1] + change[2] * change[2])


@kernel
def follow_branch(delta, y, aim, pose, room):
    """Move `pose` to where the lengths are `aim`, on its own assembly branch, as the mechanism would on a straight way of lengths.

    Each piece of the way is as long as Kantorovich's theorem allows Newton's method from its start: beta K eta <= 1/2, with the inverse
    Jacobian's norm beta, its first step's size eta, and K bounding the curvature of the lengths in the ball in question. On such a piece
    the solution is one continuous curve, so no other branch is ever taken.

    Args:
        delta, y: The attachments.
        aim: Lengths to reach, shape (3,) [m].
        pose: Where the mechanism is, shape (3,); becomes where it gets to.
        room: Scratch, shape (9, 3).

    Returns:
        FOUND, or SINGULAR where the way of lengths ends at a singular pose; `pose` is then near that.
    """
    lengths = room[0]
    target = room[1]
    change = room[2]
    jacobian = room[3:6]
    inverse = room[6:9]
    scale = 0.0
    for i in range(3):
        scale = max(scale, math.sqrt(y[i, 0] * y[i, 0] + y[i, 1] * y[i, 1]))
    size = max(scale, max(aim[0], max(aim[1], aim[2])))
    close = 4e-16 * size
    for _ in range(ROUNDS):
        length_jacobian(delta, y, pose[0], pose[1], pose[2], lengths, jacobian)
        gap = max(abs(aim[0] - lengths[0]), max(abs(aim[1] - lengths[1]), abs(aim[2] - lengths[2])))
        if gap <= close:
            return FOUND
        least = min(lengths[0], min(lengths[1], lengths[2]))
        if least <= 0.0 or scale <= 0.0 or invert(jacobian, inverse) == 0.0:
            return SINGULAR
        eta = newton_step(inverse, lengths, aim, scale, change)
        beta = 0.0
        for i in range(3):
            beta += inverse[0, i] * inverse[0, i] + inverse[1, i] * inverse[1, i]
            beta += inverse[2, i] * inverse[2, i] * scale * scale
        curvature = 0.0
        for i in range(3):
            bend = 4.0 / lengths[i] + 1.0 / scale  # for lengths down to half of what they are
            curvature += bend * bend
        share = min(1.0, 0.5 / (math.sqrt(beta * curvature) * eta))
        share = min(
            share, 0.17 * least / eta
        )  # within 2 eta no length loses more than half: 2 sqrt(2) share eta <= least / 2
        if share < 1e-9:
            return SINGULAR
        for i in range(3):
            target[i] = lengths[i] + share * (aim[i] - lengths[i])
        step = math.inf
        for _ in range(POLISH):
            if invert(jacobian, inverse) == 0.0:
                return SINGULAR
            now = newton_step(inverse, lengths, target, scale, change)
            if now >= 0.5 * step:  # rounding is all that is left
                break
            step = now
            pose[0] += change[0]
            pose[1] += change[1]
            pose[2] += change[2] / scale
            if now <= close:
                break
            length_jacobian(delta, y, pose[0], pose[1], pose[2], lengths, jacobian)
        if share == 1.0:
            return FOUND
    return SINGULAR
