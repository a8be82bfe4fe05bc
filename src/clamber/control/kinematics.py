"""Kinematics and dynamics of a serial chain, as kernels: tip, Jacobian, inertia matrix, bias torques, tip acceleration at rest joints.

`frames` holds one row of `FRAME` floats per joint; every kernel here fills or reads it, so each quantity is worked out once a tick.
"""

import math

from ..compiled import inlined, kernel

PLACE = 0
"""Where in a row of `frames` the joint's place lies [m], base frame; the other names likewise."""
TURN = 3
AXIS = 12
SPIN = 15
SPIN_RATE = 18
ACCELERATION = 21
CENTRE = 24
FORCE = 27
MOMENT = 30
FRAME = 33


@inlined
def rotate(turn, start, vector, out, at):
    """out[at:] = R vector, with R's nine entries at turn[start:]."""
    for i in range(3):
        out[at + i] = (
            turn[start + 3 * i] * vector[0] + turn[start + 3 * i + 1] * vector[1] + turn[start + 3 * i + 2] * vector[2]
        )


@inlined
def three(row, at):
    """Three numbers of a row, from `at` on."""
    return row[at], row[at + 1], row[at + 2]


@inlined
def keep_three(row, at, vector):
    """Write them there."""
    for i in range(3):
        row[at + i] = vector[i]


@inlined
def column(matrix, k):
    """A column of three rows."""
    return matrix[0, k], matrix[1, k], matrix[2, k]


@inlined
def plus(a, b):
    """The vector a + b."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@inlined
def less(a, b):
    """The vector a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@inlined
def scaled(factor, a):
    """The vector factor a."""
    return factor * a[0], factor * a[1], factor * a[2]


@inlined
def dot(a, b):
    """Scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inlined
def plus_cross(a, b, c):
    """The vector a + b x c."""
    return a[0] + b[1] * c[2] - b[2] * c[1], a[1] + b[2] * c[0] - b[0] * c[2], a[2] + b[0] * c[1] - b[1] * c[0]


@inlined
def cross(b, c):
    """The vector b x c."""
    return b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]


@inlined
def way_between(start, start_at, end, end_at):
    """From a place in one row to a place in another."""
    return end[end_at] - start[start_at], end[end_at + 1] - start[start_at + 1], end[end_at + 2] - start[start_at + 2]


@kernel
def place_chain(joints, root, q, frames, tip):
    """Place every joint and the tip.

    Args:
        joints: Records of `JOINT`, shape (n,).
        root: One record of `ROOT`, shape (1,).
        q: Joint angles [rad], or [m] of sliding joints, shape (n,).
        frames: Filled with place, turn, axis, centre of mass of each joint's link, shape (n, FRAME).
        tip: Filled with the tip's place [m] and turn (nine entries), base frame, shape (12,).
    """
    n = joints.size
    for j in range(n):
        row = frames[j]
        joint = joints[j]
        before = frames[j - 1] if j > 0 else row
        # the joint's frame at zero angle
        for i in range(3):
            if j == 0:
                row[PLACE + i] = joint.place[i]
            else:
                row[PLACE + i] = (
                    before[PLACE + i]
                    + before[TURN + 3 * i] * joint.place[0]
                    + before[TURN + 3 * i + 1] * joint.place[1]
                    + before[TURN + 3 * i + 2] * joint.place[2]
                )
        ax = joint.axis[0]
        ay = joint.axis[1]
        az = joint.axis[2]
        if joint.sliding:
            c = 1.0
            s = 0.0
        else:
            c = math.cos(q[j])
            s = math.sin(q[j])
        v = 1.0 - c
        # Rodrigues' rotation about the axis
        r00 = c + ax * ax * v
        r01 = ax * ay * v - az * s
        r02 = ax * az * v + ay * s
        r10 = ay * ax * v + az * s
        r11 = c + ay * ay * v
        r12 = ay * az * v - ax * s
        r20 = az * ax * v - ay * s
        r21 = az * ay * v + ax * s
        r22 = c + az * az * v
        for i in range(3):
            if j == 0:
                t0 = joint.turn[i, 0]
                t1 = joint.turn[i, 1]
                t2 = joint.turn[i, 2]
            else:
                b0 = before[TURN + 3 * i]
                b1 = before[TURN + 3 * i + 1]
                b2 = before[TURN + 3 * i + 2]
                t0 = b0 * joint.turn[0, 0] + b1 * joint.turn[1, 0] + b2 * joint.turn[2, 0]
                t1 = b0 * joint.turn[0, 1] + b1 * joint.turn[1, 1] + b2 * joint.turn[2, 1]
                t2 = b0 * joint.turn[0, 2] + b1 * joint.turn[1, 2] + b2 * joint.turn[2, 2]
            row[AXIS + i] = t0 * ax + t1 * ay + t2 * az
            row[TURN + 3 * i] = t0 * r00 + t1 * r10 + t2 * r20
            row[TURN + 3 * i + 1] = t0 * r01 + t1 * r11 + t2 * r21
            row[TURN + 3 * i + 2] = t0 * r02 + t1 * r12 + t2 * r22
        if joint.sliding:
            for i in range(3):
                row[PLACE + i] += q[j] * row[AXIS + i]
        rotate(row, TURN, joint.centre, row, CENTRE)
        for i in range(3):
            row[CENTRE + i] += row[PLACE + i]
    last = frames[n - 1]
    end = root[0]
    rotate(last, TURN, end.tip, tip, 0)
    for i in range(3):
        tip[i] += last[PLACE + i]
        for k in range(3):
            tip[3 + 3 * i + k] = (
                last[TURN + 3 * i] * end.tip_turn[0, k]
                + last[TURN + 3 * i + 1] * end.tip_turn[1, k]
                + last[TURN + 3 * i + 2] * end.tip_turn[2, k]
            )


@kernel
def place_tips(joints, root, angles, frames, tip, out):
    """Places of the tip at many rows of joint angles, shape (m, n), into `out`, shape (m, 3); the rest as in `place_chain`."""
    for k in range(angles.shape[0]):
        place_chain(joints, root, angles[k], frames, tip)
        for i in range(3):
            out[k, i] = tip[i]


@kernel
def fill_jacobian(joints, frames, tip, jacobian):
    """Jacobian of the tip's twist in the base frame, from placed frames.

    Args:
        joints: Records of `JOINT`, shape (n,).
        frames: As `place_chain` left them.
        tip: Likewise.
        jacobian: Filled, shape (6, n): linear rows [m/rad], then angular rows [-].
    """
    for j in range(joints.size):
        row = frames[j]
        axis = three(row, AXIS)
        slides = joints[j].sliding
        moved = axis if slides else cross(axis, way_between(row, PLACE, tip, 0))
        for i in range(3):
            jacobian[i, j] = moved[i]
            jacobian[3 + i, j] = 0.0 if slides else axis[i]


@inlined
def _spread(row, joint, vector):
    """R I R^T v: a link's inertia, base frame, on a vector."""
    x, y, z = vector
    lx = row[TURN] * x + row[TURN + 3] * y + row[TURN + 6] * z
    ly = row[TURN + 1] * x + row[TURN + 4] * y + row[TURN + 7] * z
    lz = row[TURN + 2] * x + row[TURN + 5] * y + row[TURN + 8] * z
    hx = joint.inertia[0, 0] * lx + joint.inertia[0, 1] * ly + joint.inertia[0, 2] * lz
    hy = joint.inertia[1, 0] * lx + joint.inertia[1, 1] * ly + joint.inertia[1, 2] * lz
    hz = joint.inertia[2, 0] * lx + joint.inertia[2, 1] * ly + joint.inertia[2, 2] * lz
    return (
        row[TURN] * hx + row[TURN + 1] * hy + row[TURN + 2] * hz,
        row[TURN + 3] * hx + row[TURN + 4] * hy + row[TURN + 5] * hz,
        row[TURN + 6] * hx + row[TURN + 7] * hy + row[TURN + 8] * hz,
    )


@inlined
def _carried(row, way):
    """Acceleration of a point of a joint's link, over a way from the joint."""
    spin = three(row, SPIN)
    turning = plus_cross(three(row, ACCELERATION), three(row, SPIN_RATE), way)
    return plus_cross(turning, spin, cross(spin, way))


@kernel
def accelerate(joints, root, frames, tip, motion, with_gravity, tip_acceleration, torques):
    """Recursive Newton-Euler: torques that give the joints an acceleration, and the tip's acceleration that follows.

    The inertia of motors and gears (`rotor`) counts; damping and friction do not.

    Args:
        joints: Records of `JOINT`, shape (n,).
        root: One record of `ROOT`.
        frames: As `place_chain` left them; the moving columns are filled.
        tip: As `place_chain` left it.
        motion: Joint speeds [rad/s] and accelerations [rad/s^2], shape (n,) each.
        with_gravity: Whether the torques carry the weight.
        tip_acceleration: Filled with J qdd + Jdot qd, shape (6,) [m/s^2], [rad/s^2].
        torques: Filled with M qdd + h (+ g), shape (n,) [N m].
    """
    n = joints.size
    qd, qdd = motion
    g = root[0].gravity
    for j in range(n):
        row = frames[j]
        w = (0.0, 0.0, 0.0)
        u = (0.0, 0.0, 0.0)
        p = (0.0, 0.0, 0.0)
        if j > 0:
            before = frames[j - 1]
            w = three(before, SPIN)
            u = three(before, SPIN_RATE)
            p = _carried(before, way_between(before, PLACE, row, PLACE))
        axis = three(row, AXIS)
        turned = cross(w, axis)
        v = qd[j]
        a = qdd[j]
        for i in range(3):
            if joints[j].sliding:
                row[SPIN + i] = w[i]
                row[SPIN_RATE + i] = u[i]
                row[ACCELERATION + i] = p[i] + (a * axis[i] + 2.0 * v * turned[i])
            else:
                row[SPIN + i] = w[i] + v * axis[i]
                row[SPIN_RATE + i] = u[i] + (a * axis[i] + v * turned[i])
                row[ACCELERATION + i] = p[i]
    last = frames[n - 1]
    keep_three(tip_acceleration, 0, _carried(last, way_between(last, PLACE, tip, 0)))
    keep_three(tip_acceleration, 3, three(last, SPIN_RATE))
    _carry_back(joints, g, frames, with_gravity, torques)
    for j in range(n):
        torques[j] += joints[j].rotor * qdd[j]


@inlined
def _carry_back(joints, g, frames, with_gravity, torques):
    """The inward half of Newton-Euler: forces and moments from the tip to the base, and each joint's part of them."""
    n = joints.size
    weight = 1.0 if with_gravity else 0.0
    for j in range(n - 1, -1, -1):
        row = frames[j]
        joint = joints[j]
        arm = way_between(row, PLACE, row, CENTRE)
        moved = _carried(row, arm)
        f = (
            joint.mass * (moved[0] - weight * g[0]),
            joint.mass * (moved[1] - weight * g[1]),
            joint.mass * (moved[2] - weight * g[2]),
        )
        spin = three(row, SPIN)
        turning = plus_cross(_spread(row, joint, three(row, SPIN_RATE)), spin, _spread(row, joint, spin))
        m = plus_cross(turning, arm, f)
        if j + 1 < n:
            after = frames[j + 1]
            outer = three(after, FORCE)
            held = plus_cross(three(after, MOMENT), way_between(row, PLACE, after, PLACE), outer)
            m = (m[0] + held[0], m[1] + held[1], m[2] + held[2])
            f = (f[0] + outer[0], f[1] + outer[1], f[2] + outer[2])
        keep_three(row, FORCE, f)
        keep_three(row, MOMENT, m)
        torques[j] = dot(f if joint.sliding else m, three(row, AXIS))


@kernel
def fill_inertia(joints, frames, inertia):
    """Inertia matrix M of the joints, motors and gears included, from placed frames.

    Args:
        joints: Records of `JOINT`, shape (n,).
        frames: As `place_chain` left them.
        inertia: Filled, shape (n, n) [kg m^2].
    """
    n = joints.size
    for i in range(n):
        for j in range(n):
            inertia[i, j] = joints[i].rotor if i == j else 0.0
    for k in range(n):  # link k moves with joints 0..k
        body = frames[k]
        link = joints[k]
        if link.mass == 0.0 and link.inertia[0, 0] + link.inertia[1, 1] + link.inertia[2, 2] == 0.0:
            continue
        for i in range(k + 1):
            row = frames[i]
            slides = joints[i].sliding
            axis = three(row, AXIS)
            moved = axis if slides else cross(axis, way_between(row, PLACE, body, CENTRE))
            # momenta per unit speed of joint i
            held = (link.mass * moved[0], link.mass * moved[1], link.mass * moved[2])
            turned = (0.0, 0.0, 0.0) if slides else _spread(body, link, axis)
            for j in range(i + 1):
                other = frames[j]
                axis = three(other, AXIS)
                if joints[j].sliding:
                    part = dot(axis, held)
                else:
                    part = dot(cross(axis, way_between(other, PLACE, body, CENTRE)), held) + dot(axis, turned)
                inertia[i, j] += part
                if i != j:
                    inertia[j, i] += part
