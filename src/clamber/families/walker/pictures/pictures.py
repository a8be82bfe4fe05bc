"""How walkers are drawn."""

from dataclasses import replace
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ....files import Document
from ....planning.problem.problem import Replay
from ....planning.problem.problems import normalisation_of
from ....tasks.robots import read_robot, robot_names
from ....tasks.task_format import SCHEMA
from ....types import Floats, Json
from ....viewing import style
from ....viewing.alone import Alone
from ....viewing.pictures import Pictures
from ....viewing.route import FACTS, draw_way, label_ghost, pick_ghosts, write_facts
from ....viewing.scene import Bounds, length_unit, set_axes
from ....viewing.view import Layout
from ..planning.plans import PLANS
from ..planning.task import WalkerTask, build_walker_task
from ..robot import WalkerRobot
from ..world.ground import SCHEMA as GROUND_SCHEMA
from ..world.ground import Ground
from .report import walk_page
from .walk_run_view import run_picture
from .walker_motion import COLOURS, NAMES, WalkerMoment, settled_moment
from .walker_view import WalkerArtists, WalkerView, draw_ground, draw_walk, walker_bounds

BESIDE: Final = 1.0
"""Ground that is shown about what is on it [m]."""


def _around(robot: Json, ground: Json) -> WalkerTask:
    return build_walker_task(
        Document(
            "what is shown",
            {
                "schema": SCHEMA, "name": "alone", "robot": robot, "ground": ground, "goal": {"x_min": "0 m"},
                "start": {"x": "0 m", "y": "0 m"}, "step": {"length": "1 cm", "angle": "15 deg"}, "rules": {"hard": []},
                "labels": {"robot": "robot", "ground": "ground"},
            },
        )
    )  # fmt: skip


def ground_alone(ground: Ground, document: Json) -> Alone:
    """A ground from above; the task about it needs some robot that comes with Clamber."""
    task = replace(_around(read_robot(robot_names("walker")[0]).data, document), goals=())
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
    task = _around(document, {"schema": GROUND_SCHEMA, "name": "level"})
    stance: Any = PLANS.problem(task).replay(np.zeros(0, np.int32)).stances[0]
    at = settled_moment(task, stance)
    bounds = walker_bounds(task, [at])

    def draw(axes: Axes) -> None:
        set_axes(axes, task, bounds)
        WalkerArtists(axes, task, bounds).update(at)

    return Alone(task, bounds, draw, at)


GHOSTS: Final = 2
"""Stances drawn between start and end, at most: a walker covers most of its own steps."""


def walker_route(task: WalkerTask, replay: Replay) -> Figure:
    """A whole walk as one picture."""
    moments = [settled_moment(task, stance) for stance in replay.stances]
    bounds = walker_bounds(task, moments)
    layout = Layout(bounds, FACTS + 0.3, height=6.6)
    subtitle = f"{task.title or task.name}. Line: way of the Delta-frame, dark at the start"
    figure, ground, panel, _ = layout.figure(f"The whole walk: {len(replay.reasons)} actions", subtitle)
    draw_ground(ground, task, bounds)
    _draw_prints(ground, moments)
    _draw_ghosts(ground, task, moments, bounds)
    draw_way(ground, np.array([at.poses[0, :2] for at in moments]))
    unit, size = length_unit(task)
    way = np.abs(np.diff([at.poses[0, :2] for at in moments], axis=0)).sum()
    swaps = int(np.sum(np.diff(replay.stances["stands"]) != 0))
    facts = ("Swaps", str(swaps)), ("Way", f"{way / size:.0f} {unit}, Delta-frame")
    height = layout.panel[1]
    write_facts(panel, replay, normalisation_of(task), facts, height)
    for f, (name, colour) in enumerate(zip(NAMES, COLOURS, strict=True)):
        x, y = 1.5 * f + 0.05, height - FACTS - 0.1
        panel.add_line(Line2D([x], [y], marker="o", ms=4, color=colour, ls=""))
        panel.text(x + 0.12, y, f"stood here: {name}", fontsize=7, va="center", color=style.QUIET)
    layout.fix_panel(panel)
    return figure


def _draw_prints(ground: Axes, moments: list[WalkerMoment]) -> None:
    for f, colour in enumerate(COLOURS):
        feet = np.vstack([at.outline.feet[f] for at in moments if at.lifts[f] == 0.0])
        prints = np.unique(feet.round(6), axis=0)
        ground.plot(prints[:, 0], prints[:, 1], ls="", marker="o", ms=3.2, color=colour, alpha=0.75, zorder=3.5)


def _draw_ghosts(ground: Axes, task: WalkerTask, moments: list[WalkerMoment], bounds: Bounds) -> None:
    last = len(moments) - 1
    for k in pick_ghosts(np.array([at.poses[0, :2] for at in moments]), GHOSTS):
        WalkerArtists(ground, task, bounds, alpha=1.0 if k == last else 0.35).update(moments[k])
        if k < last:
            label_ghost(ground, k, *moments[k].outline.centre_of_mass.tolist())


def start_point(task: WalkerTask) -> Floats:
    """Where the robot starts, world frame [m], shape (1, 2)."""
    return np.array([[task.start.x, task.start.y]])


PICTURES: Final = Pictures(
    WalkerView,
    draw_walk,
    walker_route,
    start_point,
    draw_ground,
    run=run_picture,
    report=walk_page,
    robot_alone=walker_alone,
    world_alone=ground_alone,
)
