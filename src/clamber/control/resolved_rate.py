r"""Resolved rate control (Whitney 1969; Bevly 1997, 3.2.3), with the Cartesian gain and plain.

With the gain, the joint servo damps towards the speeds that a Cartesian error asks for:

.. math:: \dot\theta_{des} = J^{-1} (\dot x_{des} + K e), \quad \tau = W k_d (\dot\theta_{des} - \dot\theta), \quad K = K_p / k_d

The damping stays in the joints: with W = K' and equal gains in all directions this is SCCT, with unequal ones a soft direction is damped
wrongly.

Plain, the speeds are those of the aim alone, summed up to joint angles for a joint servo:

.. math:: \tau = W (k_p (\theta_{des} - \theta) + k_d (\dot\theta_{des} - \dot\theta)), \quad \theta_{des} = \int J^{-1} \dot x_{des} dt

The integral is summed tick by tick from how far the aim has moved, so a step of the aim enters in one tick. No error at the tip is ever
fed back: the tip drifts off by what the Jacobian changes on the way, and after a step it never arrives.
"""

from ..compiled import kernel
from .inverse_motion import damped_motion, damping_of, joint_motion
from .law_state import ERROR, GRAM, SHARE, SPARE, TASK, TIP, TORQUE, WANTED_RATE, fill_error


@kernel
def resolved_rate(joints, root, settings, aim, state, memory, room, report):
    """Torques of resolved rate control with the Cartesian gain into `lines[TORQUE]`; arguments as in `drive`."""
    lines, qd, n = room.lines, state[1], joints.size
    speed = lines[SPARE]
    for i in range(settings.n_rows):
        wanted = lines[WANTED_RATE, i] if settings.feed_velocity else 0.0
        speed[i] = wanted + settings.kp[i] / settings.joint_kd * lines[ERROR, i]
    motion = joint_motion(n, settings, speed, room, report)
    for j in range(n):
        lines[TORQUE, j] = lines[SHARE, j] * settings.joint_kd * (motion[j] - qd[j])


@kernel
def resolved_rate_plain(joints, root, settings, aim, state, memory, room, report):
    """Torques of plain resolved rate control into `lines[TORQUE]`; arguments as in `drive`.

    Memory: started, then the joint angles asked for, then where the aim was: place and turn, twelve numbers like those of a tip.
    """
    lines, squares = room.lines, room.squares
    q, qd = state[0], state[1]
    n = joints.size
    damping_of(settings, squares[TASK], settings.n_rows, n, squares[GRAM], report)
    moved = lines[SPARE]
    angles = memory[1 : 1 + n]
    before = memory[1 + n : 13 + n]
    if memory[0] == 0.0:
        memory[0] = 1.0
        for j in range(n):
            angles[j] = q[j]
        for k in range(12):
            before[k] = lines[TIP, k]
    fill_error(settings, aim, before, lines[SPARE + 3], moved)
    for i in range(3):
        before[i] = aim.place[i]
        for k in range(3):
            before[3 + 3 * i + k] = aim.turn[i, k]
    motion = damped_motion(n, settings, moved, lines, squares, report)
    for j in range(n):
        angles[j] += motion[j]
    motion = damped_motion(n, settings, lines[WANTED_RATE], lines, squares, report)
    for j in range(n):
        speed = motion[j] if settings.feed_velocity else 0.0
        pull = settings.joint_kp * (angles[j] - q[j]) + settings.joint_kd * (speed - qd[j])
        lines[TORQUE, j] = lines[SHARE, j] * pull
