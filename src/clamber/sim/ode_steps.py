r"""The simplified limb of Bevly (1997), Eq. 3.28 with its signs put right, stepped as a kernel with stick and slip exact.

.. math:: I \ddot\theta = \tau - d\,\dot\theta - \tau_f\,\mathrm{sign}(\dot\theta) + J^T f

Each joint is by itself: only the reflected inertia of its motor and gear counts, so there is no link inertia and no Coriolis torque.
Over one step the torque and J^T f stand still, and the equation has a closed form between two standstills: no step is too long for
friction, no joint chatters or creeps. J^T f is taken at the middle of the step, which makes the step exact without a force and of
second order with one.
"""

import math

from ..compiled import inlined, kernel
from ..control.kinematics import fill_jacobian, place_chain
from .electronics import limited

SMALL = 1e-4
"""Below this step over time constant a series stands for the closed form, which would lose digits."""


@kernel
def coast(inertia, damping, pull, speed, time):
    """Angle moved and speed after `time` under the net torque `pull`, friction included, without a standstill between.

    Solves inertia * v' = pull - damping * v from v = `speed`.
    """
    rate = damping / inertia
    x = rate * time
    first = time * (1.0 - x / 2.0 + x * x / 6.0) if x < SMALL else -math.expm1(-x) / rate
    second = time * time * (0.5 - x / 6.0 + x * x / 24.0) if x < SMALL else (time - first) / rate
    push = pull / inertia
    return speed * first + push * second, speed * (1.0 - rate * first) + push * first


@kernel
def step_joint(inertia, damping, friction, torque, speed, time):
    """Angle moved and speed after `time` of one joint with Coulomb friction under a steady torque.

    A joint at rest with no more torque than `friction` stays; one that comes to rest within the step stops there, and goes on the other
    way for what is left of the step only if the torque can carry it.
    """
    moved = 0.0
    if speed != 0.0:
        pull = torque - math.copysign(friction, speed)
        step, after = coast(inertia, damping, pull, speed, time)
        if after * speed > 0.0:
            return step, after
        # When the speed is 0; net torque is against it, else it would not have changed its sign
        rate = damping / inertia
        ratio = -speed * inertia / pull
        stop = min(math.log1p(rate * ratio) / rate if rate > 0.0 else ratio, time)
        moved, _ = coast(inertia, damping, pull, speed, stop)
        time -= stop
    if abs(torque) <= friction or time <= 0.0:
        return moved, 0.0
    step, after = coast(inertia, damping, torque - math.copysign(friction, torque), 0.0, time)
    return moved + step, after


@inlined
def _push_joints(joints, root, q, force, frames, tip, jacobian, out):
    """Joint torques of a force on the tip, J^T f."""
    n = joints.size
    if force[0] == 0.0 and force[1] == 0.0:
        for j in range(n):
            out[j] = 0.0
        return
    place_chain(joints, root, q, frames, tip)
    fill_jacobian(joints, frames, tip, jacobian)
    for j in range(n):
        out[j] = jacobian[0, j] * force[0] + jacobian[1, j] * force[1]


@kernel
def step_limbs(joints, root, motors, force, steps, states, torques, scratch):
    """Move a batch of limbs by some physics steps; each limb by itself, so a batch gives the bits of single runs.

    Args:
        joints: Records of `JOINT`, shape (n,).
        root: One record of `ROOT`, shape (1,).
        motors: Torques asked of them, shape (batch, n) [N m], and their limits and speeds without load, as in `limit_torques`, which count
            anew at every step.
        force: On the tip, base frame, x and y [N].
        steps: How many, and the time of one [s].
        states: Joint angles and speeds, moved on, shape (batch, 2, n).
        torques: Filled with what the motors gave, the mean of all steps, shape (batch, n) [N m].
        scratch: Frames, shape (n, FRAME), a Jacobian, shape (6, n), and lines, shape (4, at least n and 12).
    """
    wanted, limits, no_load = motors
    count, time = steps
    frames, jacobian, lines = scratch
    n = joints.size
    tip = lines[0]
    pushed = lines[1]
    middle = lines[2]
    given = lines[3]
    for b in range(states.shape[0]):
        q = states[b, 0]
        qd = states[b, 1]
        for k in range(count):
            for j in range(n):
                given[j] = limited(wanted[b, j], qd[j], limits[j], no_load[j])
                before = torques[b, j] if k else given[j]
                torques[b, j] = before + (given[j] - before) / (k + 1)
            _push_joints(joints, root, q, force, frames, tip, jacobian, pushed)
            if force[0] != 0.0 or force[1] != 0.0:
                for j in range(n):
                    joint = joints[j]
                    moved, _ = step_joint(
                        joint.rotor, joint.damping, joint.friction, given[j] + pushed[j], qd[j], time / 2.0
                    )
                    middle[j] = q[j] + moved
                _push_joints(joints, root, middle, force, frames, tip, jacobian, pushed)
            for j in range(n):
                joint = joints[j]
                moved, after = step_joint(joint.rotor, joint.damping, joint.friction, given[j] + pushed[j], qd[j], time)
                q[j] += moved
                qd[j] = after
