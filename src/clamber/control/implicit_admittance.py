r"""SCCT read as an admittance (Bevly 1997, Eq. 3.25): the Cartesian error commands a velocity to a joint servo with a derivative term.

.. math:: \tau = (K'_p + K'_d s)\{J^{-1} (K_p e + K_d \dot e)\} + J^T F_{ext}

K'_p = W and K'_d = `derivative` W; the derivative is taken through a first-order filter, as it holds the tip's acceleration. Without it
this is SCCT.
"""

from ..compiled import kernel
from .inverse_motion import damping_of, invert_motion
from .law_state import ERROR, GRAM, RATE, SHARE, SPARE, SQUARE, TASK, TORQUE, WANTED_RATE


@kernel
def implicit_admittance(joints, root, settings, aim, state, memory, room, report):
    """Torques of the implicit admittance form into `lines[TORQUE]`; arguments as in `drive`.

    Memory: started, then by joint the command at the tick before, then its filtered derivative.
    """
    lines, squares = room.lines, room.squares
    n = joints.size
    rows = settings.n_rows
    task = squares[TASK]
    lambda2 = damping_of(settings, task, rows, n, squares[GRAM], report)
    pull = lines[SPARE]
    for i in range(rows):
        wanted = lines[WANTED_RATE, i] if settings.feed_velocity else 0.0
        pull[i] = settings.kp[i] * lines[ERROR, i] + settings.kd[i] * (wanted - lines[RATE, i])
    motion = lines[SPARE + 1]
    invert_motion(task, rows, n, lines[SHARE], lambda2, pull, squares[SQUARE], lines[SPARE + 2], motion)
    before = memory[1 : 1 + n]
    slope = memory[1 + n : 1 + 2 * n]
    first = memory[0] == 0.0
    memory[0] = 1.0
    blend = settings.period / (settings.period + settings.derivative_time)
    for j in range(n):
        change = 0.0 if first else (motion[j] - before[j]) / settings.period
        slope[j] += blend * (change - slope[j])
        before[j] = motion[j]
        lines[TORQUE, j] = lines[SHARE, j] * (motion[j] + settings.derivative * slope[j])
