r"""Coordinated Jacobian transpose control of two holding limbs (Sunada 1992; Bevly 1997, 4.4.5, Fig. 4.13). Kernels.

Two limbs on their holds make a closed chain of mobility 3 with four motors, so four variables can be chosen: the body's x, y, theta, and
how far the second tip is inside its hold along the line of the holds. Springs act on each of them, and

.. math:: \tau_i = -J_i^T R_i, \quad R_1 + R_2 = F, \quad r_1 \times R_1 + r_2 \times R_2 = M, \quad u \cdot R_2 = -p

R_i are the forces of the holds on the tips, F and M those of the body's springs, p the pressing force along the unit vector u. The first
limb, from which the position counts, bears what is left: it must be able to push and pull in all directions.
"""

import math

from ....compiled import kernel

TOUCHING = 1e-6
"""Holds nearer than this make no line [m]."""


@kernel
def share_from_first(arms, first, second, wrench, press, forces):
    """Forces of two holds on their limbs.

    Args:
        arms: Holds less body, world frame, shape (n, 2) [m].
        first, second: Indices of the limb that bears what is left, and of the one that presses.
        wrench: That the limbs bring to the body, shape (3,) [N], [N m].
        press: Force of the second tip on its hold along the line from the first hold to the second [N].
        forces: Rows of both are filled, world frame, shape (n, 2) [N].
    """
    dx = arms[second, 0] - arms[first, 0]
    dy = arms[second, 1] - arms[first, 1]
    length = math.hypot(dx, dy)
    if length < TOUCHING:
        forces[second, 0] = 0.0
        forces[second, 1] = 0.0
    else:
        ux = dx / length
        uy = dy / length
        left = wrench[2] - (arms[first, 0] * wrench[1] - arms[first, 1] * wrench[0])
        across = left / length
        forces[second, 0] = -press * ux - across * uy
        forces[second, 1] = -press * uy + across * ux
    forces[first, 0] = wrench[0] - forces[second, 0]
    forces[first, 1] = wrench[1] - forces[second, 1]


@kernel
def transpose_torques(leg, q, pose, force, torques):
    """Torques -J^T R of a limb on whose tip its hold brings a force.

    Args:
        leg: A record of `PLANAR_LIMB`.
        q: Its joint angles, shape (2,) [rad].
        pose: Of the body, shape (3,) [m], [rad].
        force: R, world frame, shape (2,) [N].
        torques: Filled, shape (2,) [N m].
    """
    first = pose[2] + leg.port_angle + q[0]
    second = first + q[1] + leg.beta
    torques[1] = -leg.l2 * (math.cos(second) * force[1] - math.sin(second) * force[0])
    torques[0] = torques[1] - leg.l1 * (math.cos(first) * force[1] - math.sin(first) * force[0])
