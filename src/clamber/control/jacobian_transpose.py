r"""Jacobian transpose control (Bevly 1997, Eq. 3.2): a spring and a damper at the tip, through the statics of the limb.

.. math:: \tau = J^T (K_p e + K_d \dot e)

It needs no inverse, so no pose is singular to it. The tip does not accelerate along the force (Eq. 3.10: J H^-1 J^T is not a multiple of
the unit matrix), so it leaves the line on every motion.
"""

from ..compiled import kernel
from .inverse_motion import damping_of
from .law_state import ERROR, GRAM, RATE, SPARE, TASK, TORQUE, WANTED_RATE, pull_back


@kernel
def jacobian_transpose(joints, root, settings, aim, state, memory, room, report):
    """Torques of the Jacobian transpose into `lines[TORQUE]`; arguments as in `drive`."""
    lines, squares = room.lines, room.squares
    n = joints.size
    rows = settings.n_rows
    task = squares[TASK]
    damping_of(settings, task, rows, n, squares[GRAM], report)
    report.lambda2 = 0.0  # nothing is inverted
    force = lines[SPARE]
    for i in range(rows):
        wanted = lines[WANTED_RATE, i] if settings.feed_velocity else 0.0
        force[i] = settings.kp[i] * lines[ERROR, i] + settings.kd[i] * (wanted - lines[RATE, i])
    for j in range(n):
        lines[TORQUE, j] = 0.0
    pull_back(task, rows, n, force, lines[TORQUE])
