"""What is told of a walk: of every step, and as a whole."""

import math
from dataclasses import dataclass, field
from typing import Annotated, Literal, TypeAlias

from ....execution.run_report import Moment, Outcome, RunReport
from ....json_form import Count, Jsonable, Key, OrNull, in_json
from ..control.gait import PhaseTimes

WalkOutcome: TypeAlias = Literal["ok", "moved", "no ground", "refused", "fell", "fault", "stopped", "interrupted"]
"""Those a step of a walk may have."""


@dataclass(frozen=True, slots=True)
class StepReport(Jsonable):
    """What became of a step."""

    number: int
    """From 1."""
    frame: Annotated[str, Key(kind=Literal["Delta", "Y"])]
    way: float
    """Where on the way the frame was to come down [m]."""
    outcome: Annotated[Outcome, Key(kind=WalkOutcome)]
    start: float
    """When it began [s]."""
    times: PhaseTimes
    balance: OrNull
    """Least support margin that was reckoned with on the way [m]; infinite with fewer than three feet on the ground."""
    off: OrNull
    """The frame from where it was to come down, as believed [m]; not finite where it never came down."""
    tries: Count
    """How often its feet were lowered."""
    tilt: float
    """The plate's angle from the horizontal at the end, as believed [rad]."""
    pose_error: float | None
    """Plate, believed from true, seen from above, at the end [m]; None where nobody tells."""
    reason: str = ""


@dataclass(frozen=True, slots=True)
class LoggedStep:
    """What is read back of a step; see `StepReport`."""

    frame: str
    way: float
    outcome: Outcome
    start: Moment
    off: float | None = None
    reason: str = ""


@dataclass(frozen=True, slots=True)
class LoggedWalk:
    """What is read back of the report in a walk's log."""

    steps: list[LoggedStep] = field(default_factory=list)


@dataclass(slots=True)
class WalkReport(RunReport):
    """How a walk went; its pose is that of the plate."""

    pose: tuple[float, ...] = field(default=(), kw_only=True)
    """Plate at the end, as believed: x, y, z [m], alpha, beta, gamma [rad]; empty if it never stood."""
    steps: list[StepReport] = field(default_factory=list)
    prepared: Annotated[float, Key(after="seconds")] = 0.0
    """When the first step began [s]."""
    goal: Annotated[tuple[float, ...], Key(after="true_pose")] = ()
    """Of the Delta-frame, seen from above, where the course ends: x, y [m], heading [rad]; empty if the walk ended before it was laid."""
    offsets: Annotated[tuple[float, float], Key(after="missed")] = (0.0, 0.0)
    """Of the inclinometers, as calibrated [rad]."""
    kicks: Annotated[Count, Key(after="offsets")] = 0
    """How often the plate tilted without its legs telling."""

    @property
    @in_json(after="goal")
    def missed(self) -> tuple[float, float] | None:
        """How far the plate ends from the goal, truly where that is told: way [m], heading [rad]; None without a goal."""
        pose = self.true_pose or self.pose
        if not self.goal or not pose:
            return None
        off = math.hypot(pose[0] - self.goal[0], pose[1] - self.goal[1])
        return off, abs(math.remainder(pose[3] - self.goal[2], math.tau))
