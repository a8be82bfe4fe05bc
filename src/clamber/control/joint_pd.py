r"""Joint PD control: the tip's aim becomes joint angles by inverse kinematics, and each joint is held there by itself.

.. math:: \tau = W (k_p (\theta_{des} - \theta) + k_d (\dot\theta_{des} - \dot\theta))

W = E or K'. The inverse kinematics go on from the angles of the last tick by damped Gauss-Newton steps, so the limb keeps its branch and
serves any chain. A step that leads away is taken back (Levenberg 1944), so an aim out of reach is met by the nearest pose, over several
ticks. Stiffness cannot be chosen by direction.
"""

import math

from ..compiled import kernel
from .inverse_motion import damped_motion, damping_of, invert_motion
from .kinematics import fill_jacobian, place_chain
from .law_state import GRAM, JACOBIAN, OTHER, SHARE, SPARE, SQUARE, TASK, TORQUE, WANTED_RATE, fill_error, fill_task

LOOKS = 7
"""At where the angles lead, a tick, at most; between two of them lies a step."""
LONGEST = 0.5
"""Longest step of a joint [rad]."""
NEAR = 1e-9
"""An error below this needs no further step [m]."""
LEAST = 1e-12
"""Damping of a step, smallest [m^2]."""
CARE = 1e-2
"""Damping of a step per error [m]."""
MORE_CARE = 16.0
"""Times that after a step that led away."""


@kernel
def joint_pd(joints, root, settings, aim, state, memory, room, report):
    """Torques of joint PD control into `lines[TORQUE]`; arguments as in `drive`.

    Memory: started, then the joint angles of the aim. Uses the second half of `frames`.
    """
    frames, lines, squares = room.frames, room.lines, room.squares
    q, qd = state[0], state[1]
    n = joints.size
    damping_of(settings, squares[TASK], settings.n_rows, n, squares[GRAM], report)
    angles = memory[1 : 1 + n]
    if memory[0] == 0.0:
        memory[0] = 1.0
        for j in range(n):
            angles[j] = q[j]
    _approach(joints, root, settings, aim, angles, frames[n:], lines, squares)
    motion = damped_motion(n, settings, lines[WANTED_RATE], lines, squares, report)
    for j in range(n):
        speed = motion[j] if settings.feed_velocity else 0.0
        pull = settings.joint_kp * (angles[j] - q[j]) + settings.joint_kd * (speed - qd[j])
        lines[TORQUE, j] = lines[SHARE, j] * pull


@kernel
def _approach(joints, root, settings, aim, angles, frames, lines, squares):
    """Gauss-Newton steps of `angles` towards the aim."""
    n = joints.size
    rows = settings.n_rows
    task = squares[OTHER]
    error = lines[SPARE]
    motion = lines[SPARE + 1]
    tip = lines[SPARE + 4]
    care = CARE
    before = math.inf
    for look in range(LOOKS):
        place_chain(joints, root, angles, frames, tip)
        fill_error(settings, aim, tip, lines[SPARE + 3], error)
        largest = 0.0
        square = 0.0
        for i in range(rows):
            largest = max(largest, abs(error[i]))
            square += error[i] * error[i]
        if not square < before:
            if before == math.inf:
                break  # too far for a number
            for j in range(n):
                angles[j] -= motion[j]
            care *= MORE_CARE
            before = math.inf
            continue
        if look == LOOKS - 1 or not largest > NEAR:
            break
        before = square
        fill_jacobian(joints, frames, tip, squares[JACOBIAN])
        fill_task(settings, squares[JACOBIAN], n, task)
        # damped in proportion to the error (Chan and Lawrence 1988): far or out of reach it is careful, near it is Newton's
        scratch = squares[SQUARE], lines[SPARE + 2]
        invert_motion(task, (rows, n), lines[SHARE], LEAST + care * largest, error, scratch, motion)
        longest = 0.0
        for j in range(n):
            longest = max(longest, abs(motion[j]))
        scale = LONGEST / longest if longest > LONGEST else 1.0
        for j in range(n):
            motion[j] *= scale
            angles[j] += motion[j]
