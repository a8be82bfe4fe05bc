"""What is told of a walk: of every step, and as a whole."""

import math
from dataclasses import dataclass, field

from ...control.gait import PhaseTimes
from ...types import Json
from ..run_report import Moment, Outcome, RunReport


@dataclass(frozen=True, slots=True)
class StepReport:
    """What became of a step."""

    number: int
    """From 1."""
    frame: str
    way: float
    """Where on the way the frame was to come down [m]."""
    outcome: Outcome
    start: float
    """When it began [s]."""
    times: PhaseTimes
    balance: float
    """Least support margin that was reckoned with on the way [m]."""
    off: float
    """The frame from where it was to come down, as believed [m]."""
    tries: int
    """How often its feet were lowered."""
    tilt: float
    """The plate's angle from the horizontal at the end, as believed [rad]."""
    pose_error: float | None
    """Plate, believed from true, seen from above, at the end [m]; None where nobody tells."""
    reason: str = ""

    def to_json(self) -> Json:
        """Plain data; None for a distance that there is none of, such as that of a frame that never came down."""
        plain = {name: getattr(self, name) for name in self.__slots__}
        plain |= {name: None for name in ("balance", "off") if not math.isfinite(plain[name])}
        return plain | {"times": {name: getattr(self.times, name) for name in PhaseTimes.__slots__}}


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

    steps: list[StepReport] = field(default_factory=list)
    prepared: float = 0.0
    """When the first step began [s]."""
    goal: tuple[float, ...] = ()
    """Of the Delta-frame, seen from above, where the course ends [m], [rad]; empty if the walk ended before it was laid."""
    offsets: tuple[float, float] = (0.0, 0.0)
    """Of the inclinometers, as calibrated [rad]."""
    kicks: int = 0
    """How often the plate tilted without its legs telling."""

    @property
    def missed(self) -> tuple[float, float] | None:
        """How far the plate ends from the goal, truly where that is told: way [m], heading [rad]; None without a goal."""
        pose = self.true_pose or self.pose
        if not self.goal or not pose:
            return None
        off = math.hypot(pose[0] - self.goal[0], pose[1] - self.goal[1])
        return off, abs(math.remainder(pose[3] - self.goal[2], math.tau))

    def to_json(self) -> Json:
        """Plain data."""
        missed = self.missed
        return {
            "done": self.done,
            "reason": self.reason,
            "seconds": self.seconds,
            "prepared": self.prepared,
            "pose": list(self.pose),
            "true_pose": None if self.true_pose is None else list(self.true_pose),
            "goal": list(self.goal),
            "missed": None if missed is None else list(missed),
            "offsets": list(self.offsets),
            "kicks": self.kicks,
            **self.faults_to_json(),
            "steps": [step.to_json() for step in self.steps],
        }
