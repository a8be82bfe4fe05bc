"""What stands still in a climber's picture: the wall with its holds, keep-outs and goals."""

import math
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PatchCollection
from matplotlib.patches import Circle, Wedge

from ....types import Floats
from ....units import DEGREE
from ....viewing import style
from ....viewing.scene import (
    Bounds,
    draw_forbidden,
    draw_region,
    fit_bounds,
    goal_box,
    halo,
    label_region,
    name_goal,
    set_axes,
)
from ..planning.task import Goal, LimbedTask
from .geometry import Posture

CROWDED: Final = 0.16
"""Holds are drawn no larger than this share of their spacing [-]."""
NUMBER_WIDTH: Final = 0.045
"""Width of a hold's number, as a share of the picture [-]."""


def find_bounds(task: LimbedTask, postures: list[Posture], arrows: Floats | None = None) -> Bounds:
    """The part of the wall that holds the board, closed goals, every posture and the tips of arrows, shape (n, 2)."""
    parts: list[Floats] = [task.world.positions()]
    parts += [np.array(polygon) for polygon in task.world.keep_out]
    parts += [np.vstack([posture.outline, posture.chains.reshape(-1, 2)]) for posture in postures]
    parts += [np.array(goal.region) for goal in task.goals if goal.region is not None]
    parts += [] if arrows is None else [arrows]
    return fit_bounds(np.vstack(parts), task.goals)


def hold_radius(task: LimbedTask, bounds: Bounds) -> float:
    """Smallest radius with which a hold is drawn, so that it can be seen [m]."""
    return min(0.0045 * max(bounds[1] - bounds[0], bounds[3] - bounds[2]), CROWDED * spacing(task))


def spacing(task: LimbedTask) -> float:
    """About how far apart the holds are [m]: the root of the area that each has."""
    points = task.world.positions()
    width, height = np.maximum(points.max(axis=0) - points.min(axis=0), 1e-3)
    return math.sqrt(width * height / len(points))


def has_room_for_numbers(task: LimbedTask, bounds: Bounds) -> bool:
    """Whether the holds' numbers can be told apart in a picture."""
    return spacing(task) > NUMBER_WIDTH * max(bounds[1] - bounds[0], bounds[3] - bounds[2])


def goal_outline(goal: Goal, bounds: Bounds) -> Floats | None:
    """Corners of a goal's region or box, open sides cut off at the picture's edge, shape (n, 2); None without either."""
    return goal_box(goal, bounds) if goal.region is None else np.array(goal.region, dtype=np.float64)


def goal_label(task: LimbedTask, index: int) -> str:
    """What a goal is called in pictures."""
    goal = task.goals[index]
    extra = [f"{limb} on {number}" for limb, number in goal.holds.items()]
    if goal.turns is not None:
        extra.insert(0, f"{goal.turns:+g} turn" + ("s" if abs(goal.turns) != 1 else ""))
    return name_goal(task.goals, index, extra)


def draw_scene(axes: Axes, task: LimbedTask, bounds: Bounds, *, font: float = 7.0) -> None:
    """Draw wall, keep-outs, goals and holds, numbered if there is room, and set up the axes."""
    set_axes(axes, task, bounds)
    draw_forbidden(axes, task.world.keep_out)
    _draw_goals(axes, task, bounds, font)
    least = hold_radius(task, bounds)
    discs, cones = [], []
    for hold in task.world.holds:
        radius = max(hold.radius, least)
        discs.append(Circle((hold.x, hold.y), radius))
        if hold.direction is not None:
            half = math.pi / 2 if hold.cone is None else hold.cone
            lower, upper = (hold.direction - half) / DEGREE, (hold.direction + half) / DEGREE
            cones.append(Wedge((hold.x, hold.y), 3.2 * radius, lower, upper))
    # One collection of all: ten thousand patches of their own take a quarter of a minute to draw.
    axes.add_collection(PatchCollection(cones, facecolor=style.HOLD, edgecolor="none", alpha=0.25, zorder=1.9))
    axes.add_collection(PatchCollection(discs, facecolor=style.HOLD, edgecolor="none", zorder=2))
    if has_room_for_numbers(task, bounds):
        _number_holds(axes, task, font - (1.5 if len(task.world.holds) > 80 else 0.0))


def _number_holds(axes: Axes, task: LimbedTask, font: float) -> None:
    for hold in task.world.holds:
        axes.annotate(
            str(hold.number), (hold.x, hold.y), xytext=(-3, 3), textcoords="offset points", ha="right", va="bottom",
            fontsize=font, color=style.QUIET, zorder=2.5, path_effects=[halo()],
        )  # fmt: skip


def _draw_goals(axes: Axes, task: LimbedTask, bounds: Bounds, font: float) -> None:
    least = hold_radius(task, bounds)
    for index, goal in enumerate(task.goals):
        corners = goal_outline(goal, bounds)
        places = []
        if corners is not None:
            draw_region(axes, corners, last=index == len(task.goals) - 1)
        if goal.turns is not None and goal.centre is not None:
            axes.plot(*goal.centre, marker="+", ms=9, mew=1.2, color=style.GOAL, zorder=0.7)
            places.append(goal.centre)
        for number in goal.holds.values():
            hold = task.world.by_number(number)
            ring = Circle((hold.x, hold.y), 2.2 * least + hold.radius, fill=False, ec=style.GOAL, lw=1.4, zorder=1.5)
            axes.add_patch(ring)
            places.append((hold.x, hold.y))
        if corners is not None or places:
            at = corners if corners is not None else np.array(places[:1])
            label_region(axes, at, goal_label(task, index), bounds, font)
