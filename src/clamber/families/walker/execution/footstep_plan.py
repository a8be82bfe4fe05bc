"""What a walk follows: which frame is lifted next, and where it comes down; along a track, or as a plan has it."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from ....types import Floats
from ..control.gait import FINE, Step, farthest_step, look_at_step, target_of, up_to_corner
from ..control.track import Track
from ..robot import FRAME_TITLES, WalkerRobot
from ..robot.plane_poses import compose, seen_from
from .settings import WalkSettings
from .walker import Walker

ASTRAY = 0.02
"""A planned step is not tried where the frame that stands is farther than this from where the plan has it [m] ..."""
TURNED = 0.02
"""... or turned by more [rad]."""


@dataclass(slots=True, eq=False)
class ImaginedWalker:
    """A robot that stands where it is put: what a track's course asks of a walker, to be gone through beforehand."""

    robot: WalkerRobot
    settings: WalkSettings
    payload: float
    """At the tool point [kg]."""
    arm: Floats
    """Joint angles [rad]."""
    placed: Floats
    """Both frames seen from above: x, y [m] and heading [rad], shape (2, 3)."""

    def frames(self) -> Floats:
        """See `Walker`."""
        return self.placed

    def postures(self) -> list[Floats]:
        """See `Walker`."""
        return [self.arm]

    def steps(self, course: "TrackCourse") -> Iterator[Step]:
        """Go through a course as far as one can: every step, told before its frame is where it comes down."""
        while not course.done:
            step = course.next(self)
            if step is None:
                return
            yield step
            self.placed[step.swing] = step.end
            if not course.landed(step, self):
                return


class TrackCourse:
    """The frames take turns along a track, each as far as mechanism and balance allow.

    Args:
        track: Where the Delta-frame goes.
        neutral: Angle of the Y-frame in the Delta-frame where both are at one place of the track [rad].
    """

    def __init__(self, track: Track, *, neutral: float = 0.0) -> None:
        self.length, self.goal = track.length, track.pose(track.length)
        """Of the whole way [m]; pose of the Delta-frame at its end, seen from above, shape (3,)."""
        self._track, self._neutral = track, neutral
        self._ways = np.zeros(2)
        self._swing: int | None = None

    @property
    def way(self) -> float:
        """How far the robot has come [m]: the frame which is behind."""
        return float(self._ways.min())

    @property
    def done(self) -> bool:
        """Whether both frames are at the end."""
        return self.way >= self.length - FINE

    def next(self, walker: Walker | ImaginedWalker) -> Step | None:
        """The coming step, of the frame whose turn it is or, where it cannot go on, of the other; None where neither can.

        The frame that gets farther comes first.
        """
        if self._swing is None:
            steps = [self._farthest(walker, swing) for swing in (0, 1)]
            self._swing = int(np.argmax([0.0 if step is None else step.way for step in steps]))
        return self._farthest(walker, self._swing) or self._farthest(walker, 1 - self._swing)

    def obstacle(self, walker: Walker | ImaginedWalker) -> str:
        """What keeps both frames from going on, where `next` is None: which limit, and by how much, of a step of two millimetres."""
        return "; ".join(self._lack(walker, swing) for swing in (0, 1))

    def landed(self, step: Step, walker: Walker | ImaginedWalker) -> bool:
        """Take note of where a step's frame came down; whether the robot has come on by it."""
        before = self._ways[step.swing]
        self._ways[step.swing] = self._way_of(step, walker.frames()[step.swing])
        self._swing = 1 - step.swing
        return bool(self._ways[step.swing] - before >= FINE)

    def _lack(self, walker: Walker | ImaginedWalker, swing: int) -> str:
        name, limits = FRAME_TITLES[swing], walker.settings.limits
        if up_to_corner(self._track, self._ways, swing) < FINE:
            return f"the {name} waits for the other at a corner of the way"
        way = min(self.length, float(self._ways[swing]) + 2.0 * FINE)
        end = target_of(self._track, way, swing, self._neutral)
        step = _least_balanced(walker, walker.postures(), swing, way, end)
        if step.balance < limits.balance:
            return (
                f"with the {name} lifted the centre of mass is {1e3 * step.balance:.0f} mm inside the feet that stand, "
                f"and {1e3 * limits.balance:.0f} mm are kept"
            )
        if step.room < 0.0:
            return f"for the {name} {-1e3 * step.room:.1f} mm are missing to the actuators' strokes or to singular postures"
        return f"the {name} can go on by less than {2e3 * FINE:.0f} mm"

    def _farthest(self, walker: Walker | ImaginedWalker, swing: int) -> Step | None:
        room = up_to_corner(self._track, self._ways, swing)
        if room < FINE:
            return None
        postures, longest, step = walker.postures(), min(room, walker.settings.longest), None
        for arm in postures:  # what one of them allows is looked at no farther in the others
            step = farthest_step(
                walker.robot, self._track, walker.frames(), self._ways, swing, neutral=self._neutral, arm=arm,
                payload=walker.payload, limits=walker.settings.limits, longest=longest,
            )  # fmt: skip
            if step is None:
                return None
            longest = step.way - float(self._ways[swing])
        assert step is not None
        return _least_balanced(walker, postures, swing, step.way, step.end)

    def _way_of(self, step: Step, landed: Floats) -> float:
        """Where on the track a frame that came down elsewhere than it was to is, by how far behind along the way it stands [m]."""
        forward = (self._track.pose(min(self.length, step.way)) - self._track.pose(max(0.0, step.way - 1e-3)))[:2]
        if np.hypot(*forward) < 1e-9:
            return step.way
        short = float(forward @ (step.end[:2] - landed[:2])) / float(np.hypot(*forward))
        if short <= FINE:
            return step.way
        return float(np.clip(step.way - short, self._ways[step.swing], step.way))


def _least_balanced(
    walker: Walker | ImaginedWalker, postures: Sequence[Floats], swing: int, way: float, end: Floats
) -> Step:
    """A step to a pose, as it is in that posture of the arm in which it has the least balance."""
    payload, limits = walker.payload, walker.settings.limits
    looks = [look_at_step(walker.robot, walker.frames(), swing, way, end, arm, payload, limits) for arm in postures]
    return min(looks, key=lambda look: look.balance)


@dataclass(frozen=True, slots=True, eq=False)
class PlannedStep:
    """A frame's way through the air as a plan has it."""

    swing: int
    """The frame that is lifted."""
    corners: Floats
    """Poses of the frame where its way bends, and at its end: x, y [m], heading [rad], shape (n, 3)."""
    stands: Floats
    """Pose of the frame that stands, shape (3,)."""


class PlannedCourse:
    """Steps of a plan, laid out from where the robot is; a frame goes straight to its place if it can, else round the plan's corners.

    Args:
        steps: Of the plan.
        start: Pose of the Delta-frame at the plan's start, shape (3,).
        pose: Pose of the Delta-frame as it is, shape (3,).
        radius: A turn counts as the way of a foot so far from the frame's origin [m].
    """

    def __init__(self, steps: Sequence[PlannedStep], start: Floats, pose: Floats, *, radius: float) -> None:
        self._steps = [
            PlannedStep(
                step.swing, compose(pose, seen_from(start, step.corners)), compose(pose, seen_from(start, step.stands))
            )
            for step in steps
        ]
        self._at = 0
        ends = [step.corners[-1] for step in self._steps if step.swing == 0]
        self.goal = ends[-1] if ends else np.array(pose)
        ways = [np.diff(np.vstack([pose[None], *[end[None] for end in ends]]), axis=0)]
        self._ends = np.hypot(np.hypot(ways[0][:, 0], ways[0][:, 1]), radius * ways[0][:, 2])
        self.length = float(self._ends.sum())

    @property
    def way(self) -> float:
        """See `TrackCourse`: that of the Delta-frame."""
        return float(self._ends[: sum(step.swing == 0 for step in self._steps[: self._at])].sum())

    @property
    def done(self) -> bool:
        """See `TrackCourse`."""
        return self._at == len(self._steps)

    def next(self, walker: Walker) -> Step | None:
        """See `TrackCourse`: None where the frame that stands is not where the plan has it."""
        step = self._steps[self._at]
        off = seen_from(step.stands, walker.frames()[1 - step.swing])
        if math.hypot(off[0], off[1]) > ASTRAY or abs(math.remainder(off[2], math.tau)) > TURNED:
            return None
        straight = _least_balanced(walker, [walker.arm], step.swing, self.way, step.corners[-1])
        if straight.room >= 0.0 and straight.balance >= walker.settings.limits.balance:
            return straight
        return replace(straight, over=tuple(step.corners[:-1]))

    def obstacle(self, walker: Walker) -> str:
        """See `TrackCourse`."""
        step = self._steps[self._at]
        off = seen_from(step.stands, walker.frames()[1 - step.swing])
        turned = abs(math.degrees(math.remainder(off[2], math.tau)))
        return (
            f"the {FRAME_TITLES[1 - step.swing]} stands {1e3 * math.hypot(off[0], off[1]):.0f} mm and {turned:.1f} deg from where the plan "
            f"has it; {1e3 * ASTRAY:.0f} mm and {math.degrees(TURNED):.1f} deg are allowed"
        )

    def landed(self, step: Step, walker: Walker) -> bool:
        """See `TrackCourse`."""
        off = seen_from(step.end, walker.frames()[step.swing])
        self._at += 1
        return bool(np.hypot(off[0], off[1]) <= ASTRAY)


FootstepPlan: TypeAlias = TrackCourse | PlannedCourse
"""Steps one after another, each chosen when the robot stands on six feet."""
