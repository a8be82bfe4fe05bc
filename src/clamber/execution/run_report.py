"""What is told of a run, of whatever robot: what may become of an action, and how the whole ended."""

import math
from dataclasses import dataclass, field
from typing import Annotated, ClassVar, Final, Literal, TypeAlias

from pydantic import Field

from ..json_form import Jsonable


@dataclass(frozen=True, slots=True)
class Finding(Jsonable):
    """A fault as the robot has noticed it."""

    kind: str
    """Such as "no number", "jump", "no answer", "unbalanced", "drift", "no reading", "late readings"."""
    where: str
    """Sensor or joint; empty for the link."""
    time: float
    """When it was noticed first [s]."""
    why: str
    """In words, with its numbers."""

    def __str__(self) -> str:
        at = f"{self.where}: " if self.where else ""
        return f"{at}{self.kind}: {self.why}"


Outcome: TypeAlias = Literal[
    "ok", "stalled", "moved", "missed", "no ground", "not supported", "refused", "stuck", "fell", "fault", "stopped",
    "interrupted",
]  # fmt: skip
"""What became of an action. Done: `ok`, or `stalled` (the body stays off its aim), or `moved` (a frame came down elsewhere). Not done:
`missed` a hold, found `no ground`, `not supported`, `refused` before it would break a rule, or the robot is `stuck`. Ended in it: the
robot `fell`, noticed a `fault` in itself and stopped, its plant was `stopped`, a user `interrupted` it."""
Moment: TypeAlias = Annotated[float, Field(ge=0.0, le=1e9)]
"""Time since a run's start, or how long something took, as a log may have it [s]."""
Ending: TypeAlias = Literal["", "held", "stopped safely", "fell"]
"""What became of the robot after a fault that ended its run: it `held` its posture, or `stopped safely` elsewhere, or `fell`."""

BRACED: Final = 3.0
"""For which a robot that has stopped for a fault is looked at [s] ..."""
SETTLED: Final = 0.5
"""... and by whose last part it is to be at rest [s]."""
HELD: Final = 0.05
"""A body that moves less than this from where the fault was noticed holds its posture [m]."""
RESTS: Final = 0.02
"""One that moves less than this at the end is at rest [m]."""


def ending_of(moved: float, late: float, *, holds: bool) -> Ending:
    """What became of a robot that has stopped for a fault.

    Args:
        moved: By its body since then [m].
        late: By its body in the last part of that [m]; one that swings on a hold is not at rest.
        holds: Whether something still holds it.
    """
    if not holds:
        return "fell"
    return "held" if moved < HELD and late < RESTS else "stopped safely"


@dataclass(slots=True, kw_only=True)
class RunReport(Jsonable):
    """How a run went; a kind of robot adds what became of its actions."""

    done: bool = False
    """Whether every action was carried out and the robot came to its goal with that."""
    reason: str = ""
    """Why it ended, where it is not done."""
    seconds: float = 0.0
    """Simulated, or on the robot's clock."""
    pose: tuple[float, ...] = ()
    """Of the body at the end, as believed [m], [rad]; empty if it never stood."""
    true_pose: tuple[float, ...] | None = None
    """As it truly was; None where nobody tells."""
    findings: list[Finding] = field(default_factory=list)
    """Faults that the robot noticed in itself, whether they ended the run or were bridged."""
    ending: Ending = ""
    """What became of it where one of them ended the run."""


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
