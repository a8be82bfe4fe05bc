r"""SCCT read as an admittance (Bevly 1997, Eq. 3.25): the Cartesian error commands a velocity to a joint servo with a derivative term.

.. math:: \tau = (K'_p + K'_d s)\{J^{-1} (K_p e + K_d \dot e)\} + J^T F_{ext}

K'_p = W and K'_d = `derivative` W; the derivative is taken through a first-order filter, as it holds the tip's acceleration. Without it
this is SCCT.
"""

from ..compiled import kernel
from .law_state import SHARE, TORQUE
from .scct import wanted_motion


@kernel
def implicit_admittance(joints, root, settings, aim, state, memory, room, report):
    """Torques of the implicit admittance form into `lines[TORQUE]`; arguments as in `drive`.

    Memory: started, then by joint the command at the tick before, then its filtered derivative.
    """
    lines, n = room.lines, joints.size
    motion = wanted_motion(n, settings, room, report)
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
