r"""SCCT, the simplified Cartesian computed torque of Bevly (1997), Eq. 3.16.

.. math:: \tau = K' J^{-1} (K_p e + K_d \dot e) + J^T F_{ext}

K' = diag(share): each joint's inertia (or damping, or back-EMF: section 3.3.2) over the largest. Stops holding where the links' own
inertia is not small beside that of the geared motors.
"""

from ..compiled import kernel
from .inverse_motion import joint_motion
from .law_state import ERROR, RATE, SHARE, SPARE, TORQUE, WANTED_RATE


@kernel
def wanted_motion(n, settings, room, report):
    """Joint motion J^-1 (K_p e + K_d de/dt) that is asked of the first `n` joints; arguments as in `drive`."""
    lines = room.lines
    pull = lines[SPARE]
    for i in range(settings.n_rows):
        wanted = lines[WANTED_RATE, i] if settings.feed_velocity else 0.0
        pull[i] = settings.kp[i] * lines[ERROR, i] + settings.kd[i] * (wanted - lines[RATE, i])
    return joint_motion(n, settings, pull, room, report)


@kernel
def scct(joints, root, settings, aim, state, memory, room, report):
    """Torques of SCCT into `lines[TORQUE]`; arguments as in `drive`."""
    lines, n = room.lines, joints.size
    motion = wanted_motion(n, settings, room, report)
    for j in range(n):
        lines[TORQUE, j] = lines[SHARE, j] * motion[j]
