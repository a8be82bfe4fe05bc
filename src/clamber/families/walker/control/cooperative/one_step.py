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
def _share_motion(law, w):
    """Rates of the freedoms by equation 19, into the scratch: none where J^ J^' cannot be inverted."""
    m, square, right = w.speeds.size, w.square, w.right
    gram(w.scaled, square)
    for i in range(3):
        total = w.velocity[i] / law.tool_speeds[i]
        for k in range(m):
            total -= law.gain * w.scaled[i, k] * w.gradient[k]
        right[i] = total
    if not factor(square, 3, square):
        for k in range(m):
            w.rates[k] = 0.0
        return
    back_substitute(square, 3, right)
    # J^+ b + k_p (I - J^+ J^) xi = k_p xi + J^+ (b - k_p J^ xi)
    for k in range(m):
        total = law.gain * w.gradient[k]
        for i in range(3):
            total += w.scaled[i, k] * right[i]
        w.rates[k] = w.speeds[k] * total


@kernel
def _want(feedback, target, target_velocity, law, limited, w):
    """Velocity of the tool with feedback, into the scratch, no faster than the tool may be."""
    size = 0.0
    for i in range(3):
        w.velocity[i] = target_velocity[i] + feedback * (target[i] - w.place[i])
        size += (w.velocity[i] / law.tool_speeds[i]) ** 2
    if limited and size > 1.0:
        for i in range(3):
            w.velocity[i] /= np.sqrt(size)


@kernel
def see(chain, footing, q, weights, law, limited, w):
    """Everything that the law reads of a configuration; returns V.

    Args:
        chain: A `Chain`.
        footing: Record of `PLANTED_FEET`.
        q: Freedoms, shape (m,).
        weights: Of the freedoms, 0 to 1, shape (m,).
        law: A `Law`.
        limited: Whether the plate stands on its feet, within its bounds; else it moves freely.
        w: A `Scratch`; its speeds become weights times the fastest.
    """
    for k in range(q.size):
        w.speeds[k] = weights[k] * law.fastest[k]
    see_tool(chain, q, w)
    if limited:
        see_bounds(chain, footing, q, w)
    return see_measure(w.speeds, law.tool_speeds, w)


@kernel
def _see_arm(law, w):
    """Leave the gradient of the arm's own V in the scratch, beside the whole J^; returns V."""
    plate = w.speeds[:POSE].copy()
    w.speeds[:POSE] = 0.0
    measure = see_measure(w.speeds, law.tool_speeds, w)
    w.speeds[:POSE] = plate
    normalise(w.jacobian, w.speeds, law.tool_speeds, w.scaled)
    return measure


@kernel
def prepare(chain, footing, q, weights, law, feedback, target, target_velocity, arm_alone, w, p):
    """One step's programme: V, of all that takes part or of the arm alone, and how many rows it has."""
    measure = see(chain, footing, q, weights, law, True, w)
    if arm_alone:
        measure = _see_arm(law, w)
    _want(feedback, target, target_velocity, law, True, w)
    return measure, write_programme(chain, footing, q, law, w, p)


@kernel
def finish(chain, footing, q, x, multipliers, count, time, tight, w, p):
    """Rates from the solution, and the largest share of the step within all bounds."""
    mark_tight(multipliers, count, p, tight)
    take_rates(x, p, w)
    return share_within(chain, footing, q, time, w)


@kernel
def move_freely(chain, footing, q, weights, law, feedback, target, target_velocity, printed, time, w):
    """One step of equation 19 without limits; returns V. The plate is where its freedoms say, on no feet."""
    measure = see(chain, footing, q, weights, law, False, w)
    _want(feedback, target, target_velocity, law, False, w)
    if printed:
        plain = manipulability(w.jacobian, w.grams)
        manipulability_gradient(plain, w.jacobian, w.grams, w.curvature, w.ones, w.ones[:3], w.gradient)
    _share_motion(law, w)
    for k in range(q.size):
        w.after[k] = q[k] + time * w.rates[k]
    return measure
