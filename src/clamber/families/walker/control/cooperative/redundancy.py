"""Equation 19 of Hoshino and others, the law that shares a tool's motion among all freedoms, as a kernel.

    q_dot = T_q^-1 [ J^+ T_v r_dot + k_p (I - J^+ J^) xi ]

J^+ is the pseudo-inverse of the normalised Jacobian J^, xi = dV/dq^ the gradient of the manipulability of J^. The paper prints (13) and
(16) with the plain Jacobian, of all freedoms; `as printed` takes that xi, which lowers V in many postures.
"""

from .....compiled import kernel
from .....control.matrices import back_substitute, factor
from .manipulability import gram


@kernel
def share_motion(scaled, speeds, tool_speeds, velocity, xi, gain, damping, square, right, rates):
    """Rates of the freedoms by equation 19; False (and no motion) where J^ J^' + damping^2 cannot be inverted.

    Args:
        scaled: J^ [-], shape (3, m).
        speeds: Largest speeds of the freedoms [m/s, rad/s], shape (m,); 0 switches one off.
        tool_speeds: Of the tool [m/s], shape (3,).
        velocity: Wanted of the tool, feedback included, world [m/s], shape (3,).
        xi: dV/dq^ [-], shape (m,).
        gain: k_p [-].
        damping: lambda [-]; 0 takes the pseudo-inverse itself.
        square: Scratch, shape (3, 3).
        right: Scratch, shape (3,).
        rates: Filled with q_dot [m/s, rad/s], shape (m,).
    """
    m = speeds.size
    gram(scaled, square)
    for i in range(3):
        square[i, i] += damping * damping
        total = velocity[i] / tool_speeds[i]
        for k in range(m):
            total -= gain * scaled[i, k] * xi[k]
        right[i] = total
    if not factor(square, 3):
        for k in range(m):
            rates[k] = 0.0
        return False
    back_substitute(square, 3, right)
    # J^+ b + k_p (I - J^+ J^) xi = k_p xi + J^+ (b - k_p J^ xi)
    for k in range(m):
        total = gain * xi[k]
        for i in range(3):
            total += scaled[i, k] * right[i]
        rates[k] = speeds[k] * total
    return True
