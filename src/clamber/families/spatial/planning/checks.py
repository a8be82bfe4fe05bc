"""All checks of an action in space: those of the stance that it leads to, and those of the way there."""

from typing import Final

from ....planning.problem.check import Check
from ..statics.checks import STANCE_CHECKS

CLEARANCE: Final = len(STANCE_CHECKS)
SWING: Final = CLEARANCE + 1
SPATIAL_CHECKS: Final[tuple[Check, ...]] = (
    *STANCE_CHECKS,
    Check("clearance", "m", "gap between links or base and the nearest solid, less what the task asks for"),
    Check(
        "swing",
        "m",
        "error that is allowed along the lifted path of an end effector, less the error that postures leave",
    ),
)
"""In the order of a replay's margins."""
