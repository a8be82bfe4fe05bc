r"""Hybrid position and force control (Raibert and Craig 1981; Bevly 1997, 3.5): SCCT along the rows of motion, J^T along the rows of force.

.. math:: \tau = K' J^{-1} S (K_p e + K_d \dot e) + J^T (E - S) (f_{des} + f_I + d\,\dot e)

The task frame is turned so that its rows lie along and across the surface; S keeps the rows of motion. With a sensed force, f_I sums the
error of force, k_i times its integral, to at most `force_limit`: joint friction stays inside that loop (3.3.3). It rests while less than a
tenth of the wanted force is felt, so that nothing adds up on the way to the surface. J^T must not act along a direction that is free to
move: the damping d bounds how fast the limb approaches a surface that is not there, by f_des / d above the speed of the aim.
"""

from ..compiled import kernel
from .inverse_motion import joint_motion
from .law_state import ERROR, FELT, RATE, SHARE, SPARE, TASK, TORQUE, WANTED_FORCE, WANTED_RATE, pull_back

TOUCHING = 0.1
"""Part of the wanted force from which the tip counts as touching the surface."""


@kernel
def hybrid(joints, root, settings, aim, state, memory, room, report):
    """Torques of hybrid control into `lines[TORQUE]`; arguments as in `drive`. Memory: by row the integral of the error of force."""
    lines = room.lines
    n, rows = joints.size, settings.n_rows
    pull = lines[SPARE]
    force = lines[SPARE + 3]
    for i in range(rows):
        wanted = lines[WANTED_RATE, i] if settings.feed_velocity else 0.0
        if settings.forced[i]:
            pull[i] = 0.0
            wanted_force = lines[WANTED_FORCE, i]
            if lines[FELT, i] * wanted_force >= TOUCHING * wanted_force * wanted_force:
                memory[i] += settings.force_gain * settings.period * (wanted_force - lines[FELT, i])
            memory[i] = min(max(memory[i], -settings.force_limit), settings.force_limit)
            force[i] = wanted_force + memory[i] + settings.force_damping * (wanted - lines[RATE, i])
        else:
            force[i] = 0.0
            pull[i] = settings.kp[i] * lines[ERROR, i] + settings.kd[i] * (wanted - lines[RATE, i])
    motion = joint_motion(n, settings, pull, room, report)
    for j in range(n):
        lines[TORQUE, j] = lines[SHARE, j] * motion[j]
    pull_back(room.squares[TASK], rows, n, force, lines[TORQUE])
