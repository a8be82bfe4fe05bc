"""The plate on planted feet: where its origin goes and how it turns when the legs of one frame tilt it, as kernels.

A leg is normal to the plate, so a tilt moves the plate across its feet: 0.35 m of leg and 10 deg make 61 mm. Feet that give alike in
all directions keep their middle under the frame's origin along the plate's normal, and their heading: the turn nearest to the map of
the plate's directions to the ground along its normal, which is also the nearest to their map straight down. With the heading's change
chi = atan2(s_beta s_gamma, c_beta + c_gamma):

    x, y = X, Y + (z - h) Rz(alpha) [tan beta, -tan gamma / c_beta],   alpha = psi + chi(beta, gamma)

X, Y, h is the middle of the feet and psi their heading. The rows and columns below are those of the chain's freedoms.
"""

import math

import numpy as np

from .....compiled import inlined, kernel
from .....types import Floats
from .plate_turn import plate_turn

X, Y, Z, ALPHA, BETA, GAMMA = 0, 1, 2, 3, 4, 5


@inlined
def heading_change(beta, gamma):
    """chi(beta, gamma): yaw of the plate, less the heading of its feet [rad]."""
    return math.atan2(math.sin(beta) * math.sin(gamma), math.cos(beta) + math.cos(gamma))


def turn_of(angles: Floats) -> Floats:
    """R of a plate's alpha, beta, gamma [rad], shape (3, 3)."""
    turn = np.empty((3, 3))
    plate_turn(angles, turn, np.empty((3, 3, 3)), np.empty((3, 3, 3, 3)))
    return turn


def heading_of(angles: Floats) -> float:
    """psi, the heading of the feet under a plate of yaw alpha, tilted by beta, gamma [rad]."""
    return float(angles[0] - heading_change(angles[1], angles[2]))


@kernel
def stand(q, anchor, heading):
    """Set x, y and alpha from z, beta and gamma.

    Args:
        q: Freedoms; entries 0, 1 and 3 are overwritten.
        anchor: Middle of the feet, world [m], shape (3,).
        heading: Of the feet, psi [rad].
    """
    alpha = heading + heading_change(q[BETA], q[GAMMA])
    over = q[Z] - anchor[2]
    vx = math.tan(q[BETA])
    vy = -math.tan(q[GAMMA]) / math.cos(q[BETA])
    c, s = math.cos(alpha), math.sin(alpha)
    q[X] = anchor[0] + over * (c * vx - s * vy)
    q[Y] = anchor[1] + over * (s * vx + c * vy)
    q[ALPHA] = alpha


@kernel
def follow_feet(q, anchor, follow, follow_1):
    """The derivatives of `stand`.

    Args:
        q: Freedoms, x, y and alpha as `stand` sets them.
        anchor: Middle of the feet, world [m], shape (3,).
        follow: Filled with d(x, y, alpha) / d(z, beta, gamma), shape (3, 3).
        follow_1: Filled with d^2(x, y, alpha) / d(z, beta, gamma)^2, shape (3, 3, 3): [row, j, k].
    """
    cb, sb, cg, sg = math.cos(q[BETA]), math.sin(q[BETA]), math.cos(q[GAMMA]), math.sin(q[GAMMA])
    tg = sg / cg
    over = q[Z] - anchor[2]
    c, s = math.cos(q[ALPHA]), math.sin(q[ALPHA])
    whole = 1.0 + cb * cg
    # chi and its derivatives by beta, gamma
    chi_b, chi_g = sg / whole, sb / whole
    chi_bb, chi_gg = sb * sg * cg / (whole * whole), sb * sg * cb / (whole * whole)
    chi_bg = (cb + cg) / (whole * whole)
    # v = [tan beta, -tan gamma / cos beta], in the heading's frame
    v = (sb / cb, -tg / cb)
    v_b = (1.0 / (cb * cb), -tg * sb / (cb * cb))
    v_g = (0.0, -1.0 / (cg * cg * cb))
    v_bb = (2.0 * sb / (cb * cb * cb), -tg * (1.0 + sb * sb) / (cb * cb * cb))
    v_bg = (0.0, -sb / (cg * cg * cb * cb))
    v_gg = (0.0, -2.0 * tg / (cg * cg * cb))
    for i in range(2):
        # a quarter turn of w is (-w_y, w_x)
        turned = -v[1] if i == 0 else v[0]
        turned_b = -v_b[1] if i == 0 else v_b[0]
        turned_g = -v_g[1] if i == 0 else v_g[0]
        follow[i, 0] = v[i]
        follow[i, 1] = v_b[i] + chi_b * turned
        follow[i, 2] = v_g[i] + chi_g * turned
        follow_1[i, 0, 0] = 0.0
        follow_1[i, 0, 1] = follow[i, 1]
        follow_1[i, 0, 2] = follow[i, 2]
        follow_1[i, 1, 1] = v_bb[i] + 2.0 * chi_b * turned_b + chi_bb * turned - chi_b * chi_b * v[i]
        follow_1[i, 2, 2] = v_gg[i] + 2.0 * chi_g * turned_g + chi_gg * turned - chi_g * chi_g * v[i]
        follow_1[i, 1, 2] = v_bg[i] + chi_b * turned_g + chi_g * turned_b + chi_bg * turned - chi_b * chi_g * v[i]
        for j in (1, 2):
            follow[i, j] *= over
            for k in (1, 2):
                if k >= j:
                    follow_1[i, j, k] *= over
    follow[2, 0] = 0.0
    follow[2, 1] = chi_b
    follow[2, 2] = chi_g
    for k in range(3):
        follow_1[2, 0, k] = 0.0
    follow_1[2, 1, 1] = chi_bb
    follow_1[2, 1, 2] = chi_bg
    follow_1[2, 2, 2] = chi_gg
    # out of the heading's frame
    for j in range(3):
        a, b = follow[0, j], follow[1, j]
        follow[0, j] = c * a - s * b
        follow[1, j] = s * a + c * b
        for k in range(j, 3):
            a, b = follow_1[0, j, k], follow_1[1, j, k]
            follow_1[0, j, k] = c * a - s * b
            follow_1[1, j, k] = s * a + c * b
    for i in range(3):
        for j in range(3):
            for k in range(j):
                follow_1[i, j, k] = follow_1[i, k, j]


@inlined
def _freedom(row):
    """The freedom of a row of `follow`: x, y, alpha."""
    return ALPHA if row == 2 else row


@inlined
def _cause(column):
    """The freedom of a column of `follow`: z, beta, gamma."""
    return Z if column == 0 else BETA + column - 1


@kernel
def along_feet(jacobian, follow):
    """Make of derivatives by the free plate's coordinates those by z, beta, gamma of a planted one, in place: J C.

    Args:
        jacobian: Rows of derivatives, shape (rows, m); the columns of x, y and alpha become 0.
        follow: From `follow_feet`.
    """
    for i in range(jacobian.shape[0]):
        for j in range(3):
            total = 0.0
            for row in range(3):
                total += jacobian[i, _freedom(row)] * follow[row, j]
            jacobian[i, _cause(j)] += total
        for row in range(3):
            jacobian[i, _freedom(row)] = 0.0


@kernel
def curve_along_feet(jacobian, follow, follow_1, curvature):
    """Likewise of the second derivatives of a point, in place: C' H C + J dC.

    Args:
        jacobian: J of the free plate, as it was before `along_feet`, shape (3, m).
        follow, follow_1: From `follow_feet`.
        curvature: H of the free plate from `tool_curvature`, shape (m, 3, m).
    """
    for k in range(jacobian.shape[1]):
        along_feet(curvature[k], follow)
    for i in range(3):
        along_feet(curvature[:, i].T, follow)
        for j in range(3):
            for k in range(3):
                total = 0.0
                for row in range(3):
                    total += jacobian[i, _freedom(row)] * follow_1[row, j, k]
                curvature[_cause(j), i, _cause(k)] += total
