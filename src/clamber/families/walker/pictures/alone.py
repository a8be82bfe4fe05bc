"""A walker or a ground by itself, as pictures and the viewer take them: a task that is never planned stands around it."""

from dataclasses import replace
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes

from ....files import Document
from ....tasks.robots import read_robot, robot_names
from ....tasks.task_format import SCHEMA
from ....types import Json
from ....viewing.alone import Alone
from ....viewing.scene import set_axes
from ..planning.plans import PLANS
from ..planning.task import WalkerTask, build_walker_task
from ..robot import WalkerRobot
from ..world.ground import SCHEMA as GROUND_SCHEMA
from ..world.ground import Ground
from .walker_motion import settled_moment
from .walker_view import WalkerArtists, draw_ground, walker_bounds

BESIDE: Final = 1.0
"""Ground that is shown about what is on it [m]."""


def _around(document: Json, **shown: Any) -> WalkerTask:
    """What stands in for a task: a walker that comes with Clamber on level ground, with what is shown in their place."""
    robot = read_robot(robot_names("walker")[0]).data
    stand_in = build_walker_task(
        Document(
            "what is shown",
            {
                "schema": SCHEMA, "name": "alone", "robot": robot, "goal": {"x_min": "0 m"},
                "ground": {"schema": GROUND_SCHEMA, "name": "level"},
                "start": {"x": "0 m", "y": "0 m"}, "step": {"length": "1 cm", "angle": "15 deg"}, "rules": {"hard": []},
                "labels": {"robot": "robot", "ground": "ground"},
            },
        )
    )  # fmt: skip
    return replace(stand_in, document=stand_in.document | document, **shown)


def ground_alone(ground: Ground, document: Json) -> Alone:
    """A ground from above."""
    task = _around({"ground": document}, world=ground, goals=())
    bounds = *_within(ground, 0, ground.x_min, ground.x_max), *_within(ground, 1, ground.y_min, ground.y_max)
    return Alone(task, bounds, lambda axes: draw_ground(axes, task, bounds))


def _within(ground: Ground, axis: int, low: float, high: float) -> tuple[float, float]:
    """The part of the ground, along an axis, that has all edges of blocks, rough parts and patches but its own ends [m]."""
    parts = (*(block.corners() for block in ground.raised()), *ground.forbidden())
    edges = [place[axis] for corners in parts for place in corners if low < place[axis] < high]
    middle = min(max(0.0, low), high)
    return max(min(edges, default=middle) - BESIDE, low), min(max(edges, default=middle) + BESIDE, high)


def walker_alone(robot: WalkerRobot, document: Json) -> Alone:
    """A walker from above, on its Delta-frame."""
    task = _around({"robot": document}, robot=robot)
    stance: Any = PLANS.problem(task).replay(np.zeros(0, np.int32)).stances[0]
    at = settled_moment(task, stance)
    bounds = walker_bounds(task, [at])

    def draw(axes: Axes) -> None:
        set_axes(axes, task, bounds)
        WalkerArtists(axes, task, bounds).update(at)

    return Alone(task, bounds, draw, at)
