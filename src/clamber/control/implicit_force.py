r"""Implicit force control (Bevly 1997, 3.5): SCCT to a place inside the surface, deep enough for the wanted force.

.. math:: \tau = K' J^{-1} (K_p (e + f_{des} / k_e) + K_d \dot e) + J^T f_{des}

e is measured from the untouched surface along the rows of force, k_e is the stiffness that the surface is believed to have. No force is
sensed: an error in k_e, in the surface's place or in the joints' friction is an error of force.
"""

from ..compiled import kernel
from .inverse_motion import damping_of, invert_motion
from .law_state import ERROR, GRAM, RATE, SHARE, SPARE, SQUARE, TASK, TORQUE, WANTED_FORCE, WANTED_RATE, pull_back


@kernel
def implicit_force(joints, root, settings, aim, state, memory, room, report):
    """Torques of implicit force control into `lines[TORQUE]`; arguments as in `drive`."""
    lines, squares = room.lines, room.squares
    n = joints.size
    rows = settings.n_rows
    task = squares[TASK]
    lambda2 = damping_of(settings, task, rows, n, squares[GRAM], report)
    pull = lines[SPARE]
    force = lines[SPARE + 3]
    for i in range(rows):
        deep = lines[WANTED_FORCE, i] / settings.environment if settings.forced[i] else 0.0
        force[i] = lines[WANTED_FORCE, i] if settings.forced[i] else 0.0
        wanted = lines[WANTED_RATE, i] if settings.feed_velocity else 0.0
        pull[i] = settings.kp[i] * (lines[ERROR, i] + deep) + settings.kd[i] * (wanted - lines[RATE, i])
    motion = lines[SPARE + 1]
    invert_motion(task, rows, n, lines[SHARE], lambda2, pull, squares[SQUARE], lines[SPARE + 2], motion)
    for j in range(n):
        lines[TORQUE, j] = lines[SHARE, j] * motion[j]
    pull_back(task, rows, n, force, lines[TORQUE])
