"""One step of cooperative motion, as kernels: what is seen, the programme of the step, and the step that was found.

Equation 19 of Hoshino and others, the law that shares a tool's motion among all freedoms, as a kernel.

    q_dot = T_q^-1 [ J^+ T_v r_dot + k_p (I - J^+ J^) xi ]

J^+ is the pseudo-inverse of the normalised Jacobian J^, xi = dV/dq^ the gradient of the manipulability of J^. The paper prints (13) and
(16) with the plain Jacobian, of all freedoms; `as printed` takes that xi, which lowers V in many postures.
"""

import numpy as np

from .....compiled import kernel
from .....control.matrices import back_substitute, factor
from .manipulability import gram, manipulability, manipulability_gradient, normalise
from .programme import mark_tight, take_rates, write_programme
from .scratch import see_bounds, see_measure, see_tool, share_within
from .tool_chain import POSE


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
    if not factor(square, 3, square):
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


@kernel
def _wanted(feedback, target, target_velocity, place, tool_speeds, limited, velocity):
    """Velocity of the tool with feedback, no faster than the tool may be."""
    size = 0.0
    for i in range(3):
        velocity[i] = target_velocity[i] + feedback * (target[i] - place[i])
        size += (velocity[i] / tool_speeds[i]) ** 2
    if limited and size > 1.0:
        for i in range(3):
            velocity[i] /= np.sqrt(size)


@kernel
def see(chain, footing, q, weights, fastest, tool_speeds, limited, speeds, w):
    """Everything that the law reads of a configuration; returns V.

    Args:
        chain: A `Chain`.
        footing: Record of `PLANTED_FEET`.
        q: Freedoms, shape (m,).
        weights: Of the freedoms, 0 to 1, shape (m,).
        fastest: Their largest speeds, shape (m,).
        tool_speeds: Of the tool, shape (3,).
        limited: Whether the plate stands on its feet, within its bounds; else it moves freely.
        speeds: Filled with weights times fastest, shape (m,).
        w: A `Scratch`.
    """
    for k in range(q.size):
        speeds[k] = weights[k] * fastest[k]
    see_tool(chain, q, w)
    if limited:
        see_bounds(chain, footing, q, w)
    return see_measure(speeds, tool_speeds, w)


@kernel
def _see_arm(speeds, tool_speeds, w):
    """Leave the gradient of the arm's own V in the scratch, beside the whole J^; returns V."""
    plate = speeds[:POSE].copy()
    speeds[:POSE] = 0.0
    measure = see_measure(speeds, tool_speeds, w)
    speeds[:POSE] = plate
    normalise(w.jacobian, speeds, tool_speeds, w.scaled)
    return measure


@kernel
def prepare(
    chain, footing, q, weights, fastest, tool_speeds, feedback, target, target_velocity, gain, arm_alone, law, speeds,
    velocity, w, f, rows, lower, upper, which,
):  # fmt: skip
    """One step's programme: V, of all that takes part or of the arm alone, and how many rows it has."""
    measure = see(chain, footing, q, weights, fastest, tool_speeds, True, speeds, w)
    if arm_alone:
        measure = _see_arm(speeds, tool_speeds, w)
    _wanted(feedback, target, target_velocity, w.place, tool_speeds, True, velocity)
    count = write_programme(
        chain, footing, q, speeds, tool_speeds, velocity, gain, law, w, f, rows, lower, upper, which
    )  # fmt: skip
    return measure, count


@kernel
def finish(chain, footing, q, x, multipliers, count, speeds, lower, upper, which, time, tight, w):
    """Rates from the solution, and the largest share of the step within all bounds."""
    mark_tight(multipliers, count, q.size, which, tight)
    take_rates(x, speeds, lower, upper, w.rates)
    return share_within(chain, footing, q, w.rates, time, w)


@kernel
def move_freely(
    chain, footing, q, weights, fastest, tool_speeds, feedback, target, target_velocity, gain, printed, damping, time,
    speeds, velocity, w,
):  # fmt: skip
    """One step of equation 19 without limits; returns V. The plate is where its freedoms say, on no feet."""
    measure = see(chain, footing, q, weights, fastest, tool_speeds, False, speeds, w)
    _wanted(feedback, target, target_velocity, w.place, tool_speeds, False, velocity)
    if printed:
        plain = manipulability(w.jacobian, w.grams)
        manipulability_gradient(plain, w.jacobian, w.grams, w.curvature, w.ones, w.ones[:3], w.gradient)
    share_motion(
        w.scaled, speeds, tool_speeds, velocity, w.gradient, gain, damping, w.square, w.right, w.rates
    )  # fmt: skip
    for k in range(q.size):
        w.after[k] = q[k] + time * w.rates[k]
    return measure
