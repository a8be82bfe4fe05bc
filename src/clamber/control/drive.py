"""One tick of any law for a batch of limbs, as one kernel: moment, law, feed-forwards, motor limits. Only here laws are numbers."""

import math

import numpy as np

from ..compiled import carray, inlined, kernel, pointer
from .admittance import admittance
from .friction import feed_friction
from .hybrid import hybrid
from .implicit_admittance import implicit_admittance
from .implicit_force import implicit_force
from .inverse_motion import damped_motion
from .jacobian_transpose import jacobian_transpose
from .joint_pd import joint_pd
from .kinematics import FRAME, accelerate
from .law_state import (
    BIAS,
    DRIFT,
    ERROR,
    FELT,
    LINES,
    LINK,
    REST,
    SHARE,
    SPARE,
    SQUARES,
    TASK,
    TIP,
    TORQUE,
    WANTED_ACCELERATION,
    WANTED_FORCE,
    Room,
    fill_law_state,
    into_task,
    lean,
    pull_back,
)
from .operational_space import operational_space
from .records import JOINT, REPORT, ROOT, SETTINGS
from .resolved_rate import resolved_rate, resolved_rate_plain
from .scct import scct
from .torque_loop import AT_BASE, AT_WRIST, NOWHERE, add_friction_felt, link_torques_by_wrist, read_mount, sum_up

JACOBIAN_TRANSPOSE = 1
OPERATIONAL_SPACE = 2
RESOLVED_RATE = 3
RESOLVED_RATE_PLAIN = 4
ADMITTANCE = 5
JOINT_PD = 6
SCCT = 7
IMPLICIT_ADMITTANCE = 8
HYBRID = 9
IMPLICIT_FORCE = 10


@inlined
def _follow(law, given):
    if law == SCCT:
        scct(*given)
    elif law == JACOBIAN_TRANSPOSE:
        jacobian_transpose(*given)
    elif law == OPERATIONAL_SPACE:
        operational_space(*given)
    elif law == RESOLVED_RATE:
        resolved_rate(*given)
    elif law == RESOLVED_RATE_PLAIN:
        resolved_rate_plain(*given)
    elif law == ADMITTANCE:
        admittance(*given)
    elif law == JOINT_PD:
        joint_pd(*given)
    elif law == IMPLICIT_ADMITTANCE:
        implicit_admittance(*given)
    elif law == HYBRID:
        hybrid(*given)
    else:
        implicit_force(*given)


@kernel
def drive(joints, root, settings, aims, sensed, memory, room, told):
    """Torques of a batch of limbs of one chain, one tick.

    Args:
        joints: Records of `JOINT`, shape (n,): the chain as the laws believe it.
        root: One record of `ROOT`, shape (1,).
        settings: Records of `SETTINGS`, shape (1,) for all or (batch,).
        aims: Records of `AIM`, shape (1,) or (batch,).
        sensed: Joint angles [rad] and speeds [rad/s], shape (batch, 2, n); wrench of each limb on what it touches, base frame [N], [N m],
            shape (batch, 6); wrench of each limb on its mount, about the base frame's origin, shape (batch, 6).
        memory: What the laws remember, zero at the start, shape (batch, `memory_length`).
        room: Scratch, see `moment`.
        told: Filled: joint torques within the motors' limits, shape (batch, n) [N m]; records of `REPORT`, shape (batch,).

    Returns:
        Index of the first limb with a measurement or an aim that is not finite, -1 where there is none. Its torques are 0, its memory is
        left alone.
    """
    states, wrenches, mounts = sensed
    torques, reports = told
    frames, lines, squares = room.frames, room.lines, room.squares
    n = joints.size
    bad = -1
    last = memory.shape[1]
    for b in range(states.shape[0]):
        chosen = settings[b if settings.size > 1 else 0]
        aim = aims[b if aims.size > 1 else 0]
        q = states[b, 0]
        qd = states[b, 1]
        total = 0.0
        for j in range(n):
            total += abs(q[j]) + abs(qd[j])
        for i in range(6):
            total += abs(wrenches[b, i]) + abs(mounts[b, i])
        total += _size_of_aim(aim)
        report = reports[b]
        report.saturated = 0
        if not math.isfinite(total):
            for j in range(n):
                torques[b, j] = 0.0
            if bad < 0:
                bad = b
            continue
        fill_law_state(joints, root, chosen, aim, states[b], wrenches[b], room)
        for k in range(3):
            report.place[k] = lines[TIP, k]
        for i in range(chosen.n_rows):
            report.error[i] = lines[ERROR, i]
        if chosen.feed_bias or chosen.feed_gravity:
            speeds = qd if chosen.feed_bias else lines[REST]
            motion, falls = (speeds, lines[REST]), chosen.feed_gravity != 0
            accelerate(joints, root, frames, lines[TIP], motion, falls, lines[DRIFT], lines[BIAS])
        else:
            for j in range(n):
                lines[BIAS, j] = 0.0
            for i in range(6):
                lines[DRIFT, i] = 0.0
        if chosen.torque_sensor == AT_BASE:
            read_mount(joints, root, frames, lines[TIP], mounts[b], lines[LINK], lines[SPARE])
            into_task(chosen, lines[SPARE], lines[FELT])
        _follow(chosen.law, (joints, root, chosen, aim, states[b], memory[b], room, report))
        _feed_forward(joints, chosen, q, qd, lines, squares, report)
        feed_friction(joints, chosen, qd, memory[b, last - n : last], lines, squares, report)
        sums = memory[b, last - 2 * n : last - n]
        if chosen.torque_sensor != NOWHERE:
            if chosen.torque_sensor == AT_WRIST:
                link_torques_by_wrist(n, wrenches[b], lines, squares)
            add_friction_felt(joints, chosen, qd, sums, lines)
        report.saturated = _limit(joints, chosen, qd, lines[TORQUE], torques[b])
        if chosen.torque_sensor != NOWHERE:
            sum_up(joints, chosen, qd, torques[b], sums, lines)
    return bad


@inlined
def _size_of_aim(aim):
    """Something that is finite if all numbers of an aim are."""
    total = 0.0
    turn = 0.0
    for i in range(3):
        total += abs(aim.place[i])
        for k in range(3):
            turn += abs(aim.turn[i, k])
    twist = 0.0
    acceleration = 0.0
    for i in range(6):
        twist += abs(aim.twist[i])
        acceleration += abs(aim.acceleration[i])
        total += abs(aim.wrench[i])
    return (total + turn) + (twist + acceleration)


@inlined
def _feed_forward(joints, settings, q, qd, lines, squares, report):
    """Add what is known beforehand: bias, a wanted force, inertia; and the posture of a redundant limb."""
    n = joints.size
    rows = settings.n_rows
    task = squares[TASK]
    torque = lines[TORQUE]
    for j in range(n):
        torque[j] += lines[BIAS, j]
    if settings.feed_force:
        force = lines[SPARE]
        for i in range(rows):
            force[i] = 0.0 if settings.forced[i] else lines[WANTED_FORCE, i]
        pull_back(task, rows, n, force, torque)
    if settings.feed_acceleration and settings.law != OPERATIONAL_SPACE:
        motion = damped_motion(n, settings, lines[WANTED_ACCELERATION], lines, squares, report)
        for j in range(n):
            torque[j] += joints[j].rotor * motion[j]
    if rows < n and settings.law != OPERATIONAL_SPACE:
        _lean(joints, settings, q, qd, lines, squares, report)


@inlined
def _lean(joints, settings, q, qd, lines, squares, report):
    """Pull a redundant limb towards its rest posture, by what moves no row of the task where K' tells the joints' inertia."""
    n = joints.size
    rows = settings.n_rows
    task = squares[TASK]
    pull = lines[SPARE]
    through = lines[SPARE + 3]
    lean(joints, settings, q, qd, pull)
    for i in range(rows):
        through[i] = 0.0
        for j in range(n):
            through[i] += task[i, j] * pull[j]
    motion = damped_motion(n, settings, through, lines, squares, report)
    for j in range(n):
        lines[TORQUE, j] += lines[SHARE, j] * (pull[j] - motion[j])


@inlined
def _least_torque(joint, speed):
    """Least torque that a joint's motor can give at a speed; the most is less that of the opposite speed."""
    if joint.limit == math.inf:
        return -math.inf
    return min(joint.limit, max(-joint.limit, -joint.limit * (1.0 + speed / joint.speed)))


@inlined
def _limit(joints, settings, qd, wanted, out):
    """Torques within the motors' limits and torque-speed lines; returns how many joints were limited.

    A torque that is too large for a number, of an absurd state or aim, becomes 0 and counts as limited.
    """
    n = joints.size
    count = 0
    part = 1.0
    for j in range(n):
        value = wanted[j]
        if not math.isfinite(value):
            wanted[j] = 0.0
        out[j] = min(max(wanted[j], _least_torque(joints[j], qd[j])), -_least_torque(joints[j], -qd[j]))
        if out[j] != value:
            count += 1
            if wanted[j] != 0.0:
                part = min(part, max(0.0, out[j] / wanted[j]))
    if count and settings.scaled:
        for j in range(n):
            value = part * wanted[j]
            out[j] = min(max(value, _least_torque(joints[j], qd[j])), -_least_torque(joints[j], -qd[j]))
    return count


ARRAYS = 9
"""Addresses in a desk: joints, root, settings, memory, frames, lines, squares, torques, reports; sizes follow."""
BUFFERS_TORQUES = 7
"""The torques among them."""
JOINTS = 9
"""Number of joints."""
LAWS = 10
"""Records of settings."""
MEMORY = 11
"""Numbers a limb's law remembers."""
LENGTH = 12
"""Of a line of scratch."""
SIDE = 13
"""Of a square of scratch."""
CONTROLLER_BUFFERS = 14


@kernel
def drive_packed(buffers, aims, states, wrenches, mounts):
    """`drive` with the arrays whose addresses are in `buffers`; their owner keeps them alive."""
    n = buffers[JOINTS]
    batch = states.shape[0]
    side = buffers[SIDE]
    return drive(
        carray(pointer(buffers[0]), n, JOINT),
        carray(pointer(buffers[1]), 1, ROOT),
        carray(pointer(buffers[2]), buffers[LAWS], SETTINGS),
        aims,
        (states, wrenches, mounts),
        carray(pointer(buffers[3]), (batch, buffers[MEMORY]), np.float64),
        Room(
            carray(pointer(buffers[4]), (2 * n, FRAME), np.float64),
            carray(pointer(buffers[5]), (LINES, buffers[LENGTH]), np.float64),
            carray(pointer(buffers[6]), (SQUARES, side, side), np.float64),
        ),
        (carray(pointer(buffers[7]), (batch, n), np.float64), carray(pointer(buffers[8]), batch, REPORT)),
    )
