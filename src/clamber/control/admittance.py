r"""Admittance, or accommodation, control (Whitney 1977; Bevly 1997, 3.2.4): a felt force moves the aim, and a joint servo follows the aim.

The aim yields like a mass on a spring and a damper to the force that is felt less than the wanted one,

.. math:: m \dot v + d\,v + k\,z = f_{des} - f, \quad \dot z = v, \quad
    \dot\theta_{des} = J^{-1} (\dot x_{des} + v + K e'), \quad e' = x_{des} + z - x

and the servo is that of resolved rate control, so friction in the joints stays inside it. It needs a force sensor at the tip.
"""

from ..compiled import kernel
from .inverse_motion import joint_motion
from .law_state import ERROR, FELT, SHARE, SPARE, TORQUE, WANTED_FORCE, WANTED_RATE


@kernel
def admittance(joints, root, settings, aim, state, memory, room, report):
    """Torques of admittance control into `lines[TORQUE]`; arguments as in `drive`. Memory: by row offset z, then its speed v."""
    lines, qd = room.lines, state[1]
    n, rows = joints.size, settings.n_rows
    offset = memory[0:rows]
    yielding = memory[rows : 2 * rows]
    speed = lines[SPARE]
    period = settings.period
    for i in range(rows):
        pull = lines[WANTED_FORCE, i] - lines[FELT, i] - settings.admittance_kp[i] * offset[i]
        # implicit in the damping, so that any mass, none too, is stable
        yielding[i] = (settings.mass[i] * yielding[i] + period * pull) / (
            settings.mass[i] + period * settings.admittance_kd[i]
        )
        offset[i] += period * yielding[i]
        wanted = lines[WANTED_RATE, i] if settings.feed_velocity else 0.0
        error = lines[ERROR, i] + offset[i]
        speed[i] = wanted + yielding[i] + settings.kp[i] / settings.joint_kd * error
    motion = joint_motion(n, settings, speed, room, report)
    for j in range(n):
        lines[TORQUE, j] = lines[SHARE, j] * settings.joint_kd * (motion[j] - qd[j])
