"""Where a robot in space is, by IMU, encoders and contacts that stay where they are: a right-invariant extended Kalman filter.

After Hartley, Ghaffari, Eustice and Grizzle, "Contact-aided invariant extended Kalman filtering for robot state estimation" (Int. J.
Robotics Research 39, 2020), with contacts that hold directions, too, and a map of holds. An error is what is believed less what is so, in
world axes: of the rotation phi, of velocity and places less phi times them, of directions of contacts, of biases. Rows of the errors:
phi, velocity, position, bias of the gyro, bias of the accelerometer, the place of each contact, the direction of those that hold it.
"""

import math

import numpy as np

from ....compiled import kernel, opened
from ....control.whole_body.tree import FREE
from ....control.whole_body.tree_kernels import place_bodies, tip_motion
from .turn_kernels import shift_by, turn_by

IDENTITY = np.eye(3)
PHI, VELOCITY, POSITION, GYRO, ACCELEROMETER, CONTACTS = 0, 3, 6, 9, 12, 15
"""First row of each error; contact i has three rows from `CONTACTS + 3 i` on, and its direction those that `turn_at` says."""


@kernel
def add_cross(covariance, row, x, y, z, factor, rotation, other):
    """Rows from `row` on gain `factor [x, y, z]x rotation` times the rows from `other` on; without a rotation where it is the identity."""
    for c in range(covariance.shape[1]):
        u, v, w = covariance[other, c], covariance[other + 1, c], covariance[other + 2, c]
        a = rotation[0, 0] * u + rotation[0, 1] * v + rotation[0, 2] * w
        b = rotation[1, 0] * u + rotation[1, 1] * v + rotation[1, 2] * w
        d = rotation[2, 0] * u + rotation[2, 1] * v + rotation[2, 2] * w
        covariance[row, c] += factor * (y * d - z * b)
        covariance[row + 1, c] += factor * (z * a - x * d)
        covariance[row + 2, c] += factor * (x * b - y * a)


@kernel
def add_turned(covariance, row, factor, rotation, other):
    """Rows from `row` on gain `factor rotation` times the rows from `other` on."""
    for c in range(covariance.shape[1]):
        u, v, w = covariance[other, c], covariance[other + 1, c], covariance[other + 2, c]
        for a in range(3):
            covariance[row + a, c] += factor * (rotation[a, 0] * u + rotation[a, 1] * v + rotation[a, 2] * w)


@kernel
def flow(covariance, rotation, velocity, position, places, holds, gravity, dt):
    """The covariance of the errors moved on by a time, from the left only: rows."""
    g = gravity
    # velocity and places use the rotation's error before it moves on, and the position the velocity's
    add_turned(covariance, POSITION, dt, IDENTITY, VELOCITY)
    add_cross(covariance, POSITION, position[0], position[1], position[2], -dt, rotation, GYRO)
    add_cross(covariance, VELOCITY, g[0], g[1], g[2], dt, IDENTITY, PHI)
    add_cross(covariance, VELOCITY, velocity[0], velocity[1], velocity[2], -dt, rotation, GYRO)
    add_turned(covariance, VELOCITY, -dt, rotation, ACCELEROMETER)
    add_turned(covariance, PHI, -dt, rotation, GYRO)
    for limb in range(places.shape[0]):
        if holds[limb]:
            d = places[limb]
            add_cross(covariance, CONTACTS + 3 * limb, d[0], d[1], d[2], -dt, rotation, GYRO)


@kernel
def transpose(matrix):
    """A square matrix turned over its diagonal, in place."""
    for a in range(matrix.shape[0]):
        for b in range(a):
            matrix[a, b], matrix[b, a] = matrix[b, a], matrix[a, b]


@kernel
def predict(belief, gyro, accelerometer, gravity, noise, dt):
    """Move a belief on by a time.

    Args:
        belief: `BaseFilter`'s arrays (`base_filter.Belief`).
        gyro: Angular velocity by the gyro, base frame [rad/s].
        accelerometer: Specific force by the accelerometer, base frame [m/s^2].
        gravity: World frame [m/s^2].
        noise: Of a reading of gyro [rad/s] and accelerometer [m/s^2], how biases wander [rad/s/sqrt(s)], [m/s^2/sqrt(s)], and how
            contacts wander in place [m/sqrt(s)] and direction [rad/sqrt(s)], shape (6,).
        dt: The time [s].
    """
    r, v, p, p_ = belief.rotation, belief.velocity, belief.position, belief.covariance
    flow(p_, r, v, p, belief.places, belief.holds, gravity, dt)
    transpose(p_)
    flow(p_, r, v, p, belief.places, belief.holds, gravity, dt)  # its transpose is the same once it is made symmetric
    n = p_.shape[0]
    turned, pushed = (noise[0] * dt) ** 2, (noise[1] * dt) ** 2
    for a in range(3):
        p_[PHI + a, PHI + a] += turned
        p_[VELOCITY + a, VELOCITY + a] += pushed
        p_[GYRO + a, GYRO + a] += noise[2] ** 2 * dt
        p_[ACCELEROMETER + a, ACCELEROMETER + a] += noise[3] ** 2 * dt
    for limb in range(belief.holds.size):
        if belief.holds[limb]:
            for a in range(3):
                p_[CONTACTS + 3 * limb + a, CONTACTS + 3 * limb + a] += noise[4] ** 2 * dt
                if belief.turn_at[limb] >= 0:
                    p_[belief.turn_at[limb] + a, belief.turn_at[limb] + a] += noise[5] ** 2 * dt
    for a in range(n):
        for b in range(a):
            p_[a, b] = p_[b, a] = 0.5 * (p_[a, b] + p_[b, a])
    wx, wy, wz = gyro[0] - belief.biases[0], gyro[1] - belief.biases[1], gyro[2] - belief.biases[2]
    fx = accelerometer[0] - belief.biases[3]
    fy = accelerometer[1] - belief.biases[4]
    fz = accelerometer[2] - belief.biases[5]
    for a in range(3):
        push = r[a, 0] * fx + r[a, 1] * fy + r[a, 2] * fz + gravity[a]
        p[a] += dt * (v[a] + 0.5 * dt * push)
        v[a] += dt * push
    x = r[0, 0] * wx + r[0, 1] * wy + r[0, 2] * wz
    y = r[1, 0] * wx + r[1, 1] * wy + r[1, 2] * wz
    z = r[2, 0] * wx + r[2, 1] * wy + r[2, 2] * wz
    turn_by(dt * x, dt * y, dt * z, r)


@kernel
def take_vector(belief, plus, minus, innovation, variance):
    """Three numbers that were measured: that errors from row `plus` on, less those from row `minus` on, are `innovation`.

    They are taken one after the other, and the covariance is gone through once, not for each; `belief.error` gathers.
    """
    p, h, share, error = belief.covariance, belief.gain, belief.share, belief.error
    n = p.shape[0]
    for k in range(3):
        first, second = plus + k, minus + k
        for a in range(n):
            x, y = p[a, first], p[a, second]
            for j in range(k):
                x -= share[j, a] * h[j, first]
                y -= share[j, a] * h[j, second]
            h[k, a] = x - y
        spread = h[k, first] - h[k, second] + variance
        off = innovation[k] - (error[first] - error[second])
        for a in range(n):
            share[k, a] = h[k, a] / spread
            error[a] += share[k, a] * off
    for a in range(n):
        u, v, w = share[0, a], share[1, a], share[2, a]
        for b in range(n):
            p[a, b] = p[a, b] - u * h[0, b] - v * h[1, b] - w * h[2, b]


@kernel
def take_row(belief, measured, innovation, variance):
    """One number that was measured: that `measured` times the errors is `innovation`."""
    p, h = belief.covariance, belief.gain[0]
    n = p.shape[0]
    spread, off = variance, innovation
    for a in range(n):
        total = 0.0
        for b in range(n):
            total += p[a, b] * measured[b]
        h[a] = total
    for a in range(n):
        spread += h[a] * measured[a]
        off -= measured[a] * belief.error[a]
    for a in range(n):
        gain = h[a] / spread
        belief.error[a] += gain * off
        for b in range(n):
            p[a, b] -= gain * h[b]


@kernel
def apply_error(belief):
    """Take the error that has been found off the belief."""
    e = belief.error
    x, y, z = -e[PHI], -e[PHI + 1], -e[PHI + 2]
    turn_by(x, y, z, belief.rotation)
    shift_by(x, y, z, e[VELOCITY], e[VELOCITY + 1], e[VELOCITY + 2], belief.velocity)
    shift_by(x, y, z, e[POSITION], e[POSITION + 1], e[POSITION + 2], belief.position)
    for a in range(6):
        belief.biases[a] -= e[GYRO + a]
    for limb in range(belief.holds.size):
        if belief.holds[limb]:
            at = CONTACTS + 3 * limb
            shift_by(x, y, z, e[at], e[at + 1], e[at + 2], belief.places[limb])
            at = belief.turn_at[limb]
            if at >= 0:
                turn_by(-e[at], -e[at + 1], -e[at + 2], belief.directions[limb])
    for a in range(e.size):
        e[a] = 0.0


@kernel
def begin_contact(belief, limb, tip, axes, variance, turned):
    """From now on a limb's tip stays where it is: its place, and its direction, as errors are those of the base and of the encoders."""
    r = belief.rotation
    for a in range(3):
        belief.places[limb, a] = belief.position[a] + r[a, 0] * tip[0] + r[a, 1] * tip[1] + r[a, 2] * tip[2]
        for b in range(3):
            belief.directions[limb, a, b] = r[a, 0] * axes[0, b] + r[a, 1] * axes[1, b] + r[a, 2] * axes[2, b]
    copy_error(belief.covariance, CONTACTS + 3 * limb, POSITION, variance)
    if belief.turn_at[limb] >= 0:
        copy_error(belief.covariance, belief.turn_at[limb], PHI, turned)
    belief.holds[limb] = 1


@kernel
def add_drift(belief, moved, turned, row):
    """What encoders told wrong all the time, such as the play of gears, has moved and turned the robot with all its contacts unnoticed.

    Args:
        belief: As in `predict`.
        moved: Variance of that in place [m^2].
        turned: Of that in direction, about the base [rad^2].
        row: Scratch, shape (n,).
    """
    p = belief.position
    for a in range(6):
        for k in range(row.size):
            row[k] = 0.0
        x, y, z = 0.0, 0.0, 0.0
        if a < 3:
            x, y, z = 1.0 * (a == 0), 1.0 * (a == 1), 1.0 * (a == 2)
        else:  # places stay in error as they are, about the base: less the turn times where that is
            row[PHI + a - 3] = 1.0
            ux, uy, uz = 1.0 * (a == 3), 1.0 * (a == 4), 1.0 * (a == 5)
            x, y, z = uz * p[1] - uy * p[2], ux * p[2] - uz * p[0], uy * p[0] - ux * p[1]
        row[POSITION], row[POSITION + 1], row[POSITION + 2] = x, y, z
        for limb in range(belief.holds.size):
            if belief.holds[limb]:
                at = CONTACTS + 3 * limb
                row[at], row[at + 1], row[at + 2] = x, y, z
                if a >= 3 and belief.turn_at[limb] >= 0:
                    row[belief.turn_at[limb] + a - 3] = 1.0
        variance = moved if a < 3 else turned
        for b in range(row.size):
            for c in range(row.size):
                belief.covariance[b, c] += variance * row[b] * row[c]


@kernel
def copy_error(covariance, to, source, variance):
    """Three errors that are as three others are, but for a variance of their own."""
    n = covariance.shape[0]
    for a in range(3):
        for b in range(n):
            covariance[to + a, b] = covariance[source + a, b]
    for a in range(3):
        for b in range(n):
            covariance[b, to + a] = covariance[b, source + a]
        covariance[to + a, to + a] += variance


@kernel
def clear_error(covariance, first):
    """Three errors that mean nothing any more."""
    for a in range(3):
        for b in range(covariance.shape[0]):
            covariance[first + a, b] = covariance[b, first + a] = 0.0


@kernel
def end_contact(belief, limb):
    """From now on a limb's tip moves."""
    clear_error(belief.covariance, CONTACTS + 3 * limb)
    if belief.turn_at[limb] >= 0:
        clear_error(belief.covariance, belief.turn_at[limb])
    belief.holds[limb] = 0


@kernel
def off_contact(belief, limb, tip, axes, out):
    """By how much a tip that stays where it is seems to have moved: place [m], then direction [rad], shape (6,)."""
    r = belief.rotation
    for a in range(3):
        out[a] = belief.position[a] + r[a, 0] * tip[0] + r[a, 1] * tip[1] + r[a, 2] * tip[2] - belief.places[limb, a]
    # the rotation vector of R axes D^T, small
    x, y, z = 0.0, 0.0, 0.0
    for b in range(3):
        u = r[0, 0] * axes[0, b] + r[0, 1] * axes[1, b] + r[0, 2] * axes[2, b]
        v = r[1, 0] * axes[0, b] + r[1, 1] * axes[1, b] + r[1, 2] * axes[2, b]
        w = r[2, 0] * axes[0, b] + r[2, 1] * axes[1, b] + r[2, 2] * axes[2, b]
        d = belief.directions[limb]
        x += 0.5 * (d[1, b] * w - d[2, b] * v)
        y += 0.5 * (d[2, b] * u - d[0, b] * w)
        z += 0.5 * (d[0, b] * v - d[1, b] * u)
    out[3], out[4], out[5] = x, y, z


@kernel
def correct(belief, tips, axes, variances, turned, gate, off):
    """Take in that tips stay where they are.

    Args:
        belief: As in `predict`.
        tips: By the encoders, base frame [m], shape (limbs, 3).
        axes: Of the end effectors, base frame, shape (limbs, 3, 3).
        variances: Of the tips' places by the encoders [m^2], shape (limbs,).
        turned: Variance of their directions [rad^2].
        gate: A tip that seems to have moved by more [m] has slipped: it stays where it is now.
        off: Scratch, shape (6,).
    """
    for limb in range(tips.shape[0]):
        if not belief.holds[limb]:
            continue
        off_contact(belief, limb, tips[limb], axes[limb], off)
        if math.sqrt(off[0] * off[0] + off[1] * off[1] + off[2] * off[2]) > gate:
            begin_contact(belief, limb, tips[limb], axes[limb], variances[limb], turned)
            continue
        at = CONTACTS + 3 * limb
        take_vector(belief, POSITION, at, off[:3], variances[limb])
        if belief.turn_at[limb] >= 0:
            take_vector(belief, PHI, belief.turn_at[limb], off[3:], turned)
        apply_error(belief)


@kernel
def take_height(belief, limb, place, normal, variance, row):
    """Take in that a limb is on a surface that goes through a place; `row` is scratch, shape (n,)."""
    d, at = belief.places[limb], CONTACTS + 3 * limb
    off = 0.0
    for a in range(row.size):
        row[a] = 0.0
    for a in range(3):
        b, c = (a + 1) % 3, (a + 2) % 3
        row[PHI + a] = d[b] * normal[c] - d[c] * normal[b]
        row[at + a] = normal[a]
        off += normal[a] * (d[a] - place[a])
    take_row(belief, row, off, variance)
    apply_error(belief)


@kernel
def tell(handle, late):
    """The state that is believed of now, of a belief of `late` [s] before; the handle is that of `believe`."""
    sensed, _, body, belief, _, _, _, state = opened(handle)
    own, r, s = body.own, belief.rotation, state.speed
    for a in range(3):
        s[3 + a] = sensed.gyro[a] - belief.biases[a]
    x = late * (r[0, 0] * s[3] + r[0, 1] * s[4] + r[0, 2] * s[5])
    y = late * (r[1, 0] * s[3] + r[1, 1] * s[4] + r[1, 2] * s[5])
    z = late * (r[2, 0] * s[3] + r[2, 1] * s[4] + r[2, 2] * s[5])
    for a in range(3):
        s[a] = belief.velocity[a]
        state.position[a] = belief.position[a] + late * belief.velocity[a]
        for b in range(3):
            state.rotation[a, b] = r[a, b]
    if late > 0.0:
        turn_by(x, y, z, state.rotation)
    for k in range(own.joints.size):
        s[FREE + k] = own.speed[FREE + k]
        state.joints[k] = own.joints[k] + late * s[FREE + k]


@kernel
def follow(handle, passed):
    """Bring a belief up to date with the readings of a tick: joints, motion of the base, and tips that stay where they are.

    The handle is that of `believe`; `passed` is the time since the readings before [s], 0: none has passed.
    """
    sensed, tree, body, belief, settings, _, _, _ = opened(handle)
    if passed > 0.0:
        predict(belief, sensed.gyro, sensed.accelerometer, settings.gravity, settings.noise, passed)
    own, (kept, period, lag), (least, spread, turned, gate) = body.own, settings.tracking, settings.contacts
    share = 1.0 - math.exp(-passed / lag)
    for k in range(own.joints.size):
        angle, speed = sensed.joints[0, k], sensed.joints[1, k]
        if kept >= 0.0:  # encoders too coarse to tell speeds
            own.joints[k] += passed * own.speed[FREE + k]
            off = angle - own.joints[k]
            angle = own.joints[k] + (1.0 - kept * kept) * off
            speed = own.speed[FREE + k] + (1.0 - kept) ** 2 / period * off
        own.joints[k], own.speed[FREE + k] = angle, speed
        body.pushed[k] += share * (sensed.torques[k] - body.pushed[k])
        side = min(1.0, max(-1.0, body.pushed[k] / body.firm[k]))
        body.placed.joints[k] = angle - body.half_play[k] * side
    place_bodies(tree, body.placed, body.work)
    tip_motion(tree, body.placed, body.work)
    for limb in range(body.variances.size):
        lever = 0.0
        for a in range(3):
            for k in range(own.joints.size):
                lever += body.work.jacobian[limb, a, FREE + k] ** 2
        body.variances[limb] = least * least + spread * spread * lever / 3.0
    correct(belief, body.work.tip, body.work.tip_turn, body.variances, turned, gate, settings.off)


@kernel
def believe(handle, passed, late):
    """`follow`, and `tell` where every limb is on the hold that it was on before.

    Args:
        handle: Holds the readings; the robot as it is believed to be; its joints, and what is worked out of them
            (`base_filter.Followed`), in place; the belief, as in `predict`; settings of the filter (`base_filter.Packed`); holds that
            limbs are on now, and were on before, shape (limbs,); and the state, filled.
        passed, late: As in `follow` and `tell`.

    Returns:
        Whether the state is told.
    """
    follow(handle, passed)
    now, on = opened(handle)[5:7]
    for limb in range(now.size):
        if now[limb] != on[limb]:
            return False
    tell(handle, late)
    return True
