"""The quadratic programme of one step: equation 19 with every limit as a row, as a kernel; the solver is DAQP's active-set method.

    minimise |q^ - k_p dV/dq^|^2 + |e|^2   with   J^ q^ + lambda e = T_v r_dot,   limits on q^

With no limit active and lambda = 0 the solution is equation 19 itself; lambda is small. Where freedoms would spend much motion on little,
they are damped (`calm`). A limit g is approached like a wall in a thick fluid: its rate towards the wall is at most kappa times
what is left.
"""

from typing import NamedTuple

import numpy as np

from .....compiled import kernel
from .....types import Floats, Ints
from .planted_feet import BALANCE, GUARD, N_ROWS
from .tool_chain import POSE

FREE = 1e30
"""What the solver takes for no bound."""

GIVES = 10.0
"""Of lambda squared: a tool that misses so little gives way to the manipulability, which at rest is all that is wanted [-]."""
HARDLY = 0.01
"""A tool that misses so little of the motion that is wanted of it [-] is not held back."""
MUCH = 0.1
"""One that misses so much is damped fully [-]."""


class Law(NamedTuple):
    """Numbers of the law, as kernels read them."""

    fastest: Floats
    """Largest speeds of the freedoms, T_q's, shape (m,) [m/s, rad/s]."""
    tool_speeds: Floats
    """Largest speeds of the tool, T_v's, shape (3,) [m/s]."""
    gain: float
    """k_p of the manipulability's gradient [-]."""
    approach: float
    """kappa: the rate towards a limit is at most this times what is left [1/s]."""
    inside: float
    """The bounds' inner margin [m]."""
    softness: float
    """lambda [-]."""
    little: Floats
    """What `calm` takes for little, of the plate and of the arm, shape (2,) [-]."""
    enough: Floats
    """Likewise for enough."""


class Programme(NamedTuple):
    """Arrays of the programme in q^ (m) and e (3): 1/2 |x|^2 + f.x, lower <= [x_m; A x] <= upper."""

    f: Floats
    """Shape (m + 3,)."""
    rows: Floats
    """A: three of the tool, then the bounds, shape (3 + N_ROWS, m + 3)."""
    lower: Floats
    """Shape (m + 3 + N_ROWS,)."""
    upper: Floats
    """Shape (m + 3 + N_ROWS,)."""
    sense: Ints
    """5 for equalities, shape (m + 3 + N_ROWS,)."""
    weights: Floats
    """The unit matrix, shape (m + 3, m + 3)."""
    which: Ints
    """Place in `limit_names` of what each lower and upper bound stands for, shape (m + 3 + N_ROWS, 2)."""


def make_programme(m: int) -> Programme:
    """Arrays for so many freedoms."""
    sense = np.zeros(m + 3 + N_ROWS, np.int32)
    sense[m : m + 3] = 5
    return Programme(
        np.zeros(m + 3),
        np.zeros((3 + N_ROWS, m + 3)),
        np.zeros(m + 3 + N_ROWS),
        np.zeros(m + 3 + N_ROWS),
        sense,
        np.eye(m + 3),
        np.zeros((m + 3 + N_ROWS, 2), np.int64),
    )


@kernel
def write_programme(chain, footing, q, law, w, p):
    """Write the programme of one step; returns how many rows it has.

    Args:
        chain: A `Chain`.
        footing: Record of `PLANTED_FEET`.
        q: Freedoms, shape (m,).
        law: A `Law`.
        w: A `Scratch` after `see_measure`, its `velocity` what is wanted of the tool.
        p: A `Programme`, filled.
    """
    m, speeds = q.size, w.speeds
    f, rows, lower, upper, which = p.f, p.rows, p.lower, p.upper, p.which
    joints = m - POSE
    quick = joints + N_ROWS  # first name of a speed
    kappa, inside = law.approach, law.inside
    for k in range(m):
        f[k] = -law.gain * w.gradient[k]
        lower[k], upper[k] = -1.0, 1.0
        which[k, 0] = which[k, 1] = quick + k
        if k >= POSE and speeds[k] > 0.0:
            joint = k - POSE
            lower[k] = max(-1.0, min(1.0, kappa * (chain.lowest[joint] - q[k]) / speeds[k]))
            upper[k] = min(1.0, max(-1.0, kappa * (chain.highest[joint] - q[k]) / speeds[k]))
            if lower[k] > -1.0:
                which[k, 0] = joint
            if upper[k] < 1.0:
                which[k, 1] = joint
    for i in range(3):
        f[m + i] = 0.0
        for k in range(m):
            rows[i, k] = w.scaled[i, k]
        for j in range(3):
            rows[i, m + j] = law.softness if i == j else 0.0
        lower[m + i] = w.velocity[i] / law.tool_speeds[i]
        upper[m + i] = lower[m + i]
    count = 3
    for row in range(BALANCE + footing.n_edges):
        if chain.row_lowest[row] == -np.inf and chain.row_highest[row] == np.inf:
            continue
        size = 0.0
        for k in range(m):
            rows[count, k] = w.gradients[row, k] * speeds[k]
            size += rows[count, k] * rows[count, k]
        if size < 1e-20:  # nothing that is switched on moves it
            continue
        low = kappa * (chain.row_lowest[row] + inside - w.values[row])
        high = kappa * (chain.row_highest[row] - inside - w.values[row])
        which[m + count, 0] = which[m + count, 1] = joints + row
        if row < BALANCE and row != GUARD:
            fastest = chain.row_speed[row]
            if low <= -fastest:
                which[m + count, 0] = quick + m + row
            if high >= fastest:
                which[m + count, 1] = quick + m + row
            low, high = max(-fastest, min(fastest, low)), min(fastest, max(-fastest, high))
        scale = 1.0 / np.sqrt(size)
        for k in range(m):
            rows[count, k] *= scale
        for j in range(3):
            rows[count, m + j] = 0.0
        lower[m + count] = max(-FREE, low * scale)
        upper[m + count] = min(FREE, high * scale)
        count += 1
    return count


@kernel
def calm(x, count, law, w, p):
    """Make motion dear where the tool is held back and spends much on little; whether that is so.

    On a stretched arm, at joints' ends, or in a corner of the plate's limits, freedoms would run at full speed for next to nothing and
    shake in steps. They are damped (Nakamura and Hanafusa 1986), the plate's and the arm's each by their own measure: the plate's are
    slow, and may go on where the arm may not.

    Args:
        x: Solution, shape (m + 3,).
        count: Rows, the tool's three among them.
        law: A `Law`.
        w: A `Scratch`; its speeds, by which the solution is multiplied, are scaled like what is damped of the programme.
        p: A `Programme`.
    """
    m, softness = x.size - 3, law.softness
    f, rows, lower, upper, speeds = p.f, p.rows, p.lower, p.upper, w.speeds
    wanted, missed, gained = 0.0, 0.0, 0.0
    for i in range(3):
        wanted += lower[m + i] * lower[m + i]
        missed += (softness * x[m + i]) ** 2
        gained += (lower[m + i] - softness * x[m + i]) ** 2
    if missed <= HARDLY * HARDLY * wanted + (GIVES * softness * softness) ** 2:
        return False
    held = min(1.0, missed / (MUCH * MUCH * wanted))
    any_dear = False
    for group in range(2):
        first, end = (0, POSE) if group == 0 else (POSE, m)
        little, enough = law.little[group], law.enough[group]
        spent = 0.0
        for k in range(first, end):
            spent += x[k] * x[k]
        if gained >= little * little * spent:
            continue
        dear = enough * held * (1.0 - gained / (little * little * spent)) / (softness * softness)
        if dear <= 1.0:
            continue
        any_dear = True
        scale = 1.0 / np.sqrt(dear)
        for k in range(first, end):
            f[k] *= scale
            lower[k] /= scale
            upper[k] /= scale
            speeds[k] *= scale
            for i in range(count):
                rows[i, k] *= scale
    return any_dear


@kernel
def let_rest(count, p):
    """Let every bound's row allow rest, which then satisfies all of them: for where pushing back from two walls at once cannot be.

    Args:
        count: Rows, the tool's three among them.
        p: A `Programme`, changed.
    """
    m = p.f.size - 3
    for k in range(m + 3, m + count):
        p.lower[k] = min(0.0, p.lower[k])
        p.upper[k] = max(0.0, p.upper[k])


@kernel
def mark_tight(multipliers, count, p, tight):
    """How strongly each limit holds the motion back.

    Args:
        multipliers: Of the solution, positive at upper bounds, shape (at least m + count,).
        count: Rows, the tool's three among them.
        p: A `Programme`.
        tight: Filled with the size of the multiplier, 0 where the limit is not touched, shape (names,).
    """
    m = p.f.size - 3
    tight[:] = 0.0
    for k in range(m + count):
        if not m <= k < m + 3 and multipliers[k] != 0.0:
            name = p.which[k, 1] if multipliers[k] > 0.0 else p.which[k, 0]
            tight[name] = max(tight[name], abs(multipliers[k]))


@kernel
def take_rates(x, p, w):
    """q_dot from the solution, into the scratch: the solver keeps bounds to its tolerance, the clip to the last bit.

    Args:
        x: Solution, shape (m + 3,).
        p: A `Programme`.
        w: A `Scratch`.
    """
    for k in range(w.speeds.size):
        w.rates[k] = min(p.upper[k], max(p.lower[k], x[k])) * w.speeds[k]
