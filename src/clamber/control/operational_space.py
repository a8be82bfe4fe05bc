r"""Operational space control, or resolved acceleration (Khatib 1985; Luh 1980; Bevly 1997, Eq. 3.13).

.. math:: \tau = H J^{-1} (K_p e + K_d \dot e - \dot J \dot\theta) + h + g

H, h and g are those of the model, in full; the loop adds h and g (`feed_bias`, which brings Jdot too, and `feed_gravity`). Its gains are
accelerations per metre [1/s^2]. It is as good as the model is: friction that the model leaves out is an error of the model.

A limb with more joints than rows takes T^T (T H^-1 T^T)^-1 for H J^-1, and what pulls it to its rest posture passes through the null
space that belongs to it, E - T^T (T H^-1 T^T)^-1 T H^-1, so that it does not accelerate the tip (Khatib 1987).
"""

from ..compiled import kernel
from .inverse_motion import damping_of
from .kinematics import fill_inertia
from .law_state import (
    DRIFT,
    ERROR,
    GRAM,
    INERTIA,
    OTHER,
    RATE,
    SPARE,
    SQUARE,
    TASK,
    TORQUE,
    WANTED_ACCELERATION,
    WANTED_RATE,
    into_task,
    lean,
)
from .matrices import back_substitute, factor, solve_square


@kernel
def operational_space(joints, root, settings, aim, state, memory, room, report):
    """Torques of operational space control, without h and g, into `lines[TORQUE]`; arguments as in `drive`."""
    frames, lines, squares = room.frames, room.lines, room.squares
    q, qd = state[0], state[1]
    n = joints.size
    rows = settings.n_rows
    task = squares[TASK]
    lambda2 = damping_of(settings, task, rows, n, squares[GRAM], report)
    drift = lines[SPARE + 1]
    into_task(settings, lines[DRIFT], drift)
    wanted = lines[SPARE]
    for i in range(rows):
        rate = lines[WANTED_RATE, i] if settings.feed_velocity else 0.0
        wanted[i] = settings.kp[i] * lines[ERROR, i] + settings.kd[i] * (rate - lines[RATE, i]) - drift[i]
        if settings.feed_acceleration:
            wanted[i] += lines[WANTED_ACCELERATION, i]
    inertia = squares[INERTIA]
    fill_inertia(joints, frames, inertia)
    torque = lines[TORQUE]
    square = squares[SQUARE]
    if rows == n and lambda2 == 0.0:
        for i in range(n):
            for j in range(n):
                square[i, j] = task[i, j]
        solve_square(square, n, wanted)
        for i in range(n):
            torque[i] = 0.0
            for j in range(n):
                torque[i] += inertia[i, j] * wanted[j]
        return
    posture = lines[SPARE + 3]
    for j in range(n):
        posture[j] = 0.0
    if rows < n:
        lean(joints, settings, q, qd, posture)
    _through_inertia(rows, n, lambda2, wanted, posture, room)


@kernel
def _through_inertia(rows, n, lambda2, wanted, posture, room):
    """Torque = p + T^T (T M^-1 T^T + lambda^2)^-1 (a - T M^-1 p), the damping in units of the largest inertia; M and `wanted` are spent."""
    task, inertia = room.squares[TASK], room.squares[INERTIA]
    square, through = room.squares[SQUARE], room.squares[OTHER]
    held, torque = room.lines[SPARE + 2], room.lines[TORQUE]
    largest = 0.0
    for j in range(n):
        largest = max(largest, inertia[j, j])
        torque[j] = 0.0
    if not factor(inertia, n, inertia):
        return
    for i in range(rows):
        for j in range(n):
            held[j] = task[i, j]
        back_substitute(inertia, n, held)
        for j in range(n):
            through[i, j] = held[j]
            wanted[i] -= held[j] * posture[j]
    for i in range(rows):
        for k in range(i + 1):
            total = lambda2 / largest if i == k else 0.0
            for j in range(n):
                total += task[k, j] * through[i, j]
            square[i, k] = total
    found = factor(square, rows, square)
    if found:
        back_substitute(square, rows, wanted)
    for j in range(n):
        torque[j] = posture[j]
        if found:
            for i in range(rows):
                torque[j] += task[i, j] * wanted[i]
