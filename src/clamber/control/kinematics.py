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
        ax = row[AXIS]
        ay = row[AXIS + 1]
        az = row[AXIS + 2]
        if joints[j].sliding:
            jacobian[0, j] = ax
            jacobian[1, j] = ay
            jacobian[2, j] = az
            jacobian[3, j] = 0.0
            jacobian[4, j] = 0.0
            jacobian[5, j] = 0.0
            continue
        dx = tip[0] - row[PLACE]
        dy = tip[1] - row[PLACE + 1]
        dz = tip[2] - row[PLACE + 2]
        jacobian[0, j] = ay * dz - az * dy
        jacobian[1, j] = az * dx - ax * dz
        jacobian[2, j] = ax * dy - ay * dx
        jacobian[3, j] = ax
        jacobian[4, j] = ay
        jacobian[5, j] = az


@inlined
def _spread(row, joint, x, y, z, out):
    """Out = R I R^T (x, y, z): a link's inertia, base frame, on a vector."""
    lx = row[TURN] * x + row[TURN + 3] * y + row[TURN + 6] * z
    ly = row[TURN + 1] * x + row[TURN + 4] * y + row[TURN + 7] * z
    lz = row[TURN + 2] * x + row[TURN + 5] * y + row[TURN + 8] * z
    hx = joint.inertia[0, 0] * lx + joint.inertia[0, 1] * ly + joint.inertia[0, 2] * lz
    hy = joint.inertia[1, 0] * lx + joint.inertia[1, 1] * ly + joint.inertia[1, 2] * lz
    hz = joint.inertia[2, 0] * lx + joint.inertia[2, 1] * ly + joint.inertia[2, 2] * lz
    for i in range(3):
        out[i] = row[TURN + 3 * i] * hx + row[TURN + 3 * i + 1] * hy + row[TURN + 3 * i + 2] * hz


@kernel
def accelerate(joints, root, frames, tip, qd, qdd, with_gravity, tip_acceleration, torques):
    """Recursive Newton-Euler: torques that give the joints an acceleration, and the tip's acceleration that follows.

    The inertia of motors and gears (`rotor`) counts; damping and friction do not.

    Args:
        joints: Records of `JOINT`, shape (n,).
        root: One record of `ROOT`.
        frames: As `place_chain` left them; the moving columns are filled.
        tip: As `place_chain` left it.
        qd: Joint speeds [rad/s], shape (n,).
        qdd: Joint accelerations [rad/s^2], shape (n,).
        with_gravity: Whether the torques carry the weight.
        tip_acceleration: Filled with J qdd + Jdot qd, shape (6,) [m/s^2], [rad/s^2].
        torques: Filled with M qdd + h (+ g), shape (n,) [N m].
    """
    n = joints.size
    g = root[0].gravity
    for j in range(n):
        row = frames[j]
        if j == 0:
            wx = 0.0
            wy = 0.0
            wz = 0.0
            ux = 0.0
            uy = 0.0
            uz = 0.0
            px = 0.0
            py = 0.0
            pz = 0.0
        else:
            before = frames[j - 1]
            wx = before[SPIN]
            wy = before[SPIN + 1]
            wz = before[SPIN + 2]
            ux = before[SPIN_RATE]
            uy = before[SPIN_RATE + 1]
            uz = before[SPIN_RATE + 2]
            dx = row[PLACE] - before[PLACE]
            dy = row[PLACE + 1] - before[PLACE + 1]
            dz = row[PLACE + 2] - before[PLACE + 2]
            cx = wy * dz - wz * dy
            cy = wz * dx - wx * dz
            cz = wx * dy - wy * dx
            px = before[ACCELERATION] + uy * dz - uz * dy + wy * cz - wz * cy
            py = before[ACCELERATION + 1] + uz * dx - ux * dz + wz * cx - wx * cz
            pz = before[ACCELERATION + 2] + ux * dy - uy * dx + wx * cy - wy * cx
        ax = row[AXIS]
        ay = row[AXIS + 1]
        az = row[AXIS + 2]
        v = qd[j]
        a = qdd[j]
        if joints[j].sliding:
            px += a * ax + 2.0 * v * (wy * az - wz * ay)
            py += a * ay + 2.0 * v * (wz * ax - wx * az)
            pz += a * az + 2.0 * v * (wx * ay - wy * ax)
        else:
            ux += a * ax + v * (wy * az - wz * ay)
            uy += a * ay + v * (wz * ax - wx * az)
            uz += a * az + v * (wx * ay - wy * ax)
            wx += v * ax
            wy += v * ay
            wz += v * az
        row[SPIN] = wx
        row[SPIN + 1] = wy
        row[SPIN + 2] = wz
        row[SPIN_RATE] = ux
        row[SPIN_RATE + 1] = uy
        row[SPIN_RATE + 2] = uz
        row[ACCELERATION] = px
        row[ACCELERATION + 1] = py
        row[ACCELERATION + 2] = pz
    last = frames[n - 1]
    dx = tip[0] - last[PLACE]
    dy = tip[1] - last[PLACE + 1]
    dz = tip[2] - last[PLACE + 2]
    wx = last[SPIN]
    wy = last[SPIN + 1]
    wz = last[SPIN + 2]
    ux = last[SPIN_RATE]
    uy = last[SPIN_RATE + 1]
    uz = last[SPIN_RATE + 2]
    cx = wy * dz - wz * dy
    cy = wz * dx - wx * dz
    cz = wx * dy - wy * dx
    tip_acceleration[0] = last[ACCELERATION] + uy * dz - uz * dy + wy * cz - wz * cy
    tip_acceleration[1] = last[ACCELERATION + 1] + uz * dx - ux * dz + wz * cx - wx * cz
    tip_acceleration[2] = last[ACCELERATION + 2] + ux * dy - uy * dx + wx * cy - wy * cx
    tip_acceleration[3] = ux
    tip_acceleration[4] = uy
    tip_acceleration[5] = uz
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
        dx = row[CENTRE] - row[PLACE]
        dy = row[CENTRE + 1] - row[PLACE + 1]
        dz = row[CENTRE + 2] - row[PLACE + 2]
        wx = row[SPIN]
        wy = row[SPIN + 1]
        wz = row[SPIN + 2]
        ux = row[SPIN_RATE]
        uy = row[SPIN_RATE + 1]
        uz = row[SPIN_RATE + 2]
        cx = wy * dz - wz * dy
        cy = wz * dx - wx * dz
        cz = wx * dy - wy * dx
        fx = joint.mass * (row[ACCELERATION] + uy * dz - uz * dy + wy * cz - wz * cy - weight * g[0])
        fy = joint.mass * (row[ACCELERATION + 1] + uz * dx - ux * dz + wz * cx - wx * cz - weight * g[1])
        fz = joint.mass * (row[ACCELERATION + 2] + ux * dy - uy * dx + wx * cy - wy * cx - weight * g[2])
        held = row[MOMENT : MOMENT + 3]
        _spread(row, joint, wx, wy, wz, held)
        hx = held[0]
        hy = held[1]
        hz = held[2]
        _spread(row, joint, ux, uy, uz, held)
        mx = held[0] + wy * hz - wz * hy + dy * fz - dz * fy
        my = held[1] + wz * hx - wx * hz + dz * fx - dx * fz
        mz = held[2] + wx * hy - wy * hx + dx * fy - dy * fx
        if j + 1 < n:
            after = frames[j + 1]
            ex = after[PLACE] - row[PLACE]
            ey = after[PLACE + 1] - row[PLACE + 1]
            ez = after[PLACE + 2] - row[PLACE + 2]
            gx = after[FORCE]
            gy = after[FORCE + 1]
            gz = after[FORCE + 2]
            mx += after[MOMENT] + ey * gz - ez * gy
            my += after[MOMENT + 1] + ez * gx - ex * gz
            mz += after[MOMENT + 2] + ex * gy - ey * gx
            fx += gx
            fy += gy
            fz += gz
        row[FORCE] = fx
        row[FORCE + 1] = fy
        row[FORCE + 2] = fz
        row[MOMENT] = mx
        row[MOMENT + 1] = my
        row[MOMENT + 2] = mz
        if joint.sliding:
            torques[j] = fx * row[AXIS] + fy * row[AXIS + 1] + fz * row[AXIS + 2]
        else:
            torques[j] = mx * row[AXIS] + my * row[AXIS + 1] + mz * row[AXIS + 2]


@kernel
def fill_inertia(joints, frames, inertia):
    """Inertia matrix M of the joints, motors and gears included, from placed frames.

    Args:
        joints: Records of `JOINT`, shape (n,).
        frames: As `place_chain` left them; the moving columns are overwritten.
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
            ax = row[AXIS]
            ay = row[AXIS + 1]
            az = row[AXIS + 2]
            if joints[i].sliding:
                vx = ax
                vy = ay
                vz = az
            else:
                dx = body[CENTRE] - row[PLACE]
                dy = body[CENTRE + 1] - row[PLACE + 1]
                dz = body[CENTRE + 2] - row[PLACE + 2]
                vx = ay * dz - az * dy
                vy = az * dx - ax * dz
                vz = ax * dy - ay * dx
            held = row[FORCE : FORCE + 3]  # linear momentum per unit speed of joint i
            held[0] = link.mass * vx
            held[1] = link.mass * vy
            held[2] = link.mass * vz
            turned = row[MOMENT : MOMENT + 3]
            if joints[i].sliding:
                turned[0] = 0.0
                turned[1] = 0.0
                turned[2] = 0.0
            else:
                _spread(body, link, ax, ay, az, turned)
            for j in range(i + 1):
                other = frames[j]
                bx = other[AXIS]
                by = other[AXIS + 1]
                bz = other[AXIS + 2]
                if joints[j].sliding:
                    part = bx * held[0] + by * held[1] + bz * held[2]
                else:
                    dx = body[CENTRE] - other[PLACE]
                    dy = body[CENTRE + 1] - other[PLACE + 1]
                    dz = body[CENTRE + 2] - other[PLACE + 2]
                    ux = by * dz - bz * dy
                    uy = bz * dx - bx * dz
                    uz = bx * dy - by * dx
                    part = ux * held[0] + uy * held[1] + uz * held[2]
                    part += bx * turned[0] + by * turned[1] + bz * turned[2]
                inertia[i, j] += part
                if i != j:
                    inertia[j, i] += part
