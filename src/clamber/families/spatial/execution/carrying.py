"""A robot in space that carries out a plan: what the sequencer is told of its motions."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
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
    Standing,
)
from .limbed_body import LostHoldError
from .motions import (
    Landing,
    fold,
    folded,
    move_body,
    regrab,
    rest,
    retake,
    share_loads,
    take,
)
from .references import quaternion_of
from .replanning import (
    neighbours,
    task_from_here,
    widened,
    without,
    without_limb,
)
from .run_trace import TracedBody

Replan: TypeAlias = Callable[[SpatialTask], Plan | None]
"""Makes a plan for the rest of a task; None: there is none."""
MOST_LOST: Final = 4
"""Times that holds may be lost and taken again in one motion."""
NEAR: Final = 8
"""Holds nearest a tip that are tried where its own is gone."""
AT_FIRST: Final = 0.3
"""The robot stands still for that long before it moves [s]."""


@dataclass(frozen=True, slots=True, eq=False)
class Another:
    """Another plan."""

    task: SpatialTask
    """That it is for, from its start on."""
    course: Course
    told: NewPlan


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
        self._posture = course.start.joints
        """That the joints of limbs keep which are left out, as a joint of theirs is locked; shape (n,)."""
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
                if off.gone:
                    return "missed", lost, f"{name} slid from hold {off.hold + 1} again"
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
        """See `Performer`: without holds that can't be had, or without the limb of a joint that fails."""
        if self._replan is None or outcome not in ("missed", "fault"):
            return False
        try:
            return self._leave_out(action) if outcome == "fault" else self._without_holds(action)
        except LostHoldError:
            return False

    def _without_holds(self, action: Motion) -> bool:
        """After a hold that can't be had: have its limb on another, and go on from there; whether that can be done."""
        off = self._in_air()
        at = self._nearest(action)
        if len(off) != 1:  # no plan begins with fewer limbs on holds
            return False
        (limb,), hold = off, int(at.holds[off[0]])
        if isinstance(action, Regrab) and limb == action.limb:
            self._missed.add(action.hold)
            if self._take(limb, hold, at, at):
                return self._follow(self._another(at, self.task))
        self._missed.add(hold)
        return self._take_another(limb, at)

    def _in_air(self) -> list[int]:
        """Limbs of the task's robot that hold on to nothing."""
        names, left = self.body.robot.limb_names, self.task.robot.limb_names
        return [limb for limb, hold in enumerate(self.body.holds.tolist()) if hold < 0 and names[limb] in left]

    def _take(self, limb: int, hold: int, at: Standing, after: Standing) -> bool:
        """Whether a limb takes a hold, from a stance in which it was on another."""
        normals = self.body.world.normals[[int(at.holds[limb]), hold]]
        return take(self.body, limb, hold, normals, after.loads, after.joints).taken

    def _take_another(self, limb: int, at: Standing) -> bool:
        """Have a limb whose hold is gone take another, from which there is a plan; whether there is one.

        Args:
            limb: It is in the air.
            at: The stance that the others are in.
        """
        body = self.body
        loads = at.loads.copy()
        loads[limb] = 0.0
        move_body(body, BodyMotion(1, (replace(at, loads=loads),) * 2))
        away = np.linalg.norm(body.belief.places - body.tips[limb], axis=1)
        away[[*self._missed, *body.holds[body.holds >= 0].tolist()]] = math.inf
        for hold in np.argsort(away)[:NEAR].tolist():
            holds = at.holds.copy()
            holds[limb] = hold
            another = self._another(replace(at, holds=holds), self.task)
            if another is None:
                continue
            if self._take(limb, hold, at, another.course.start):
                return self._follow(another)
            self._missed.add(hold)
        return False

    def _another(self, at: Standing, of: SpatialTask) -> "Another | None":
        """Another plan from a stance on, for a task without what can't be had; None: there is none."""
        body = self.body
        task = task_from_here(of, at, self._missed, body.robot.limb_names)
        if task is None or self._replan is None:
            return None
        body.plant.pause()
        plan = self._replan(task)
        if plan is None:
            return None
        missed = [hold + 1 for hold in sorted(self._missed)]
        locked = [body.named.joints[joint] for joint in body.locked]
        told = NewPlan(len(self.report.motions), missed, len(plan.actions), locked)
        course = without(Course.of(task, plan, "new plan"), neighbours(of, self._missed))
        goals_left = replace(of, goals=task.goals)  # the stages of its stances are counted from here
        return Another(goals_left, widened(course, of.robot.chains, body.robot.chains, self._posture), told)

    def _follow(self, another: "Another | None") -> bool:
        """Go on by another plan, if there is one."""
        if another is None:
            return False
        self.task = another.task
        self.course = another.course
        self._at = 0
        self.report.replans.append(another.told)
        return True

    def _leave_out(self, action: Motion) -> bool:
        """After a fault: lock the joint that has failed, fold its limb, and go on with the others; whether that can be done."""
        body = self.body
        joint = body.watch.failed_joint()
        if joint is None or not body.robot.spec.brake:
            return False
        limb = int(np.searchsorted(np.cumsum(body.robot.chains.n_joints), joint, side="right"))
        body.lock(joint)
        rest(body, body.pace.shift)
        return self._go_on_without(limb, action)

    def _go_on_without(self, limb: int, action: Motion) -> bool:
        """Fold a limb and go on by another plan; whether there is one."""
        body = self.body
        at = self._nearest(action)
        for other in self._in_air():
            if other != limb and not self._take(other, int(at.holds[other]), at, at):
                return False
        first, behind = body.joints_of(limb)
        self._posture, lifted = folded(body, limb, body.world.normals[int(at.holds[limb])])
        names, places = body.robot.chains.joint_names[limb], self._posture[first:behind].tolist()
        rest_of = without_limb(self.task, body.robot.limb_names[limb], dict(zip(names, places, strict=True)))
        if lifted < body.lift or rest_of is None or not self._follow(self._another(at, rest_of)):
            return False
        start = self.course.start
        if body.holds[limb] >= 0:
            share_loads(body, start.loads, limb, fading=True)
            body.plant.grip(limb, False)
        body.let_go(limb)
        fold(body, limb, self._posture)
        move_body(body, BodyMotion(1, (start, start)))
        return True

    def _nearest(self, action: Motion) -> Standing:
        """The stance of an action that the body is nearest to."""
        if isinstance(action, Regrab):
            return action.after if self.body.holds[action.limb] == action.hold else action.before
        here = self.body.law.aims.position
        return min(action.way, key=lambda at: float(np.linalg.norm(at.pose.position - here)))

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
        report = self.report
        state = self.body.law.state
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
