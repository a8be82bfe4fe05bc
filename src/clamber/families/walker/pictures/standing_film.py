"""A walker that stands where its walk begins: a film of one moment."""

from typing import Any

import numpy as np

from ....types import Floats
from ....units import DEGREE
from ....viewing.browser.film import Film, MarginRow
from ..control.gait import lengths_at
from ..control.walker_balance import mass_centre
from ..execution.true_walk import TrueWalk
from ..planning import Walk
from ..robot.weight import arm_places
from .walk_film import weight_on_ground
from .walk_shapes import plate_axes, shapes_at
from .walker_figure import WalkMoment
from .walker_loads import actuator_gauges, leg_gauges


class StandingFilm(Film[WalkMoment]):
    """The start of a walk, which has no plan.

    Args:
        walk: The walk.
    """

    def __init__(self, walk: Walk) -> None:
        robot = walk.robot
        self.title, self.seconds, self.steps, self.grades = walk.title or walk.name, 0.0, ("start",), (3,)
        self.starts = self.ends = np.zeros(1)
        self.gauges = leg_gauges(robot), actuator_gauges(robot)
        trace = standing(walk)
        legs, place = walk.start_legs().ravel(), walk.start_place()
        shapes = shapes_at(robot, trace, 0)
        start = walk.start
        self._moment = WalkMoment(
            shapes, np.zeros((2, 3, 3)), weight_on_ground(robot, walk.payload), np.array([(start.x, start.y, start.heading)] * 2),
            (legs, lengths_at(robot, place[None])[0]),
        )  # fmt: skip
        self._start = start

    def at(self, time: float) -> WalkMoment:
        """See `Film`."""
        return self._moment

    def values(self, at: WalkMoment) -> tuple[Floats, ...]:
        """See `Film`."""
        return at.loads

    def facts(self, step: int, at: WalkMoment) -> tuple[tuple[str, str], ...]:
        """See `Film`."""
        start = self._start
        return (
            ("Plate", f"x {start.x + 0.0:.3f} m,  y {start.y + 0.0:.3f} m,  {start.heading / DEGREE + 0.0:.1f}°"),
            ("Plan", "none is needed: a walk goes its way step by step; press Run"),
        )

    def margins(self, step: int) -> list[MarginRow]:
        """See `Film`: nothing has happened."""
        return []


def standing(walk: Walk) -> TrueWalk:
    """A walk's robot on six feet where it starts, in one row; who carries what, statics does not tell: those forces are NaN."""
    robot, place, legs = walk.robot, walk.start_place(), walk.start_legs().ravel()
    pose = walk.start_pose()
    axes = plate_axes(*pose[3:])
    c, s = np.cos(place[2]), np.sin(place[2])
    tops = robot.feet().copy()
    tops[1] = tops[1] @ np.array(((c, s), (-s, c))) + place[:2]
    down = tops.reshape(6, 2) @ axes[:, :2].T - legs[:, None] * axes[:, 2]
    heights = walk.ground.heights(pose[:2] + down[:, :2])
    pose[2] = float((heights - down[:, 2]).max())
    arm: Any = np.array(walk.arm)
    tool = np.full(3, np.nan) if robot.arm is None else pose[:3] + axes @ arm_places(robot.arm, arm)[-1]
    nothing = np.full((1, 2, 3, 3), np.nan)
    return TrueWalk(
        time=np.zeros(1), pose=pose[None], place=place[None], feet=(pose[:3] + down).reshape(1, 2, 3, 3), forces=nothing,
        centre=mass_centre(robot, pose, place, arm, walk.payload)[None], tool=tool[None], thrusts=np.full((1, 3), np.nan),
        inclines=np.zeros((1, 2)),
    )  # fmt: skip
