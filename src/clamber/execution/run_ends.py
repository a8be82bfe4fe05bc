"""What ends a run before its last action, of whatever robot, though neither a plan nor a user is to blame."""

import math
from typing import ClassVar

from .run_report import Outcome


class RunEndedError(Exception):
    """The run ends here, with this reason. Never a user's mistake."""

    word: ClassVar[Outcome]
    """Outcome of the action that it ended, and first word of the run's reason."""


class FallenError(RunEndedError):
    """The robot has fallen."""

    word = "fell"


class StuckError(RunEndedError):
    """The robot stands, and nothing that it may do brings it on."""

    word = "stuck"


class FaultError(RunEndedError):
    """The robot has noticed a fault in itself and is to stop safely."""

    word = "fault"


class RefusedError(RunEndedError):
    """A motion would break a rule of the robot: it is not begun, or stops where it is.

    Args:
        reason: Which rule.
        margin: By how much it would be kept, negative [m]; NaN where that has no number.
    """

    word = "refused"

    def __init__(self, reason: str, margin: float = math.nan) -> None:
        super().__init__(reason, margin)
        self.reason, self.margin = reason, margin

    def __str__(self) -> str:
        return self.reason
