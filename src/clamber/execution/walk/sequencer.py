"""The sequencer of a walk: prepares the robot, then lets its frames take turns along a course, and tells what became of every step."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final, Literal, TypeAlias

import numpy as np

from ...control.gait import DELTA, PhaseTimes, Step, Y
from ...types import Floats, Json
from ..plant import PlantStoppedError
from . import motions
from .calibrate import calibrate, feel_give
from .course import Course
from .footholds import prove
from .walk_trace import PHASES, TracedWalker
from .walker import FallenError, RefusedError, leg_name

Outcome: TypeAlias = Literal["ok", "moved", "no ground", "refused", "fell", "stopped", "interrupted"]
Lay: TypeAlias = Callable[[Floats], Course]
"""A course for a robot whose Delta-frame is at a pose x, y [m], heading [rad], shape (3,), once it stands level."""
Progress: TypeAlias = Callable[[int, float, float], None]
"""Told before each step: its number, the way done and the whole way [m]."""

SHORTER: Final = (0.6, 0.3, 0.0)
"""Shares of a step at which a frame that found no ground tries again [-]."""


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


@dataclass(slots=True)
class WalkReport:
    """How a walk went."""

    steps: list[StepReport] = field(default_factory=list)
    done: bool = False
    """Whether both frames came to the end of the course."""
    seconds: float = 0.0
    """Simulated, or on the robot's clock."""
    prepared: float = 0.0
    """When the first step began [s]."""
    reason: str = ""
    """Why it ended, where it is not done."""
    pose: tuple[float, ...] = ()
    """Of the plate at the end, as believed [m], [rad]."""
    true_pose: tuple[float, ...] | None = None
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
            "steps": [step.to_json() for step in self.steps],
        }


class WalkSequencer:
    """Carries a walk out.

    Args:
        walker: The robot, started.
        lay: The course, laid once the robot stands as it is to walk: levelling moves it.
        calibrated: Whether the inclinometers' offsets are known; if not, they are calibrated before the first step.
        progress: Told before each step.
    """

    def __init__(
        self, walker: TracedWalker, lay: Lay, *, calibrated: bool = True, progress: Progress | None = None
    ) -> None:
        self.walker, self._lay, self._calibrated = walker, lay, calibrated
        self._progress = progress
        self.report = WalkReport()

    def run(self) -> WalkReport:
        """Walk to the track's end, a fall, a refusal, a stopped plant, or Ctrl-C; what happened until then is in report and trace."""
        report, walker = self.report, self.walker
        try:
            course = self._prepare()
            report.goal = tuple(map(float, course.goal))
            self._walk(course)
        except KeyboardInterrupt:
            report.reason = "interrupted"
        except FallenError as fall:
            report.reason = f"fell: {fall}"
        except RefusedError as no:
            report.reason = f"refused: {no}"
        except PlantStoppedError as stop:
            report.reason = f"stopped: {stop}"
        report.seconds, report.kicks = walker.time, walker.kicks
        report.pose = tuple(map(float, walker.pose))
        report.offsets = float(walker.inclination.offsets[0]), float(walker.inclination.offsets[1])
        true = walker.plant.truth()
        report.true_pose = None if true is None else tuple(map(float, true.pose))
        return report

    def _prepare(self) -> Course:
        """Find the ground with all feet, level, calibrate, lay the course."""
        walker = self.walker
        none = motions.find_ground(walker)
        if none:
            raise RefusedError(f"{leg_name(none[0])} finds no ground")
        if walker.settings.level:
            motions.level(walker)
        if walker.settings.probe > 0.0:
            for frame in (DELTA, Y):  # nobody has chosen where it stands either
                prove(walker, frame)
        feel_give(walker)
        if not self._calibrated:
            calibrate(walker)
            if walker.settings.level:
                motions.level(walker)
        motions.settle(walker)
        self.report.prepared = walker.time
        return self._lay(walker.frames()[0])

    def _walk(self, course: Course) -> None:
        report = self.report
        while not course.done:
            step = course.next(self.walker)
            if step is None:
                at = f"{course.way:.3f} m of {course.length:.3f} m"
                report.reason = f"stuck: neither frame can go on from {at}: {course.obstacle(self.walker)}"
                return
            if self._progress is not None:
                self._progress(len(report.steps) + 1, course.way, course.length)
            outcome = self._step(step)
            if outcome not in ("ok", "moved"):
                report.reason = f"step {len(report.steps)}: {outcome}: {report.steps[-1].reason}"
                return
            if not course.landed(step, self.walker):
                report.reason = f"stuck: the ground lets neither frame go on from {course.way:.3f} m"
                return
        report.done = True

    def _step(self, step: Step) -> Outcome:
        """Carry out one step and report it, whatever becomes of it."""
        walker, report = self.walker, self.report
        walker.step = len(report.steps) + 1
        start, marks = walker.time, [walker.time]
        outcome: Outcome = "interrupted"
        tries, reason, off = 0, "", math.nan
        try:
            outcome, tries, reason = self._carry_out(step, marks)
            landed = walker.frames()[step.swing]
            off = float(np.hypot(*(landed[:2] - step.end[:2])))
        except FallenError as fall:
            outcome, reason = "fell", str(fall)
            raise
        except RefusedError as no:
            outcome, reason = "refused", str(no)
        except PlantStoppedError as stop:
            outcome, reason = "stopped", str(stop)
            raise
        finally:
            marks += [walker.time] * (5 - len(marks))
            times = PhaseTimes(*map(float, np.diff(marks)))
            true = walker.plant.truth()
            error = None if true is None else float(np.hypot(*(true.pose[:2] - walker.pose[:2])))
            report.steps.append(
                StepReport(
                    walker.step, ("Delta", "Y")[step.swing], step.way, outcome, start, times,
                    step.balance, off, tries, walker.tilt(), error, reason,
                )
            )  # fmt: skip
        return outcome

    def _carry_out(self, step: Step, marks: list[float]) -> tuple[Outcome, int, str]:
        walker, settings = self.walker, self.walker.settings
        start = walker.frames()[step.swing].copy()
        self._bring(step, marks)
        walker.phase = PHASES.index("lower")
        outcome: Outcome = "ok"
        reason = ""
        without, tries = motions.lower(walker, walker.of_frame(step.swing)), 1
        for share in SHORTER:
            if not without:
                break
            outcome = "moved"
            reason = f"{leg_name(without[0])} found no ground at the end of the step"
            back = start + share * (step.end - start)
            motions.lift(walker, step.swing, back)
            motions.slide(walker, step.swing, back)
            without = motions.lower(walker, walker.of_frame(step.swing))
            tries += 1
        if without:
            outcome, reason = "no ground", f"{leg_name(without[0])} finds no ground"
        marks.append(walker.time)
        walker.phase = PHASES.index("settle")
        if settings.probe > 0.0 and not without:
            slipped = prove(walker, step.swing)
            tries += len(slipped)
            if slipped:
                reason = f"{leg_name(slipped[0])} slipped under trial"
        else:
            motions.settle(walker)
        marks.append(walker.time)
        return outcome, tries, reason

    def _bring(self, step: Step, marks: list[float]) -> None:
        walker = self.walker
        walker.phase = PHASES.index("lift")
        motions.lift(walker, step.swing, step.end)
        marks.append(walker.time)
        walker.phase = PHASES.index("slide")
        for pose in (*step.over, step.end):
            motions.slide(walker, step.swing, pose)
        marks.append(walker.time)
