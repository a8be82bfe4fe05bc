r"""Implicit force control (Bevly 1997, 3.5): SCCT to a place inside the surface, deep enough for the wanted force.

.. math:: \tau = K' J^{-1} (K_p (e + f_{des} / k_e) + K_d \dot e) + J^T f_{des}

e is measured from the untouched surface along the rows of force, k_e is the stiffness that the surface is believed to have. No force is
sensed: an error in k_e, in the surface's place or in the joints' friction is an error of force.
"""

from ..compiled import kernel
from .inverse_motion import joint_motion
from .law_state import ERROR, RATE, SHARE, SPARE, TASK, TORQUE, WANTED_FORCE, WANTED_RATE, pull_back


@kernel
def implicit_force(joints, root, settings, aim, state, memory, room, report):
    """Torques of implicit force control into `lines[TORQUE]`; arguments as in `drive`."""
    lines = room.lines
    n, rows = joints.size, settings.n_rows
    pull = lines[SPARE]
    force = lines[SPARE + 3]
    for i in range(rows):
        deep = lines[WANTED_FORCE, i] / settings.environment if settings.forced[i] else 0.0
        force[i] = lines[WANTED_FORCE, i] if settings.forced[i] else 0.0
        wanted = lines[WANTED_RATE, i] if settings.feed_velocity else 0.0
        pull[i] = settings.kp[i] * (lines[ERROR, i] + deep) + settings.kd[i] * (wanted - lines[RATE, i])
    motion = joint_motion(n, settings, pull, room, report)
    for j in range(n):
        lines[TORQUE, j] = lines[SHARE, j] * motion[j]
    pull_back(room.squares[TASK], rows, n, force, lines[TORQUE])
