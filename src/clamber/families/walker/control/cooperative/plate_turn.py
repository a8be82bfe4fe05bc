"""The plate's turn R = Rz(alpha) Ry(beta) Rx(gamma) and its derivatives by the three angles, as kernels."""

import math

from .....compiled import inlined, kernel


@inlined
def _product(cz, sz, oz, cy, sy, oy, cx, sx, ox, out):
    """Rz Ry Rx of turns whose cosine, sine and own entry are given: derivatives of a turn have the same form."""
    a00, a01, a02 = cy * ox, sy * sx, sy * cx
    a11, a12 = oy * cx, -oy * sx
    out[0, 0] = cz * a00
    out[0, 1] = cz * a01 - sz * a11
    out[0, 2] = cz * a02 - sz * a12
    out[1, 0] = sz * a00
    out[1, 1] = sz * a01 + cz * a11
    out[1, 2] = sz * a02 + cz * a12
    out[2, 0] = -oz * sy * ox
    out[2, 1] = oz * cy * sx
    out[2, 2] = oz * cy * cx


@inlined
def _times(order, angle):
    """Cosine, sine and own entry (1) of a turn by an angle, each differentiated `order` times."""
    c, s = math.cos(angle), math.sin(angle)
    if order == 0:
        return c, s, 1.0
    if order == 1:
        return -s, c, 0.0
    return -c, -s, 0.0


@kernel
def plate_turn(angles, turn, turn_1, turn_2):
    """R and its derivatives.

    Args:
        angles: alpha, beta, gamma [rad], shape (3,).
        turn: Filled with R, plate to world, shape (3, 3).
        turn_1: Filled with dR / d angle k, shape (3, 3, 3).
        turn_2: Filled with d^2 R / d angle j d angle k, shape (3, 3, 3, 3).
    """
    for j in range(-1, 3):
        for k in range(-1, j + 1):
            za = (1 if j == 0 else 0) + (1 if k == 0 else 0)
            yb = (1 if j == 1 else 0) + (1 if k == 1 else 0)
            xc = (1 if j == 2 else 0) + (1 if k == 2 else 0)
            cz, sz, oz = _times(za, angles[0])
            cy, sy, oy = _times(yb, angles[1])
            cx, sx, ox = _times(xc, angles[2])
            if j < 0:
                _product(cz, sz, oz, cy, sy, oy, cx, sx, ox, turn)
            elif k < 0:
                _product(cz, sz, oz, cy, sy, oy, cx, sx, ox, turn_1[j])
            else:
                _product(cz, sz, oz, cy, sy, oy, cx, sx, ox, turn_2[j, k])
                if k != j:
                    turn_2[k, j] = turn_2[j, k]
