"""How large k_p may be: steps up the manipulability that are too long swing about its summit instead of coming to rest there."""

import numpy as np

from .....types import Floats
from .cooperator import Cooperator

NUDGE = 1e-5
"""Of a freedom, for the gradient's derivative [m, rad]."""


def stable_gain(law: Cooperator, q: Floats, weights: Floats) -> float:
    """The gain k_p below which equation 19's second term comes to rest at a summit of V near a configuration.

    In steps of dt, a deviation from the summit along a direction that leaves the tool where it is, is multiplied by 1 + k_p dt h, with
    h < 0 the slope of the second term's own strength (I - J^+ J^) dV/dq^ in that direction: it shrinks while k_p dt |h| < 2. The slopes
    are taken at `q`; the projection turns with the posture, so they are not those of the gradient alone.

    Args:
        law: With its settings.
        q: Freedoms, shape (m,).
        weights: Of the freedoms, shape (m,).

    Returns:
        2 / (dt |h|) for the steepest slope [-]; infinite where V rises to no summit.
    """
    speeds = weights * law.settings.speeds

    def projector(p: Floats) -> Floats:
        scaled = law.scaled_jacobian(p, weights)
        out: Floats = np.eye(p.size) - np.linalg.pinv(scaled) @ scaled
        return out

    slopes = np.empty((q.size, q.size))
    for k in range(q.size):
        ahead, behind = q.copy(), q.copy()
        ahead[k] += NUDGE
        behind[k] -= NUDGE
        change = projector(ahead) @ law.gradient(ahead, weights) - projector(behind) @ law.gradient(behind, weights)
        slopes[:, k] = speeds[k] * change / (2.0 * NUDGE)
    rest = projector(q)
    steepest = float(np.linalg.eigvals(rest @ slopes @ rest).real.min())
    return float("inf") if steepest >= 0.0 else 2.0 / (law.settings.period * -steepest)
