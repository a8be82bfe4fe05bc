"""What is told of a plan that was carried out: of every action, and as a whole."""

import math
from dataclasses import dataclass, field
from typing import Annotated

from pydantic import Field

from ...tasks.limbed import LimbedTask
from ...types import Floats, Json
from ..plant import HoldBreak
from ..run_report import Moment, Outcome, RunReport


@dataclass(frozen=True, slots=True)
class ActionReport:
    """What happened to an action, or to like moves of the body that were carried out in one go."""

    first: int
    """Step of the plan, from 1."""
    last: int
    kind: str
    title: str
    outcome: Outcome
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
    recovered: int = 0
    """Hooks that came off meanwhile and were brought back."""

    @property
    def steps(self) -> str:
        """Steps of the plan, in words."""
        return str(self.first) if self.first == self.last else f"{self.first} to {self.last}"

    def to_json(self) -> Json:
        """Plain data."""
        return {name: getattr(self, name) for name in self.__slots__}


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


@dataclass(slots=True)
class ClimbReport(RunReport):
    """How a plan was carried out."""

    pose: tuple[float, ...] = field(default=(0.0, 0.0, 0.0), kw_only=True)
    """Body at the end, as believed [m], [rad]."""
    actions: list[ActionReport] = field(default_factory=list)
    replans: list[Json] = field(default_factory=list)
    """Where a new plan was made: after which of `actions`, its length, why."""
    forced: list[str] = field(default_factory=list)
    """Objections to the plan that were overridden."""
    broken: list[HoldBreak] = field(default_factory=list)
    """Holds that truly gave way, where that is told."""
    short: float = 0.0
    """By how much the body, truly where that is told, misses the last goal's box [m]."""

    def to_json(self) -> Json:
        """Plain data."""
        return {
            "done": self.done,
            "reason": self.reason,
            "seconds": self.seconds,
            "pose": list(self.pose),
            "true_pose": None if self.true_pose is None else list(self.true_pose),
            "short": self.short,
            "forced": self.forced,
            "replans": self.replans,
            "broken": [one.to_json() for one in self.broken],
            **self.faults_to_json(),
            "actions": [action.to_json() for action in self.actions],
        }


def beyond(task: LimbedTask, pose: Floats) -> float:
    """By how much a pose misses the box of a task's last goal [m]."""
    x_min, x_max, y_min, y_max = task.goals[-1].box
    return math.hypot(max(x_min - pose[0], pose[0] - x_max, 0.0), max(y_min - pose[1], pose[1] - y_max, 0.0))
