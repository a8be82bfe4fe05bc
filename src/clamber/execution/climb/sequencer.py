"""The sequencer: carries a plan out action by action, tries again where a grab misses, and tells what happened to each."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final, Literal, TypeAlias

import numpy as np

from ...actions.plan import Plan
from ...tasks.limbed import LimbedTask
from ...types import Floats, Json
from ..plant import PlantStoppedError
from .climb_trace import TracedClimber
from .climber import FallenError, Grabbed, SlippedError
from .course import Course, PlanRefusedError, lay_course, names_of, swings
from .ends import grab, release
from .hang import Hang
from .here import task_from_here
from .let_go import let_go
from .motions import clear_the_way, may_stay, move_body
from .recover import recover

Outcome: TypeAlias = Literal["ok", "stalled", "missed", "fell", "interrupted", "stopped", "not supported"]
Replan: TypeAlias = Callable[[LimbedTask], Plan | None]
"""A plan for a task that starts where the robot is; None where there is none."""
Progress: TypeAlias = Callable[[int, int, str, float], None]
"""Told before each action: its step, how many there are, the action in words, the time [s]."""

ELSEWHERE: Final = ((0.0, 0.0), (0.0, 0.02), (0.0, -0.02), (0.025, 0.0), (-0.025, 0.0))
"""Where the body goes for another approach after a miss, from the plan's pose [m]."""
FARTHER: Final = ((0.0, 0.045), (0.0, -0.045), (0.05, 0.0), (-0.05, 0.0))
"""Likewise where a limb has found no way from any of these [m]."""
WORST: Final = -8.0
"""How badly off the worst of hooks and motors may be where the body goes for that [N]."""
MOST_REPLANS: Final = 3
MOST_RECOVERIES: Final = 3
"""Of one action."""
ARRIVED: Final = 0.02
"""A body nearer to its aim than this has come to it [m]."""
TURNED: Final = math.radians(6.0)
"""Likewise [rad]."""
SHIFTED: Final = 0.005
"""A body's aim farther from the plan's pose than this is brought back before a grab [m], [rad]."""
SETTLING: Final = 1.0
"""Most time that it gets to come there after its way [s]."""
PAUSE: Final = 0.1
"""Between two looks at that [s]."""


@dataclass(frozen=True, slots=True)
class ActionReport:
    """What happened to an action, or to like moves of the body that were carried out in one go."""

    first: int
    """Step of the plan, from 1."""
    last: int
    kind: str
    title: str
    outcome: Outcome
    start: float
    """When it began [s]."""
    seconds: float
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

    def to_json(self) -> Json:
        """Plain data."""
        return {name: getattr(self, name) for name in self.__slots__}


@dataclass(slots=True)
class ClimbReport:
    """How a plan was carried out."""

    actions: list[ActionReport] = field(default_factory=list)
    replans: list[Json] = field(default_factory=list)
    """Where a new plan was made: after which of `actions`, its length, why."""
    forced: list[str] = field(default_factory=list)
    """Objections to the plan that were overridden."""
    done: bool = False
    """Whether every action of the plan, or of those that took its place, was carried out, and the body came to the goal with it."""
    seconds: float = 0.0
    """Simulated, or on the robot's clock."""
    reason: str = ""
    """Why it ended, where it is not done."""
    pose: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Body at the end, as believed [m], [rad]."""
    true_pose: tuple[float, float, float] | None = None
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
            "actions": [action.to_json() for action in self.actions],
        }


class Sequencer:
    """Carries a course out.

    Args:
        climber: The robot, not yet started.
        course: The plan.
        replan: What makes another plan where a hold cannot be had; None: nothing does.
        force: Whether to go on in spite of the course's objections.
        progress: Told before each action.

    Raises:
        PlanRefusedError: If something speaks against the plan and it is not forced.
    """

    def __init__(
        self,
        climber: TracedClimber,
        course: Course,
        *,
        replan: Replan | None = None,
        force: bool = False,
        progress: Progress | None = None,
    ) -> None:
        if course.objections and not force:
            raise course.objections[0]
        self.climber, self.course = climber, course
        self._replan, self._progress = replan, progress
        self._missed: set[int] = set()
        self._hanging: Hang | None = None
        self._recovered = 0
        """In the present action."""
        self.report = ClimbReport(forced=names_of(course.objections))

    def start(self) -> None:
        """Put the robot into the plan's first stance.

        Raises:
            PlanRefusedError: If a limb cannot be put onto its hold with the elbow on the side that the plan needs.
        """
        course, limbs = self.course, self.climber.robot.limbs
        elbows = {limb.name: int(course.elbows[0, i]) for i, limb in enumerate(limbs)}
        try:
            self.climber.start(course.pose(0), course.holds(0), idle=course.idle(0), elbows=elbows)
        except IndexError:
            raise PlanRefusedError("plan", 0, "a limb has no posture for its hold at the start") from None

    def run(self) -> ClimbReport:
        """Carry the plan out to its end, a fall, a stopped plant, or Ctrl-C; what happened until then is in report and trace."""
        report, climber = self.report, self.climber
        try:
            self.start()
            climber.wait(0.5)
            while self._carry_out() is False:
                pass
        except KeyboardInterrupt:
            report.reason = "interrupted"
        except FallenError as fall:
            report.reason = f"fell: {fall}"
        except PlantStoppedError as stop:
            report.reason = f"stopped: {stop}"
        report.seconds = climber.time
        report.pose = _tuple(climber.body.settled)
        pose = climber.body.settled
        if climber.truth is not None:
            pose = climber.truth().pose
            report.true_pose = _tuple(pose)
        report.short = _beyond(self.course.task, pose)
        planned = _beyond(self.course.task, self.course.pose(len(self.course.actions)))
        if report.done and report.short > planned + ARRIVED:
            report.done = False
            report.reason = (
                f"short: every action was carried out, but the body ends {1e3 * report.short:.0f} mm short of the goal"
            )
        return report

    def _carry_out(self) -> bool:
        """The present course; False where another has taken its place."""
        for first, last in self.course.groups():
            action = self.course.actions[first - 1]
            self.climber.step = first
            if self._progress is not None:
                self._progress(first, len(self.course.actions), action.title, self.climber.time)
            outcome, reason = self._act(first, last)
            if outcome in ("ok", "stalled"):
                continue
            if outcome == "missed" and self._plan_again(first):
                return False
            self.report.reason = f"step {first}, {action.title}: {outcome}: {reason}"
            return True
        self.report.done = True
        return True

    def _act(self, first: int, last: int) -> tuple[Outcome, str]:
        """Carry out one group and report it, whatever becomes of it."""
        start, action = self.climber.time, self.course.actions[first - 1]
        outcome: Outcome = "interrupted"
        tries, reason = 0, ""
        self._recovered = 0
        try:
            outcome, tries, reason = self._surely(first, last)
        except FallenError as fall:
            outcome, reason = "fell", str(fall)
            raise
        except PlantStoppedError as stop:
            outcome, reason = "stopped", str(stop)
            raise
        finally:
            title = action.title if last == first else f"{action.title}, {last - first + 1} times"
            limb = None if action.limb is None else self._limb(action.limb)
            self.report.actions.append(
                self._reported(first, last, action.kind, title, outcome, start, tries, limb, reason)
            )
        return outcome, reason

    def _surely(self, first: int, last: int) -> tuple[Outcome, int, str]:
        """Carry out one group, once more after each hook that comes off in it and is brought back."""
        while True:
            try:
                return self._motion(first, last)
            except SlippedError as slip:
                if self._recovered == MOST_RECOVERIES:
                    raise
                why = self._recover(first, slip)
                if why:
                    return "missed", 0, why
                self._recovered += 1

    def _recover(self, step: int, slip: SlippedError) -> str:
        """Back to the stance before a step, but for the limb that acts in it; why not, where that cannot be."""
        self._hanging = None
        acts = self.course.actions[step - 1].limb
        held = {self._limb(name): hold for name, hold in self.course.holds(step - 1).items() if hold and name != acts}
        elbows = {i: int(self.course.elbows[step - 1, i]) for i in held}
        return recover(self.climber, slip, held, self._pose(step - 1), elbows)

    def _motion(self, first: int, last: int) -> tuple[Outcome, int, str]:
        action = self.course.actions[first - 1]
        if action.limb is not None and self._hanging is not None and self._hanging.i == self._limb(action.limb):
            return "not supported", 0, "it is the last limb that holds"
        if swings(self.course, last):
            refused = self._hang(last)
            if refused:
                return "not supported", 0, refused
            if action.kind != "grab":
                return "ok", 1, ""
        if action.kind == "move":
            return self._move(last)
        if action.kind == "release":
            assert action.limb is not None
            i = self._limb(action.limb)
            if self.climber.body.tasks[i].hold:  # a slip may have done it
                release(self.climber, i)
            if self.climber.body.tasks[i].hold:
                return "missed", 1, "its hook stays wedged on its hold"
            return "ok", 1, ""
        if action.kind == "grab":
            return self._grab(first)
        return "ok", 0, ""

    def _hang(self, step: int) -> str:
        """The body comes to hang, or moves as it hangs, as the plan has it after a step; why not, where that cannot be."""
        climber, tasks = self.climber, self.climber.body.tasks
        if not climber.hangs:
            acts = self.course.actions[step - 1].limb
            leaving = None if acts is None else self._limb(acts)
            stay = [i for i, task in enumerate(tasks) if task.hold and i != leaving]
            if leaving is None or len(stay) != 1:
                return "more than one limb would have to let go"
            self._hanging = let_go(climber, leaving, stay[0])
            if self._hanging is None:
                return "the weight cannot be brought below the hold that is to carry it alone"
        hanging = self._hanging
        assert hanging is not None
        clear_the_way(climber, self._pose(step))
        hanging.bring(self._pose(step))
        hanging.calm()
        return ""

    def _move(self, step: int) -> tuple[Outcome, int, str]:
        """The body goes to the plan's pose; once more where it does not come there."""
        for tries in (1, 2):
            move_body(self.climber, self._pose(step))
            if self._settle():
                return "ok", tries, ""
        return "stalled", 2, f"the body stays {1e3 * self._off():.0f} mm off its aim"

    def _grab(self, step: int) -> tuple[Outcome, int, str]:
        action = self.course.actions[step - 1]
        if action.limb is None or action.hold is None:
            return "missed", 0, "the plan names no hold"
        i, tries = self._limb(action.limb), 0
        elbow = int(self.course.elbows[step, i])
        side = math.copysign(1.0, self.climber.holds[action.hold][0] - self._pose(step)[0])
        result = Grabbed(False, 0, 0.0, 0.0)
        sides = [elbow, -elbow] if self.course.serves(i, step, -elbow) else [elbow]
        for elbow in sides:
            for x, y in (*ELSEWHERE, *FARTHER):
                if result.tries and (x, y) in FARTHER:
                    break
                place = self._pose(step) + np.array((side * x, y, 0.0))
                off = float(np.abs(place - self.climber.body.aim).max())
                home = None
                if not self.climber.hangs and off > SHIFTED:  # also by the approach to the hold before
                    if (x or y) and self.climber.body.stands(place) < WORST:
                        continue
                    if not (x or y) and may_stay(self.climber, i, place):
                        home = place
                    else:
                        move_body(self.climber, place)
                result = grab(self.climber, i, action.hold, elbow=elbow, home=home)
                tries += max(1, result.tries)
                if result.held:
                    self._keep_in_map(i, action.hold)
                    self.course.elbows[self.course.stays(i, step), i] = elbow
                    if self._hanging is not None:
                        self._hanging.end()
                        self._hanging = None
                    return "ok", tries, ""
            if result.tries:
                break  # there is a way; the hook does not take
        self._missed.add(action.hold)
        if not result.tries:
            return "missed", tries, "the limb finds no way there"
        return (
            "missed",
            tries,
            f"the hook stopped {1e3 * result.along:+.0f}, {1e3 * result.across:+.0f} mm from the hold",
        )

    def _keep_in_map(self, i: int, number: int) -> None:
        """What a hook felt corrects the map, but never by more than the map can be wrong: a bias would add up from grab to grab."""
        hold, climber = self.course.task.world.by_number(number), self.climber
        place, most = np.array((hold.x, hold.y)), climber.map_error
        climber.holds[number] = place + np.clip(climber.holds[number] - place, -most, most)
        climber.body.tasks[i].place = climber.holds[number].copy()

    def _settle(self) -> bool:
        for _ in range(round(SETTLING / PAUSE)):
            if self._arrived():
                return True
            self.climber.wait(PAUSE)
        return self._arrived()

    def _arrived(self) -> bool:
        body = self.climber.body
        return self._off() < ARRIVED and abs(float(body.aim[2] - body.settled[2])) < TURNED

    def _off(self) -> float:
        body = self.climber.body
        return float(np.hypot(*(body.aim[:2] - body.settled[:2])))

    def _pose(self, step: int) -> Floats:
        """The plan's pose, its angle counted on from where the body is."""
        pose, angle = self.course.pose(step), self.climber.body.aim[2]
        pose[2] = angle + math.remainder(pose[2] - angle, math.tau)
        return pose

    def _limb(self, name: str) -> int:
        return [limb.name for limb in self.climber.robot.limbs].index(name)

    def _plan_again(self, step: int) -> bool:
        """Ask for a plan from where the robot is, without the holds that were missed; whether there is one."""
        if self._replan is None or len(self.report.replans) >= MOST_REPLANS:
            return False
        held = {limb.name: self.climber.body.tasks[i].hold for i, limb in enumerate(self.climber.robot.limbs)}
        task = task_from_here(self.course, step, held, self._missed)
        self.climber.plant.pause()
        plan = self._replan(task)
        if plan is None:
            return False
        course = lay_course(task, plan, "new plan")
        if course.objections:
            return False
        self.report.replans.append(
            {"after": len(self.report.actions), "without": sorted(self._missed), "length": len(plan.actions)}
        )
        self.course = course
        return True

    def _reported(
        self, first: int, last: int, kind: str, title: str, outcome: Outcome, start: float, tries: int,
        limb: int | None, reason: str,
    ) -> ActionReport:  # fmt: skip
        climber, body_error, tip_error = self.climber, None, None
        if climber.truth is not None:
            true = climber.truth()
            body_error = float(np.hypot(*(true.pose[:2] - climber.body.settled[:2])))
            tip_error = None if limb is None else float(np.hypot(*(true.tips[limb] - climber.body.tip(limb))))
        return ActionReport(
            first, last, kind, title, outcome, start, climber.time - start, tries, self._off(), body_error, tip_error, reason,
            self._recovered,
        )  # fmt: skip


def _beyond(task: LimbedTask, pose: Floats) -> float:
    x_min, x_max, y_min, y_max = task.goals[-1].box
    return math.hypot(max(x_min - pose[0], pose[0] - x_max, 0.0), max(y_min - pose[1], pose[1] - y_max, 0.0))


def _tuple(pose: Floats) -> tuple[float, float, float]:
    return float(pose[0]), float(pose[1]), float(pose[2])
