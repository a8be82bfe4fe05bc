"""A walker that follows a course: how it prepares, how its frames take turns along it, what the sequencer is told of its steps.

Footholds proved before they are relied upon: a frame that has come down is loaded and pushed about while the other still stands.

A leg has one freedom and feels along itself only, so it cannot tell an edge from the flat beside it. But a foot that stands on an edge
slips off it under load, or when it is pushed, and does so at once. So after each landing the new feet are made to carry nearly all, and
the frames push each other around a small circle, which shears every foot to every side. What slips then, slips while five others stand.
"""

import math
from collections.abc import Callable
from typing import Final, TypeAlias

import numpy as np

from ....control.loads import strain_of
from ....execution.run_report import BRACED, SETTLED, Ending, Outcome, RefusedError, StuckError, ending_of
from ....execution.sequencer import Attempt, Performer
from ....types import Floats
from ..control.gait import DELTA, PhaseTimes, Step, Y, lengths_at
from . import motions
from .calibrate import calibrate, feel_give
from .footstep_plan import FootstepPlan
from .walk_report import StepReport, WalkReport
from .walk_trace import PHASES, TracedWalker
from .walker import LEGS, Walker, leg_name

KEPT: Final = 40.0
"""What each foot of the other frame goes on carrying while the new ones are proved [N]."""
LOADING: Final = 1.5
"""In which the new feet take load [s] ..."""
ROUND: Final = 2.5
"""... and the frames push each other once around [s]."""
HANGS: Final = 0.5
"""A foot that feels less than this part of what counts as touching has lost its ground [-]."""
SLID: Final = 0.002
"""A foot that has come so far down has slipped off something [m]."""
AGAIN: Final = 4
"""Trials of a landing, at most."""


def prove(walker: Walker, frame: int) -> list[int]:
    """Load the feet of a frame that has just come down, and push them about, until nothing gives way or `AGAIN` times; all stand then.

    Args:
        walker: The robot, on six feet.
        frame: The new one.

    Returns:
        Legs whose feet slipped off something.

    Raises:
        FallenError: If the robot falls.
    """
    mine = walker.of_frame(frame)
    before = walker.soles[list(mine), 2].copy()
    for _ in range(AGAIN):
        if _try(walker, frame):
            break
        motions.lower(walker, range(LEGS))
    walker.strain[:] = 0.0
    motions.settle(walker, LOADING)
    return [i for i, height in zip(mine, before, strict=True) if walker.soles[i, 2] < height - SLID]


def _try(walker: Walker, frame: int) -> bool:
    """Prove once; whether all feet kept their ground."""
    place = walker.place.copy()
    walker.strain[:] = proof_strain(walker, frame)
    seconds = 2.0 * LOADING + ROUND
    for k in range(1, round(seconds / walker.period) + 1):
        time = k * walker.period
        swing = min(1.0, max(0.0, time - LOADING)) * min(1.0, max(0.0, seconds - LOADING - time) / 0.5)
        angle = math.tau * (time - LOADING) / ROUND
        push = swing * 2.0 * walker.settings.probe * np.array((math.cos(angle), math.sin(angle), 0.0))
        walker.actuators[:] = lengths_at(walker.robot, (place + push)[None])[0]
        walker.tick()
        hangs = (walker.stands > 0) & (walker.forces < HANGS * walker.settings.touch)
        if time > LOADING and hangs.any():
            walker.actuators[:] = lengths_at(walker.robot, place[None])[0]
            return False
    return True


def proof_strain(walker: Walker, frame: int) -> Floats:
    """By how much more than its even share each leg is to carry so that a frame carries all but a little, shape (6,) [N]."""
    sign = np.full(LEGS, -1.0)
    sign[walker.of_frame(frame)] = 1.0
    pattern = strain_of(walker.places, sign, walker.stands)
    even = walker.forces - strain_of(walker.places, walker.forces, walker.stands)
    less = pattern < -1e-6
    if not less.any():
        return np.zeros(LEGS)
    size = float(((even - KEPT)[less] / -pattern[less]).min())
    strain: Floats = max(0.0, size) * pattern
    return strain


Lay: TypeAlias = Callable[[Floats], FootstepPlan]
"""A course for a robot whose Delta-frame is at a pose x, y [m], heading [rad], shape (3,), once it stands level."""
Start: TypeAlias = Callable[[], None]
"""Puts a robot on the ground; it may fall there."""
Progress: TypeAlias = Callable[[int, float, float], None]
"""Told before each step: its number, the way done and the whole way [m]."""

TIPPED: Final = math.radians(30.0)
"""A plate that is tilted more has tipped over [rad]: no walk is on ground so steep."""
SHORTER: Final = (0.6, 0.3, 0.0)
"""Shares of a step at which a frame that found no ground tries again [-]."""


class Walking(Performer[Step, WalkReport, int, float, float]):
    """A walker and the way it is to go.

    Args:
        walker: The robot.
        lay: The course, laid once the robot stands as it is to walk: levelling moves it.
        start: What puts the robot on the ground; None: it is there, started.
        calibrated: Whether the inclinometers' offsets are known; if not, they are calibrated before the first step.
    """

    goes_on = frozenset({"ok", "moved"})

    def __init__(self, walker: TracedWalker, lay: Lay, *, start: Start | None = None, calibrated: bool = True) -> None:
        self.walker, self._lay, self._start, self._calibrated = walker, lay, start, calibrated
        self._stood = False
        self._course: FootstepPlan | None = None
        self._marks: list[float] = []
        """When the phases of the present step began, and the last one ended [s]."""
        self._off = math.nan
        self.report = WalkReport()

    @property
    def course(self) -> FootstepPlan:
        """That was laid when the robot stood ready."""
        assert self._course is not None, "begin first"
        return self._course

    @property
    def time(self) -> float:
        """See `Performer`."""
        return self.walker.time

    def begin(self) -> None:
        """See `Performer`: stand, find the ground with all feet, level, calibrate, lay the course."""
        walker = self.walker
        if self._start is not None:
            self._start()
        self._stood = True
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
        self._course = self._lay(walker.frames()[0])
        self.report.goal = tuple(map(float, self._course.goal))

    def next(self) -> Step | None:
        """See `Performer`."""
        course, walker = self.course, self.walker
        if course.done:
            return None
        step = course.next(walker)
        if step is None:
            at = f"{course.way:.3f} m of {course.length:.3f} m"
            raise StuckError(f"neither frame can go on from {at}: {course.obstacle(walker)}")
        walker.step = len(self.report.steps) + 1
        self._marks, self._off = [walker.time], math.nan
        return step

    def told(self, action: Step) -> tuple[int, float, float]:
        """See `Performer`."""
        return self.walker.step, self.course.way, self.course.length

    def carry_out(self, action: Step) -> tuple[Outcome, int, str]:
        """See `Performer`: lift a frame, slide it over, lower it, on shorter ways where it finds no ground, and prove its footholds."""
        walker, settings = self.walker, self.walker.settings
        start = walker.frames()[action.swing].copy()
        self._bring(action)
        walker.phase = PHASES.index("lower")
        outcome: Outcome = "ok"
        reason = ""
        without, tries = motions.lower(walker, walker.of_frame(action.swing)), 1
        for share in SHORTER:
            if not without:
                break
            outcome = "moved"
            reason = f"{leg_name(without[0])} found no ground at the end of the step"
            back = start + share * (action.end - start)
            motions.lift(walker, action.swing, back)
            motions.slide(walker, action.swing, back)
            without = motions.lower(walker, walker.of_frame(action.swing))
            tries += 1
        if without:
            outcome, reason = "no ground", f"{leg_name(without[0])} finds no ground"
        self._marks.append(walker.time)
        walker.phase = PHASES.index("settle")
        if settings.probe > 0.0 and not without:
            slipped = prove(walker, action.swing)
            tries += len(slipped)
            if slipped:
                reason = f"{leg_name(slipped[0])} slipped under trial"
        else:
            motions.settle(walker)
        self._marks.append(walker.time)
        landed = walker.frames()[action.swing]
        self._off = float(np.hypot(*(landed[:2] - action.end[:2])))
        return outcome, tries, reason

    def record(self, action: Step, attempt: Attempt) -> None:
        """See `Performer`."""
        walker, marks = self.walker, self._marks
        marks += [walker.time] * (5 - len(marks))
        times = PhaseTimes(*map(float, np.diff(marks)))
        true = walker.plant.truth()
        error = None if true is None else float(np.hypot(*(true.pose[:2] - walker.pose[:2])))
        self.report.steps.append(
            StepReport(
                walker.step, ("Delta", "Y")[action.swing], action.way, attempt.outcome, attempt.start, times,
                action.balance, self._off, attempt.tries, walker.tilt(), error, attempt.reason,
            )
        )  # fmt: skip

    def done(self, action: Step) -> None:
        """See `Performer`."""
        if not self.course.landed(action, self.walker):
            raise StuckError(f"the ground lets neither frame go on from {self.course.way:.3f} m")

    def stop_safely(self) -> Ending:
        """See `Performer`: every motor stays where it is."""
        walker = self.walker
        walker.plant.pause()
        places = [self._place()]
        for seconds in (BRACED - SETTLED, SETTLED):
            for _ in range(round(seconds / walker.period)):
                walker.brace_tick()
            places.append(self._place())
        moved, late = math.dist(places[0], places[2]), math.dist(places[1], places[2])
        return ending_of(moved, late, holds=self._stands())

    def _stands(self) -> bool:
        """Whether three feet are on the ground and the plate is not tipped over, truly where that is told."""
        true = self.walker.plant.truth()
        touching = self.walker.stands if true is None else true.touching
        tilt = np.abs((self.walker.pose if true is None else true.pose)[4:]).max()
        return int(np.count_nonzero(touching)) >= 3 and float(tilt) < TIPPED

    def _place(self) -> tuple[float, ...]:
        """Of the plate, truly where that is told [m]."""
        true = self.walker.plant.truth()
        return tuple(map(float, (self.walker.pose if true is None else true.pose)[:3]))

    def name(self, action: Step) -> str:
        """See `Performer`."""
        return f"step {self.walker.step}"

    def end(self) -> None:
        """See `Performer`."""
        report, walker = self.report, self.walker
        report.findings = list(walker.sensors.monitor.findings)
        if self._stood:
            report.kicks = walker.kicks
            report.pose = tuple(map(float, walker.pose))
            report.offsets = float(walker.inclination.offsets[0]), float(walker.inclination.offsets[1])
        true = walker.plant.truth()
        if true is not None and np.isfinite(true.pose).all():  # else the simulation has lost its numbers
            report.true_pose = tuple(map(float, true.pose))

    def _bring(self, step: Step) -> None:
        """Through the air to where it is to come down."""
        walker = self.walker
        walker.phase = PHASES.index("lift")
        motions.lift(walker, step.swing, step.end)
        self._marks.append(walker.time)
        walker.phase = PHASES.index("slide")
        for pose in (*step.over, step.end):
            motions.slide(walker, step.swing, pose)
        self._marks.append(walker.time)
