"""What is told of a plan of a robot in space that was carried out: of every motion, and as a whole."""

from dataclasses import dataclass, field
from typing import Annotated, Literal

from ....execution.run_report import Moment, Outcome, RunReport
from ....json_form import Count, Jsonable, Key, OrNull

CarryingOutcome = Literal["ok", "missed", "refused", "stuck", "fell", "fault", "stopped", "interrupted"]
"""Those that a motion may have."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MotionReport(Jsonable):
    """What became of a motion."""

    first: Count
    """Of the plan's actions that it carries out, from 1."""
    last: Count
    limb: str | None
    """That took another hold; None: the body moved."""
    hold: int | None
    """Number of the hold."""
    outcome: Annotated[Outcome, Key(kind=CarryingOutcome)]
    start: float
    """When it began [s]."""
    seconds: float
    """That it took."""
    off: OrNull
    """Of the tip from its hold when it was taken, or of the body from where it was to be, as believed [m]."""
    tries: Count
    reason: str = ""


@dataclass(frozen=True, slots=True)
class NewPlan(Jsonable):
    """A plan made on the way."""

    after: Count
    """Motions that had been carried out."""
    missed: list[int]
    """Numbers of the holds that it does without."""
    actions: Count
    locked: list[str] = field(default_factory=list)
    """Joints that have failed, so that it does without their limbs."""


@dataclass(frozen=True, slots=True)
class LoggedMotion:
    """What is read back of a motion; see `MotionReport`."""

    outcome: Outcome
    start: Moment
    seconds: Moment
    limb: str | None = None
    hold: int | None = None
    off: float | None = None
    reason: str = ""


@dataclass(frozen=True, slots=True)
class LoggedRun:
    """What is read back of the report in a run's log."""

    motions: list[LoggedMotion] = field(default_factory=list)


@dataclass(slots=True, kw_only=True)
class CarryingReport(RunReport):
    """How a run went; its pose is that of the body: x, y, z [m], then a quaternion w, x, y, z."""

    motions: list[MotionReport] = field(default_factory=list)
    replans: list[NewPlan] = field(default_factory=list)
    off: float = 0.0
    """Largest distance of the body from where it was to be, as believed [m]."""
    torque: float = 0.0
    """Largest share of a joint's torque that was asked for [-]."""
    failures: Count = 0
    """Ticks in which no torques kept all limits."""
