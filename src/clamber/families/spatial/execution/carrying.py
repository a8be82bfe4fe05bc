"""A robot in space that carries out a plan: what the sequencer is told of its motions."""

import math
from typing import Final

import numpy as np

from ....execution.run_report import BRACED, SETTLED, Ending, Outcome, ending_of
from ....execution.sequencer import Attempt, Performer
from ....types import Floats
from .carrying_report import CarryingReport, MotionReport
from .course import BodyMotion, Course, Motion, Regrab
from .limbed_body import LimbedBody
from .motions import move_body, regrab, rest

AT_FIRST: Final = 0.3
"""The robot stands still for that long before it moves [s]."""


class Carrying(Performer[Motion, CarryingReport, int, int]):
    """A robot and the course that it follows.

    Args:
        body: The robot.
        course: What its plan asks for.
    """

    goes_on = frozenset({"ok"})

    def __init__(self, body: LimbedBody, course: Course) -> None:
        self.body, self.course = body, course
        self.report = CarryingReport()
        self._at = 0
        self._off = math.nan
        body.told = self._watch

    @property
    def time(self) -> float:
        """See `Performer`."""
        return self.body.time

    def begin(self) -> None:
        """See `Performer`: the robot is put on its holds and stands."""
        self.body.start(self.course.start)
        rest(self.body, AT_FIRST)

    def next(self) -> Motion | None:
        """See `Performer`."""
        motions = self.course.motions
        return motions[self._at] if self._at < len(motions) else None

    def told(self, action: Motion) -> tuple[int, int]:
        """See `Performer`: the action that begins, and how many there are."""
        return action.first, self.course.motions[-1].last

    def carry_out(self, action: Motion) -> tuple[Outcome, int, str]:
        """See `Performer`."""
        self._off = math.nan
        if isinstance(action, BodyMotion):
            move_body(self.body, action)
            self._off = float(np.linalg.norm(self.body.law.aims.position - self.body.law.state.position))
            return "ok", 1, ""
        landing = regrab(self.body, action)
        self._off = landing.off
        return ("ok" if landing.taken else "missed"), landing.tries, landing.reason

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

    def stop_safely(self) -> Ending:
        """See `Performer`: the robot stays where it is."""
        places = [self._place()]
        for seconds in (BRACED - SETTLED, SETTLED):
            rest(self.body, seconds)
            places.append(self._place())
        moved, late = (float(np.linalg.norm(places[k] - places[2])) for k in (0, 1))
        return ending_of(moved, late, holds=bool((self.body.holds >= 0).any()))

    def name(self, action: Motion) -> str:
        """See `Performer`."""
        if isinstance(action, Regrab):
            return f"step {action.first}, {self.body.robot.limb_names[action.limb]} to hold {action.hold + 1}"
        return f"step {action.first}, a move of the body"

    def end(self) -> None:
        """See `Performer`."""
        report, state = self.report, self.body.law.state
        report.failures = self.body.law.failures
        report.pose = pose_of(state.position, state.rotation)
        true = self.body.plant.truth()
        if true is not None and np.isfinite(true.pose.position).all():
            report.true_pose = pose_of(true.pose.position, true.pose.rotation)

    def _place(self) -> Floats:
        """Of the body, truly where that is told [m]."""
        true = self.body.plant.truth()
        return self.body.law.state.position.copy() if true is None else true.pose.position.copy()

    def _watch(self) -> None:
        """After every tick."""
        report, law = self.report, self.body.law
        report.off = max(report.off, float(np.linalg.norm(law.aims.position - law.state.position)))
        report.torque = max(report.torque, float(np.max(np.abs(law.torques) / law.limits.torque)))


def pose_of(position: Floats, rotation: Floats) -> tuple[float, ...]:
    """x, y, z [m], then the unit quaternion w, x, y, z."""
    from scipy.spatial.transform import Rotation

    x, y, z, w = Rotation.from_matrix(rotation).as_quat().tolist()
    return (*position.tolist(), w, x, y, z)
