r"""Resolved rate control (Whitney 1969; Bevly 1997, 3.2.3), with the Cartesian gain and plain.

With the gain, the joint servo damps towards the speeds that a Cartesian error asks for:

.. math:: \dot\theta_{des} = J^{-1} (\dot x_{des} + K e), \quad \tau = W k_d (\dot\theta_{des} - \dot\theta), \quad K = K_p / k_d

The damping stays in the joints: with W = K' and equal gains in all directions this is SCCT, with unequal ones a soft direction is damped
wrongly.

Plain, the speeds are those of the aim alone, summed up to joint angles for a joint servo:

.. math:: \tau = W (k_p (\theta_{des} - \theta) + k_d (\dot\theta_{des} - \dot\theta)), \quad \theta_{des} = \int J^{-1} \dot x_{des} dt

A step of the aim enters as what it moves in one tick. No error at the tip is ever fed back, so the tip drifts off by what the
Jacobian changes on the way.
"""

from ..compiled import kernel
from .inverse_motion import damping_of, invert_motion
from .moment import ACTUAL, ERROR, GRAM, SHARE, SPARE, SQUARE, TASK, TORQUE, WANTED_RATE


@kernel
def resolved_rate(joints, root, settings, aim, q, qd, memory, frames, lines, squares, report):
    """Torques of resolved rate control with the Cartesian gain into `lines[TORQUE]`; arguments as in `drive`."""
    n = joints.size
    rows = settings.n_rows
    task = squares[TASK]
    lambda2 = damping_of(settings, task, rows, n, squares[GRAM], report)
    speed = lines[SPARE]
    for i in range(rows):
        wanted = lines[WANTED_RATE, i] if settings.feed_velocity else 0.0
        speed[i] = wanted + settings.kp[i] / settings.joint_kd * lines[ERROR, i]
    motion = lines[SPARE + 1]
    invert_motion(task, rows, n, lines[SHARE], lambda2, speed, squares[SQUARE], lines[SPARE + 2], motion)
    for j in range(n):
        lines[TORQUE, j] = lines[SHARE, j] * settings.joint_kd * (motion[j] - qd[j])


@kernel
def resolved_rate_plain(joints, root, settings, aim, q, qd, memory, frames, lines, squares, report):
    """Torques of plain resolved rate control into `lines[TORQUE]`; arguments as in `drive`.

    Memory: started, then the joint angles asked for, then by row where the aim was.
    """
    n = joints.size
    rows = settings.n_rows
    task = squares[TASK]
    lambda2 = damping_of(settings, task, rows, n, squares[GRAM], report)
    moved = lines[SPARE]
    aim = memory[1 + n : 1 + n + rows]
    first = memory[0] == 0.0
    if first:
        memory[0] = 1.0
        for j in range(n):
            memory[1 + j] = q[j]
    for i in range(rows):
        place = lines[ERROR, i] + lines[ACTUAL, i]
        if first:
            moved[i] = lines[ERROR, i]
        elif settings.rows[i] >= 3:
            moved[i] = lines[WANTED_RATE, i] * settings.period  # turns do not subtract; their speed does
        else:
            moved[i] = place - aim[i]
        aim[i] = place
    motion = lines[SPARE + 1]
    invert_motion(task, rows, n, lines[SHARE], lambda2, moved, squares[SQUARE], lines[SPARE + 2], motion)
    for j in range(n):
        memory[1 + j] += motion[j]
        speed = motion[j] / settings.period if settings.feed_velocity else 0.0
        pull = settings.joint_kp * (memory[1 + j] - q[j]) + settings.joint_kd * (speed - qd[j])
        lines[TORQUE, j] = lines[SHARE, j] * pull
