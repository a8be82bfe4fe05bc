"""How well the tool can be moved: Yoshikawa's measure of the normalised chain and its gradient, as kernels.

With the largest speeds of the freedoms in T_q^-1 and those of the tool in T_v (equations 17 and 18 of Hoshino and others), the
normalised Jacobian is J^ = T_v J T_q^-1 and V = sqrt(det(J^ J^')) (13). A freedom whose largest speed is 0 is switched off: its column
of J^ vanishes. The gradient is dV/dq^_k = speed_k dV/dq_k with dV/dq_k = V tr[(J^ J^')^-1 (dJ^/dq_k) J^'].
"""

import math

from .....compiled import inlined, kernel


@kernel
def normalise(jacobian, speeds, tool_speeds, scaled):
    """J^ = T_v J T_q^-1.

    Args:
        jacobian: J, shape (3, m).
        speeds: Largest speeds of the freedoms [m/s, rad/s], shape (m,); 0 switches one off.
        tool_speeds: Largest speeds of the tool [m/s], shape (3,).
        scaled: Filled with J^ [-], shape (3, m).
    """
    for i in range(3):
        for k in range(speeds.size):
            scaled[i, k] = jacobian[i, k] * speeds[k] / tool_speeds[i]


@kernel
def gram(rows, out):
    """J J' of three rows, shape (3, 3)."""
    for i in range(3):
        for j in range(i + 1):
            total = 0.0
            for k in range(rows.shape[1]):
                total += rows[i, k] * rows[j, k]
            out[i, j] = total
            out[j, i] = total


@inlined
def determinant(g):
    """Of a 3 x 3 matrix."""
    return (
        g[0, 0] * (g[1, 1] * g[2, 2] - g[1, 2] * g[2, 1])
        - g[0, 1] * (g[1, 0] * g[2, 2] - g[1, 2] * g[2, 0])
        + g[0, 2] * (g[1, 0] * g[2, 1] - g[1, 1] * g[2, 0])
    )


@inlined
def adjugate(g, out):
    """Of a symmetric 3 x 3 matrix: its determinant times its inverse."""
    out[0, 0] = g[1, 1] * g[2, 2] - g[1, 2] * g[1, 2]
    out[1, 1] = g[0, 0] * g[2, 2] - g[0, 2] * g[0, 2]
    out[2, 2] = g[0, 0] * g[1, 1] - g[0, 1] * g[0, 1]
    out[0, 1] = g[0, 2] * g[1, 2] - g[0, 1] * g[2, 2]
    out[0, 2] = g[0, 1] * g[1, 2] - g[0, 2] * g[1, 1]
    out[1, 2] = g[0, 1] * g[0, 2] - g[0, 0] * g[1, 2]
    out[1, 0] = out[0, 1]
    out[2, 0] = out[0, 2]
    out[2, 1] = out[1, 2]


@kernel
def manipulability(scaled, grams):
    """V = sqrt(det(J^ J^')), 0 where the tool cannot be moved in some direction.

    Args:
        scaled: J^, shape (3, m).
        grams: Scratch, shape (2, 3, 3); the first is left with J^ J^', the second with its adjugate.
    """
    gram(scaled, grams[0])
    adjugate(grams[0], grams[1])
    return math.sqrt(max(0.0, determinant(grams[0])))


@kernel
def manipulability_gradient(measure, scaled, grams, curvature, speeds, tool_speeds, gradient):
    """dV/dq^ of the normalised freedoms; 0 where V is.

    Args:
        measure: V.
        scaled: J^, shape (3, m).
        grams: As `manipulability` left them.
        curvature: dJ/dq_k from `tool_curvature`, shape (m, 3, m).
        speeds: Largest speeds of the freedoms, shape (m,).
        tool_speeds: Of the tool [m/s], shape (3,).
        gradient: Filled, shape (m,).
    """
    m = speeds.size
    for k in range(m):
        total = 0.0
        if measure > 0.0 and speeds[k] != 0.0:
            for i in range(3):
                for j in range(3):
                    # tr[adj(G) dJ^ J^'] / V = V tr[G^-1 dJ^ J^'], for det G = V^2
                    part = 0.0
                    for column in range(m):
                        part += curvature[k, j, column] * speeds[column] * scaled[i, column]
                    total += grams[1, i, j] * part / tool_speeds[j]
            total *= speeds[k] / measure
        gradient[k] = total
