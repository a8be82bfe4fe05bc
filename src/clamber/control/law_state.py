"""What a law knows at one tick, in scratch arrays that the loop fills: the task Jacobian, errors and rates by row, and room to work.

In a `Room` the `lines` hold vectors, one name a row, and the `squares` matrices. A law reads the filled ones, may use the scratch ones,
and leaves its torques in `lines[TORQUE]`.
"""

import math
from typing import NamedTuple

from ..compiled import inlined, kernel
from ..types import Floats
from .kinematics import fill_jacobian, place_chain
from .records import AXES

ERROR = 0
"""By row: wanted less actual place, task frame [m], [rad]."""
RATE = 1
"""By row: actual speed T qd."""
WANTED_RATE = 2
WANTED_ACCELERATION = 3
WANTED_FORCE = 4
"""By row: wrench of the limb on what it touches."""
FELT = 5
"""By row: that wrench as sensed."""
TORQUE = 6
SHARE = 7
"""By joint: K', or ones."""
TIP = 8
"""Place and turn, twelve numbers."""
DRIFT = 9
"""Tip acceleration at resting joint accelerations, Jdot qd, base frame."""
BIAS = 10
"""By joint: bias torques h, and gravity if it is fed forward."""
REST = 11
"""By joint: zeros."""
FRICTION = 12
"""By joint: friction that was fed forward."""
LINK = 13
"""By joint: torque that the gear passes on to the link, by a sensor of force."""
SPARE = 14
"""First of the scratch lines."""
LINES = 21

JACOBIAN = 0
TASK = 1
INERTIA = 2
SQUARE = 3
GRAM = 4
OTHER = 5
SQUARES = 6


class Room(NamedTuple):
    """Where laws work."""

    frames: Floats
    """Shape (2 n, FRAME)."""
    lines: Floats
    """Shape (LINES, `line_length`)."""
    squares: Floats
    """Shape (SQUARES, side, side)."""


@inlined
def into_task(settings, twist, out):
    """Rows of the task from a twist or wrench in the base frame."""
    for i in range(settings.n_rows):
        row = settings.rows[i]
        start = 0 if row < 3 else 3
        column = row - start
        total = 0.0
        for k in range(3):
            total += settings.frame[k, column] * twist[start + k]
        out[i] = total


@kernel
def turn_error(wanted, tip, out):
    """Rotation vector from the tip's turn to the wanted one, base frame [rad], into out[3:6].

    It is the logarithm of R_wanted R_tip^T, at most pi long, by way of the quaternion, which is exact near half a turn too; at half a turn
    one of its two axes is taken.
    """
    # R_wanted R_tip^T, row by row
    r00 = wanted[0, 0] * tip[3] + wanted[0, 1] * tip[4] + wanted[0, 2] * tip[5]
    r01 = wanted[0, 0] * tip[6] + wanted[0, 1] * tip[7] + wanted[0, 2] * tip[8]
    r02 = wanted[0, 0] * tip[9] + wanted[0, 1] * tip[10] + wanted[0, 2] * tip[11]
    r10 = wanted[1, 0] * tip[3] + wanted[1, 1] * tip[4] + wanted[1, 2] * tip[5]
    r11 = wanted[1, 0] * tip[6] + wanted[1, 1] * tip[7] + wanted[1, 2] * tip[8]
    r12 = wanted[1, 0] * tip[9] + wanted[1, 1] * tip[10] + wanted[1, 2] * tip[11]
    r20 = wanted[2, 0] * tip[3] + wanted[2, 1] * tip[4] + wanted[2, 2] * tip[5]
    r21 = wanted[2, 0] * tip[6] + wanted[2, 1] * tip[7] + wanted[2, 2] * tip[8]
    r22 = wanted[2, 0] * tip[9] + wanted[2, 1] * tip[10] + wanted[2, 2] * tip[11]
    # four times w^2, x^2, y^2, z^2 of the quaternion: what follows divides by the largest (Shepperd 1978)
    ww = 1.0 + r00 + r11 + r22
    xx = 1.0 + r00 - r11 - r22
    yy = 1.0 - r00 + r11 - r22
    zz = 1.0 - r00 - r11 + r22
    if ww >= xx and ww >= yy and ww >= zz:
        w = ww
        x = r21 - r12
        y = r02 - r20
        z = r10 - r01
    elif xx >= yy and xx >= zz:
        w = r21 - r12
        x = xx
        y = r01 + r10
        z = r02 + r20
    elif yy >= zz:
        w = r02 - r20
        x = r01 + r10
        y = yy
        z = r12 + r21
    else:
        w = r10 - r01
        x = r02 + r20
        y = r12 + r21
        z = zz
    length = math.sqrt(x * x + y * y + z * z)
    if length == 0.0:
        scale = 0.0
    elif w < 0.0:
        scale = -2.0 * math.atan2(length, -w) / length
    else:
        scale = 2.0 * math.atan2(length, w) / length
    out[3] = scale * x
    out[4] = scale * y
    out[5] = scale * z


@inlined
def fill_error(settings, aim, tip, difference, out):
    """By row: wanted less actual place of the tip."""
    for k in range(3):
        difference[k] = aim.place[k] - tip[k]
        difference[3 + k] = 0.0
    for i in range(settings.n_rows):
        if settings.rows[i] >= 3:
            turn_error(aim.turn, tip, difference)
            break
    into_task(settings, difference, out)


@inlined
def fill_task(settings, jacobian, n, task):
    """Task Jacobian T: the rows that the task controls, in its own frame."""
    for i in range(settings.n_rows):
        row = settings.rows[i]
        start = 0 if row < 3 else 3
        column = row - start
        for j in range(n):
            task[i, j] = (
                settings.frame[0, column] * jacobian[start, j]
                + settings.frame[1, column] * jacobian[start + 1, j]
                + settings.frame[2, column] * jacobian[start + 2, j]
            )


@kernel
def fill_law_state(joints, root, settings, aim, state, felt, room):
    """Fill what every law reads.

    Args:
        joints: Records of `JOINT`, shape (n,).
        root: One record of `ROOT`, shape (1,).
        settings: A record of `SETTINGS`.
        aim: A record of `AIM`.
        state: Joint angles and speeds, shape (2, n).
        felt: Sensed wrench of the limb on what it touches, base frame, shape (6,).
        room: Filled, see above.
    """
    frames, lines, squares = room.frames, room.lines, room.squares
    q, qd = state[0], state[1]
    n = joints.size
    tip = lines[TIP]
    place_chain(joints, root, q, frames, tip)
    fill_jacobian(joints, frames, tip, squares[JACOBIAN])
    task = squares[TASK]
    fill_task(settings, squares[JACOBIAN], n, task)
    difference = lines[SPARE]
    fill_error(settings, aim, tip, difference, lines[ERROR])
    into_task(settings, aim.twist, lines[WANTED_RATE])
    into_task(settings, aim.acceleration, lines[WANTED_ACCELERATION])
    into_task(settings, aim.wrench, lines[WANTED_FORCE])
    into_task(settings, felt, lines[FELT])
    for i in range(settings.n_rows):
        total = 0.0
        for j in range(n):
            total += task[i, j] * qd[j]
        lines[RATE, i] = total
    for j in range(n):
        lines[SHARE, j] = joints[j].share if settings.weighted else 1.0


@inlined
def pull_back(task, n_rows, n, force, out):
    """Out += T^T force: joint torques of a force on the task's rows."""
    for j in range(n):
        total = 0.0
        for i in range(n_rows):
            total += task[i, j] * force[i]
        out[j] += total


@inlined
def lean(joints, settings, q, qd, out):
    """Torques that pull the joints towards their rest posture."""
    for j in range(joints.size):
        out[j] = settings.posture_kp * (joints[j].rest - q[j]) - settings.posture_kd * qd[j]


def line_length(n: int) -> int:
    """Length of a line of scratch for a chain of `n` joints: the tip's twelve numbers, or the joints."""
    return max(n, 12, AXES)
