"""A robot in space that carries out a plan: what the sequencer is told of its motions."""

import math
from collections.abc import Callable
from typing import Final, TypeAlias

import numpy as np

from ....execution.run_report import (
    BRACED,
    SETTLED,
    Ending,
    FallenError,
    Outcome,
    ending_of,
)
from ....execution.sequencer import Attempt, Performer
from ....planning.problem.plan import Plan
from ....types import Floats
from ..planning.task import SpatialTask
from .carrying_report import (
    CarryingReport,
    MotionReport,
    NewPlan,
)
from .course import (
    BodyMotion,
    Course,
    Motion,
    Regrab,
)
from .limbed_body import LostHoldError
from .motions import (
    Landing,
    move_body,
    regrab,
    rest,
    retake,
    take,
)
from .references import quaternion_of
from .replanning import (
    neighbours,
    task_from_here,
    without,
)
from .run_trace import TracedBody

Replan: TypeAlias = Callable[[SpatialTask], Plan | None]
"""Makes a plan for the rest of a task; None: there is none."""
MOST_LOST: Final = 4
"""Times that holds may be lost and taken again in one motion."""
AT_FIRST: Final = 0.3
"""The robot stands still for that long before it moves [s]."""


class Carrying(Performer[Motion, CarryingReport, int, int]):
    """A robot and the course that it follows.

    Args:
        body: The robot.
        task: What its plan is for.
        course: What its plan asks for.
        replan: Makes another plan for the rest of a task; None: none is made.
    """

    goes_on = frozenset({"ok"})

    def __init__(self, body: TracedBody, task: SpatialTask, course: Course, replan: Replan | None = None) -> None:
        self.body, self.task, self.course, self._replan = body, task, course, replan
        self._missed: set[int] = set()
        self.report = CarryingReport()
        self._at = 0
        self._off = math.nan

    @property
    def time(self) -> float:
        """See `Performer`."""
        return self.body.time

    def begin(self) -> None:
        """See `Performer`: the robot is put on its holds and stands."""
        self.body.start(self.course.start)
        try:
            rest(self.body, AT_FIRST)
        except LostHoldError as lost:
            name = self.body.robot.limb_names[lost.limb]
            raise FallenError(f"{name} came off hold {lost.hold + 1} before anything was to move") from None

    def next(self) -> Motion | None:
        """See `Performer`."""
        motions = self.course.motions
        if self._at == len(motions):
            return None
        self.body.action = motions[self._at].first
        return motions[self._at]

    def told(self, action: Motion) -> tuple[int, int]:
        """See `Performer`: the action that begins, and how many there are."""
        return action.first, self.course.motions[-1].last

    def carry_out(self, action: Motion) -> tuple[Outcome, int, str]:
        """See `Performer`."""
        self._off = math.nan
        lost, caught = 0, ""
        while True:
            try:
                outcome, tries, reason = self._once(action)
                return outcome, tries + lost, reason or caught
            except LostHoldError as off:
                lost += 1
                name = self.body.robot.limb_names[off.limb]
                caught = f"{name} came off hold {off.hold + 1} and took it again"
                if lost > MOST_LOST:
                    return "missed", lost, f"{name} came off hold {off.hold + 1} again and again"
                if isinstance(action, Regrab) and off.limb == action.limb:
                    continue
                landing = self._catch(off, action)
                if not landing.taken:
                    return "missed", lost, f"{name} came off hold {off.hold + 1}: {landing.reason}"

    def _once(self, action: Motion) -> tuple[Outcome, int, str]:
        """An action from where the robot is."""
        if isinstance(action, BodyMotion):
            move_body(self.body, action)
            self._off = float(np.linalg.norm(self.body.law.aims.position - self.body.law.state.position))
            return "ok", 1, ""
        landing = regrab(self.body, action)
        self._off = landing.off
        return ("ok" if landing.taken else "missed"), landing.tries, landing.reason

    def _catch(self, off: LostHoldError, action: Motion) -> Landing:
        """Have a limb that came off hold on again, those that come off meanwhile, too."""
        loads = action.loads if isinstance(action, Regrab) and self.body.holds[action.limb] < 0 else action.start.loads
        waiting = [off]
        for _ in range(MOST_LOST):
            try:
                landing = retake(self.body, waiting[-1], loads)
            except LostHoldError as other:
                waiting.append(other)
                continue
            waiting.pop()
            if not waiting or not landing.taken:
                return landing
        return Landing(False, math.nan, MOST_LOST, "others came off meanwhile")

    def record(self, action: Motion, attempt: Attempt) -> None:
        """See `Performer`."""
        limb = action.limb if isinstance(action, Regrab) else None
        self.report.motions.append(
            MotionReport(
                first=action.first,
                last=action.last,
                limb=None if limb is None else self.body.robot.limb_names[limb],
                hold=action.hold + 1 if isinstance(action, Regrab) else None,
                outcome=attempt.outcome,
                start=attempt.start,
                seconds=self.time - attempt.start,
                off=self._off,
                tries=attempt.tries,
                reason=attempt.reason,
            )
        )

    def done(self, action: Motion) -> None:
        """See `Performer`."""
        self._at += 1

    def plan_again(self, action: Motion, outcome: Outcome) -> bool:
        """See `Performer`: back on the hold that the limb came from, and on without those that were missed."""
        if self._replan is None or outcome != "missed" or not isinstance(action, Regrab):
            return False
        body, back = self.body, action.before
        if (
            np.delete(body.holds, action.limb) < 0
        ).any():  # another limb came off: no plan begins with fewer limbs on holds
            return False
        self._missed.add(action.hold)
        normals = body.world.normals[[action.hold, int(back.holds[action.limb])]]
        try:
            landing = take(body, action.limb, int(back.holds[action.limb]), normals, back.loads, back.joints)
        except LostHoldError:
            return False
        task = task_from_here(self.task, back, self._missed) if landing.taken else None
        if task is None:
            return False
        body.plant.pause()
        plan = self._replan(task)
        if plan is None:
            return False
        self.report.replans.append(
            NewPlan(len(self.report.motions), [hold + 1 for hold in sorted(self._missed)], len(plan.actions))
        )
        self.course = without(Course.of(task, plan, "new plan"), neighbours(self.task, self._missed))
        self._at = 0
        return True

    def stop_safely(self) -> Ending:
        """See `Performer`: the robot holds its posture."""
        self.body.brace()
        places = [self._place()]
        for seconds in (BRACED - SETTLED, SETTLED):
            rest(self.body, seconds)
            places.append(self._place())
        moved, late = (float(np.linalg.norm(places[k] - places[2])) for k in (0, 1))
        return ending_of(moved, late, holds=moved < self.body.pace.lost)

    def name(self, action: Motion) -> str:
        """See `Performer`."""
        if isinstance(action, Regrab):
            return f"step {action.first}, {self.body.robot.limb_names[action.limb]} to hold {action.hold + 1}"
        return f"step {action.first}, a move of the body"

    def end(self) -> None:
        """See `Performer`."""
        report, state = self.report, self.body.law.state
        report.off, report.torque = self.body.peaks.tolist()
        report.failures, report.findings = self.body.law.failures, list(self.body.watch.monitor.findings)
        report.pose = pose_of(state.position, state.rotation)
        true = self.body.plant.truth()
        if true is not None and np.isfinite(true.pose.position).all():
            report.true_pose = pose_of(true.pose.position, true.pose.rotation)

    def _place(self) -> Floats:
        """Of the body, truly where that is told [m]."""
        true = self.body.plant.truth()
        return self.body.law.state.position.copy() if true is None else true.pose.position.copy()


def pose_of(position: Floats, rotation: Floats) -> tuple[float, ...]:
    """x, y, z [m], then the unit quaternion w, x, y, z."""
    return (*position.tolist(), *quaternion_of(rotation).tolist())
