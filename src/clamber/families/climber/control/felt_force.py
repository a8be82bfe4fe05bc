r"""What a limb's tip feels, told from its motors and encoders alone: what the motors give less what turns the rotors and rubs. Kernel.

A geared motor's own inertia takes most of its torque when nothing holds the tip, so how little the joints turn does not tell; what is left
over does. The left-over :math:`\tau - I \ddot q - b \dot q - c\,\mathrm{sgn}\,\dot q`, smoothed, is the torque at the joint's output, and
:math:`J^{-T}` makes of it the force of the tip on what it touches.
"""

import math

from ....compiled import kernel, opened

SLOW = 0.05
"""Friction acts fully against joints that turn faster than this [rad/s]; of a joint at rest it is not known, and left out."""
FLAT = 0.15
"""Sine of the angle between both links below which joint torques do not tell the force along them."""


@kernel
def feel_forces(handle, angle, period, rate):
    """Forces of the tips on what they touch.

    Args:
        handle: Holds records of `PLANAR_LIMB`, shape (n,); 1 for limbs that hold, shape (n,); and, shape (n, 2) each: joint angles now,
            speeds now, speeds at the tick before, set to those of now, torques of the motors since then [N m], those at the joints'
            outputs, smoothed and changed [N m], and the forces, filled, world frame [N]; of a limb that is stretched or folded,
            infinite: nobody can tell.
        angle: Of the body [rad].
        period: Between both ticks [s].
        rate: Part of the way to the newest value that the smoothed one goes at a tick.

    Returns:
        Sum of the forces' sizes [N]; infinite where a limb that holds cannot tell, others that cannot count as none.
    """
    legs, held, q, qd, before, torques, felt, forces = opened(handle)
    total = 0.0
    for i in range(legs.size):
        leg = legs[i]
        for k in range(2):
            dry, wet, rotor = (
                (leg.friction1, leg.damping1, leg.rotor1) if k == 0 else (leg.friction2, leg.damping2, leg.rotor2)
            )
            rub = wet * qd[i, k] + dry * min(1.0, max(-1.0, qd[i, k] / SLOW))
            now = torques[i, k] - rub - rotor * (qd[i, k] - before[i, k]) / period
            felt[i, k] += rate * (now - felt[i, k])
            before[i, k] = qd[i, k]
        first = angle + leg.port_angle + q[i, 0]
        second = first + q[i, 1] + leg.beta
        own = leg.heft2 * math.cos(first + q[i, 1])
        t1 = felt[i, 0] - leg.heft1 * math.cos(first) - own
        t2 = felt[i, 1] - own
        bend = math.sin(q[i, 1] + leg.beta)
        if abs(bend) < FLAT:
            forces[i, 0] = math.inf
            forces[i, 1] = math.inf
            if held[i]:
                total = math.inf
            continue
        j00 = -leg.l1 * math.sin(first) - leg.l2 * math.sin(second)
        j10 = leg.l1 * math.cos(first) + leg.l2 * math.cos(second)
        j01 = -leg.l2 * math.sin(second)
        j11 = leg.l2 * math.cos(second)
        det = leg.l1 * leg.l2 * bend
        forces[i, 0] = (j11 * t1 - j10 * t2) / det
        forces[i, 1] = (-j01 * t1 + j00 * t2) / det
        total += math.hypot(forces[i, 0], forces[i, 1])
    return total
