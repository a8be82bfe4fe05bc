"""The sequencer: carries a plan out action by action, brings slipped hooks back, plans again, and tells what happened to each."""

from collections.abc import Callable
from typing import Final, TypeAlias

import numpy as np

from ...actions.plan import Plan
from ...tasks.limbed import LimbedTask
from ...types import Floats
from ..plant import PlantStoppedError
from .actor import ARRIVED, Actor
from .climb_report import ActionReport, ClimbReport, Outcome, beyond
from .climb_trace import TracedClimber
from .climber import FallenError, SlippedError
from .course import Course, PlanRefusedError, lay_course, names_of
from .here import task_from_here
from .recover import recover

Replan: TypeAlias = Callable[[LimbedTask], Plan | None]
"""A plan for a task that starts where the robot is; None where there is none."""
Progress: TypeAlias = Callable[[int, int, str, float], None]
"""Told before each action: its step, how many there are, the action in words, the time [s]."""

MOST_REPLANS: Final = 3
MOST_RECOVERIES: Final = 3
"""Of one action."""


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
        self.climber = climber
        self._actor = Actor(climber, course)
        self._replan, self._progress = replan, progress
        self._recovered = 0
        """In the present action."""
        self.report = ClimbReport(forced=names_of(course.objections))

    @property
    def course(self) -> Course:
        """The plan that is carried out now."""
        return self._actor.course

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
            climber.learn_start()
            while self._carry_out() is False:
                pass
        except KeyboardInterrupt:
            report.reason = "interrupted"
        except FallenError as fall:
            report.reason = f"fell: {fall}"
        except PlantStoppedError as stop:
            report.reason = f"stopped: {stop}"
        self._end()
        return report

    def _end(self) -> None:
        """Tell where the climb ended, and call it done only where that is the goal."""
        report, climber = self.report, self.climber
        report.seconds = climber.time
        report.pose = _tuple(climber.body.settled)
        pose = climber.body.settled
        if climber.truth is not None:
            pose = climber.truth().pose
            report.true_pose = _tuple(pose)
        report.short = beyond(self.course.task, pose)
        planned = beyond(self.course.task, self.course.pose(len(self.course.actions)))
        if report.done and report.short > planned + ARRIVED:
            report.done = False
            report.reason = (
                f"short: every action was carried out, but the body ends {1e3 * report.short:.0f} mm short of the goal"
            )

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
            limb = None if action.limb is None else self._actor.limb(action.limb)
            self.report.actions.append(
                self._reported(first, last, action.kind, title, outcome, start, tries, limb, reason)
            )
        return outcome, reason

    def _surely(self, first: int, last: int) -> tuple[Outcome, int, str]:
        """Carry out one group, once more after each hook that comes off in it and is brought back."""
        while True:
            try:
                return self._actor.carry_out(first, last)
            except SlippedError as slip:
                if self._recovered == MOST_RECOVERIES:
                    raise
                why = self._recover(first, slip)
                if why:
                    return "missed", 0, why
                self._recovered += 1

    def _recover(self, step: int, slip: SlippedError) -> str:
        """Back to the stance before a step, but for the limb that acts in it; why not, where that cannot be."""
        self._actor.hanging = None
        acts = self.course.actions[step - 1].limb
        held = {
            self._actor.limb(name): hold for name, hold in self.course.holds(step - 1).items() if hold and name != acts
        }
        elbows = {i: int(self.course.elbows[step - 1, i]) for i in held}
        why = recover(self.climber, slip, held, self._actor.pose(step - 1), elbows)
        return "" if not why or self._actor.catch_up(step) else why

    def _plan_again(self, step: int) -> bool:
        """Ask for a plan from where the robot is, without the holds that were missed; whether there is one."""
        if self._replan is None or len(self.report.replans) >= MOST_REPLANS:
            return False
        held = {limb.name: self.climber.body.tasks[i].hold for i, limb in enumerate(self.climber.robot.limbs)}
        task = task_from_here(self.course, step, held, self._actor.missed)
        self.climber.plant.pause()
        plan = self._replan(task)
        if plan is None:
            return False
        course = lay_course(task, plan, "new plan")
        if course.objections:
            return False
        self.report.replans.append(
            {"after": len(self.report.actions), "without": sorted(self._actor.missed), "length": len(plan.actions)}
        )
        self._actor.course = course
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
            first, last, kind, title, outcome, start, climber.time - start, tries, self._actor.off(), body_error, tip_error, reason,
            self._recovered,
        )  # fmt: skip


def _tuple(pose: Floats) -> tuple[float, float, float]:
    return float(pose[0]), float(pose[1]), float(pose[2])
