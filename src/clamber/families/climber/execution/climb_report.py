"""What is told of a plan that was carried out: of every action, and as a whole."""

import math
from dataclasses import dataclass, field
from typing import Annotated, Literal, TypeAlias

from pydantic import Field

from ....execution.plant import HoldBreak
from ....execution.run_report import Moment, Outcome, RunReport
from ....json_form import Count, Jsonable, Key
from ....types import Floats
from ..planning.task import LimbedTask

Pose: TypeAlias = tuple[float, float, float]
ClimbOutcome: TypeAlias = Literal["ok", "stalled", "missed", "fell", "fault", "interrupted", "stopped", "not supported"]
"""Those that an action of a climb may have."""


@dataclass(frozen=True, slots=True)
class ActionReport(Jsonable):
    """What happened to an action, or to like moves of the body that were carried out in one go."""

    first: int
    """Step of the plan, from 1."""
    last: int
    kind: str
    """none, move, release or grab."""
    title: str
    outcome: Annotated[Outcome, Key(kind=ClimbOutcome)]
    start: Moment
    """When it began [s]."""
    seconds: Moment
    tries: int
    """Pushes of the hook of a grab; ways of the body; 1 for the rest."""
    off: float
    """Body from its aim at the end, as believed [m]."""
    body_error: float | None
    """Body, believed from true, at the end [m]; None where nobody tells."""
    tip_error: float | None
    """The same of the tip of the limb that acted [m]."""
    reason: str = ""
    recovered: Count = 0
    """Hooks that came off meanwhile and were brought back."""

    @property
    def steps(self) -> str:
        """Steps of the plan, in words."""
        return str(self.first) if self.first == self.last else f"{self.first} to {self.last}"


@dataclass(frozen=True, slots=True)
class LoggedReplan:
    """What is read back of a new plan that was made on the way."""

    after: Annotated[int, Field(ge=0)]
    """So many actions had been carried out before it."""


@dataclass(frozen=True, slots=True)
class LoggedClimb:
    """What is read back of the report in a climb's log."""

    actions: list[ActionReport] = field(default_factory=list)
    replans: list[LoggedReplan] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class NewPlan:
    """Where a new plan was made on the way."""

    after: Count
    """Actions reported before."""
    without: list[int]
    """Numbers of the holds that could not be had."""
    length: Count
    """Actions of the new plan."""


@dataclass(slots=True)
class ClimbReport(RunReport):
    """How a plan was carried out."""

    pose: Annotated[tuple[float, ...], Key(kind=Pose)] = field(default=(0.0, 0.0, 0.0), kw_only=True)
    """Body at the end, as believed: x, y [m], angle [rad]."""
    true_pose: Annotated[tuple[float, ...] | None, Key(kind=Pose)] = field(default=None, kw_only=True)
    """As it truly was; None where nobody tells."""
    actions: list[ActionReport] = field(default_factory=list)
    replans: Annotated[list[NewPlan], Key(after="forced")] = field(default_factory=list)
    """Where a new plan was made."""
    forced: Annotated[list[str], Key(after="short")] = field(default_factory=list)
    """Objections to the plan that were overridden."""
    broken: Annotated[list[HoldBreak], Key(after="replans")] = field(default_factory=list)
    """Holds that truly gave way, where that is told."""
    short: Annotated[float, Key(after="true_pose")] = 0.0
    """By how much the body, truly where that is told, misses the last goal's box [m]."""


def beyond(task: LimbedTask, pose: Floats) -> float:
    """By how much a pose misses the box of a task's last goal [m]."""
    x_min, x_max, y_min, y_max = task.goals[-1].box
    return math.hypot(max(x_min - pose[0], pose[0] - x_max, 0.0), max(y_min - pose[1], pose[1] - y_max, 0.0))
