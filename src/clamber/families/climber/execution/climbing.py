"""A climber that carries out a plan: what the sequencer is told of its actions, the hooks that it brings back, and its new plans."""

import math
from collections.abc import Callable
from typing import Final, TypeAlias

import numpy as np

from ....execution.run_report import BRACED, SETTLED, Ending, Outcome, ending_of
from ....execution.sequencer import Attempt, Performer
from ....planning.problem.plan import Plan
from ....types import Floats
from ..planning.task import LimbedTask
from .actor import ARRIVED, Actor
from .climb_report import ActionReport, ClimbReport, NewPlan, beyond
from .climb_trace import TracedClimber
from .climber import FallenError, SlippedError
from .executable_plan import ExecutablePlan, PlanRefusedError, lay_course, names_of
from .recover import recover
from .remaining_task import task_from_here

Replan: TypeAlias = Callable[[LimbedTask], Plan | None]
"""A plan for a task that starts where the robot is; None where there is none."""
Progress: TypeAlias = Callable[[int, int, str, float], None]
"""Told before each action: its step, how many there are, the action in words, the time [s]."""
Group: TypeAlias = tuple[int, int]
"""First and last step, from 1, of what is carried out in one go."""

AT_HOLD: Final = 0.03
"""A tip nearer to where a hold is believed to be may be on it [m]: the map's error, the play and the slot of a hook."""


class Climbing(Performer[Group, ClimbReport, int, int, str, float]):
    """A climber and the course that it is to climb.

    Args:
        climber: The robot, not yet started.
        course: The plan.
        replan: What makes another plan where a hold cannot be had; None: nothing does.
        force: Whether to go on in spite of the course's objections.

    Raises:
        PlanRefusedError: If something speaks against the plan and it is not forced.
    """

    goes_on = frozenset({"ok", "stalled"})

    def __init__(
        self, climber: TracedClimber, course: ExecutablePlan, *, replan: Replan | None = None, force: bool = False
    ) -> None:
        if course.objections and not force:
            raise course.refusal()
        self.climber, self.replan = climber, replan
        self._actor = Actor(climber, course)
        self._groups = iter(course.groups())
        self.report = ClimbReport(forced=names_of(course.objections))

    @property
    def course(self) -> ExecutablePlan:
        """The plan that is carried out now."""
        return self._actor.course

    @property
    def time(self) -> float:
        """See `Performer`."""
        return self.climber.time

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

    def begin(self) -> None:
        """See `Performer`: the first stance, what its hooks say of their holds.

        Raises:
            PlanRefusedError: As `start`.
        """
        self.start()
        self.climber.wait(0.5)
        self.climber.learn_start()

    def next(self) -> Group | None:
        """See `Performer`."""
        group = next(self._groups, None)
        if group is not None:
            self.climber.step = group[0]
        return group

    def told(self, action: Group) -> tuple[int, int, str, float]:
        """See `Performer`."""
        course = self.course
        return action[0], len(course.actions), course.actions[action[0] - 1].title, self.time

    def carry_out(self, action: Group) -> tuple[Outcome, int, str]:
        """See `Performer`."""
        return self._actor.carry_out(*action)

    def recover(self, action: Group, fall: FallenError) -> str:
        """See `Performer`: a hook that came off, back to the stance before the action, but for the limb that acts in it."""
        if not isinstance(fall, SlippedError):
            raise fall
        step = action[0]
        self._actor.hanging = None
        acts = self.course.actions[step - 1].limb
        index = self.climber.robot.limb_index
        held = {index(name): hold for name, hold in self.course.holds(step - 1).items() if hold and name != acts}
        elbows = {i: int(self.course.elbows[step - 1, i]) for i in held}
        why = recover(self.climber, fall, held, self._actor.pose(step - 1), elbows)
        return "" if not why or self._actor.catch_up(step) else why

    def record(self, action: Group, attempt: Attempt) -> None:
        """See `Performer`."""
        climber, (first, last) = self.climber, action
        planned = self.course.actions[first - 1]
        limb = None if planned.limb is None else climber.robot.limb_index(planned.limb)
        body_error = tip_error = None
        if climber.truth is not None:
            true = climber.truth()
            body_error = float(np.hypot(*(true.pose[:2] - climber.body.settled[:2])))
            tip_error = None if limb is None else float(np.hypot(*(true.tips[limb] - climber.body.tip(limb))))
        self.report.actions.append(
            ActionReport(
                first, last, planned.kind, planned.title if last == first else f"{planned.title}, {last - first + 1} times",
                attempt.outcome, attempt.start, climber.time - attempt.start, attempt.tries, self._actor.off(), body_error,
                tip_error, attempt.reason, attempt.recovered,
            )
        )  # fmt: skip

    def plan_again(self, action: Group, outcome: Outcome) -> bool:
        """See `Performer`: from where the robot is, without the holds that were missed."""
        if outcome not in ("missed", "not supported") or self.replan is None:
            return False
        held = {limb.name: self.climber.body.tasks[i].hold for i, limb in enumerate(self.climber.robot.limbs)}
        task = task_from_here(self.course, action[0], held, self._actor.missed)
        self.climber.plant.pause()
        plan = self.replan(task)
        self.climber.monitor.after_pause()
        if plan is None:
            return False
        course = lay_course(task, plan, "new plan")
        if course.objections:
            return False
        self.report.replans.append(NewPlan(len(self.report.actions), sorted(self._actor.missed), len(plan.actions)))
        self._actor.course, self._groups = course, iter(course.groups())
        return True

    def stop_safely(self) -> Ending:
        """See `Performer`: every joint holds where it is, but for the one that has failed."""
        before = self._place()
        self.climber.plant.pause()
        self.climber.brace(BRACED - SETTLED)
        between = self._place()
        self.climber.brace(SETTLED)
        after = self._place()
        return ending_of(math.dist(before, after), math.dist(between, after), holds=self._holds())

    def _holds(self) -> bool:
        """Whether a tip is where a hold is, truly where that is told."""
        climber = self.climber
        tips = [climber.body.tip(i) for i in range(climber.body.n)] if climber.truth is None else climber.truth().tips
        return any(math.dist(tip, hold) < AT_HOLD for tip in tips for hold in climber.holds.values())

    def _place(self) -> tuple[float, float]:
        """Of the body, truly where that is told [m]."""
        climber = self.climber
        x, y = (climber.body.settled if climber.truth is None else climber.truth().pose)[:2]
        return float(x), float(y)

    def name(self, action: Group) -> str:
        """See `Performer`."""
        return f"step {action[0]}, {self.course.actions[action[0] - 1].title}"

    def end(self) -> None:
        """See `Performer`: a climb is done only where the body came to the goal."""
        report, climber = self.report, self.climber
        report.pose = _tuple(climber.body.settled)
        report.findings = list(climber.monitor.findings)
        pose = climber.body.settled
        if climber.truth is not None:
            truth = climber.truth()
            pose = truth.pose
            report.true_pose = _tuple(pose)
            report.broken = list(truth.broken)
        # on uneven terrain the goal is where the holds of the plan's end are
        shift = np.array((*self._actor.shift(len(self.course.actions)), 0.0))
        report.short = beyond(self.course.task, pose - shift)
        planned = beyond(self.course.task, self.course.pose(len(self.course.actions)))
        if report.done and report.short > planned + ARRIVED:
            report.done = False
            stalled = sum(action.outcome == "stalled" for action in report.actions)
            done = f"{stalled} of its moves did not arrive, and" if stalled else "every action was carried out, but"
            report.reason = f"short: {done} the body ends {1e3 * report.short:.0f} mm short of the goal"
        if report.broken and not report.done:
            report.reason += f" ({report.broken[-1]})"


def _tuple(pose: Floats) -> tuple[float, float, float]:
    return float(pose[0]), float(pose[1]), float(pose[2])
