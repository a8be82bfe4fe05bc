"""A walker at one moment, from above as planned and in space as it was, and what happens between two stances."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.spatial import ConvexHull

from ....types import Floats, Ints
from ....viewing import style
from ....viewing.recording import Part
from ..execution.true_walk import TrueWalk
from ..execution.walk_scene import plate_axes
from ..planning.problem import WalkerOutline, carried_weight, outline
from ..planning.task import WalkerTask
from ..robot import WalkerRobot
from ..robot.plane_poses import placed

COLOURS: Final = (style.PARTS[0], style.PARTS[1])
"""Of Delta-frame and Y-frame."""


@dataclass(frozen=True, slots=True, eq=False)
class WalkShapes:
    """Points in the world [m]."""

    frames: tuple[Floats, Floats]
    """Lines of the Delta-frame's triangle, shape (4, 3), and of the Y-frame's star, shape (5, 3)."""
    actuators: Floats
    """Ends of the actuators, shape (3, 2, 3)."""
    legs: Floats
    """Tops and soles of the legs, shape (2, 3, 2, 3)."""
    touching: Ints
    """1 for feet on the ground, shape (2, 3)."""
    arm: Floats
    """From the plate over the shoulder to the tool point, shape (3, 3); NaN without an arm."""
    centre: Floats
    """Centre of mass, shape (3,)."""


def shapes_at(robot: WalkerRobot, trace: TrueWalk, k: int) -> WalkShapes:
    """The robot at a trace's row."""
    axes, origin = plate_axes(*trace.pose[k, 3:]), trace.pose[k, :3]

    def in_world(points: Floats, f: int) -> Floats:
        flat = placed(points, trace.place[k]) if f else points
        there: Floats = origin + flat @ axes[:, :2].T
        return there

    attachments = [in_world(points, f) for f, points in enumerate(robot.attachments())]
    middle = in_world(np.zeros((1, 2)), 1)[0]
    delta, star = attachments
    tops = np.stack([in_world(points, f) for f, points in enumerate(robot.feet())])
    shoulder = np.full(3, np.nan) if robot.arm is None else origin + robot.arm.up * axes[:, 2]
    return WalkShapes(
        (delta[[0, 1, 2, 0]], np.array((star[1], middle, star[0], middle, star[2]))),
        np.stack((delta, star), axis=1),
        np.stack((tops, trace.feet[k]), axis=2),
        trace.touching[k],
        np.array((origin, shoulder, trace.tool[k])),
        trace.centre[k],
    )


@dataclass(frozen=True, slots=True)
class WalkerMoment:
    """A walker at rest or moving."""

    outline: WalkerOutline
    poses: Floats
    """x, y [m] and angle [rad] of both frames, world frame, shape (2, 3)."""
    lifts: tuple[float, float]
    """How far each frame's feet are lifted: 0 on the ground, 1 as high as they go [-]."""

    @property
    def lengths(self) -> Floats:
        """Lengths of the actuators [m], shape (3,)."""
        ends = self.outline.actuators
        lengths: Floats = np.hypot(*(ends[:, 1] - ends[:, 0]).T)
        return lengths

    @property
    def support(self) -> Floats:
        """Corners of the hull of the feet on the ground, anticlockwise, shape (3 or 6, 2)."""
        feet = np.vstack([self.outline.feet[f] for f in (0, 1) if self.lifts[f] == 0.0])
        return feet if len(feet) == 3 else feet[ConvexHull(feet).vertices]


def settled_moment(task: WalkerTask, stance: np.void) -> WalkerMoment:
    """A stance record, to be drawn."""
    stands = int(stance["stands"])
    return WalkerMoment(outline(task, stance), np.array(stance["pose"]), (float(stands != 0), float(stands != 1)))


def posed_moment(task: WalkerTask, stance: np.void, poses: Floats) -> WalkerMoment:
    """A stance with its frames at other poses, shape (2, 3)."""
    at = stance.copy()
    at["pose"] = poses
    for f, feet in enumerate(task.robot.feet()):
        at["foot"][f] = placed(feet, poses[f])
    at["mass_x"], at["mass_y"] = carried_weight(task).centre(poses)
    return settled_moment(task, at)


def walker_motion(task: WalkerTask, before: np.void, after: np.void) -> list[Part[WalkerMoment]]:
    """The parts of the motion from one stance record to the next; it starts and ends exactly in them."""
    first, last = settled_moment(task, before), settled_moment(task, after)
    if int(before["stands"]) != int(after["stands"]):
        return _swap(first, last)
    way = last.poses - first.poses
    if not np.any(way):
        return [Part("still", lambda share, _: last)]
    way[:, 2] = [math.remainder(turn, math.tau) for turn in way[:, 2]]

    def slide(share: float, _: float) -> WalkerMoment:
        if share <= 0.0 or share >= 1.0:
            return first if share <= 0.0 else last
        return posed_moment(task, before, first.poses + share * way)

    return [Part("slide", slide)]


def _swap(first: WalkerMoment, last: WalkerMoment) -> list[Part[WalkerMoment]]:
    def at(base: WalkerMoment, share: float) -> WalkerMoment:
        lifts = tuple(share if lift > 0.0 else 0.0 for lift in base.lifts)
        return WalkerMoment(base.outline, base.poses, (lifts[0], lifts[1]))

    return [
        Part("land", lambda share, _: at(first, 1.0 - share)),
        Part("both", lambda share, _: at(first, 0.0)),
        Part("lift", lambda share, _: at(last, share)),
    ]
