"""Whether the feet that stand carry a robot whose arm swings with what it holds."""

from typing import Final

import numpy as np

from ....control.support import support_margin
from ....types import Floats
from ..control.walker_balance import mass_centre
from .walker import RefusedError, Walker

LOOKED_AT: Final = 13
"""Postures of a swing at which balance is looked at."""


def check_swing(walker: Walker, start: Floats, end: Floats, what: str) -> None:
    """Refuse a swing of the arm that would bring the centre of mass too near to an edge of the feet that stand.

    Arms swing so slowly that their acceleration counts for less than a millimetre of the margin: statics decide.

    Args:
        walker: The robot; its plate stays.
        start: Joint angles where the swing begins, shape (joints,) [rad].
        end: Where it ends; all joints go evenly from one to the other.
        what: How the arm moves, for the reason.

    Raises:
        RefusedError: If it would; the margin is what is missing.
    """
    kept = walker.settings.limits.balance
    arms = start + np.linspace(0.0, 1.0, LOOKED_AT)[:, None] * (end - start)
    centres = [mass_centre(walker.robot, walker.pose, walker.place, arm, walker.payload) for arm in arms]
    least = min(float(support_margin(walker.soles, walker.stands, centre)) for centre in centres)
    if least < kept:
        raise RefusedError(
            f"with {walker.payload:g} kg the arm, {what}, brings the centre of mass {1e3 * least:.0f} mm inside the feet that stand, "
            f"and {1e3 * kept:.0f} mm are kept",
            least - kept,
        )
