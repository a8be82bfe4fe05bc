"""What stands still in a climber's picture: the wall with its holds, keep-outs and goals."""

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Wedge

from ..tasks.limbed import Goal, LimbedTask
from ..types import Floats
from ..units import DEGREE
from . import style
from .geometry import Posture
from .scene import Bounds, draw_forbidden, draw_region, fit_bounds, goal_box, halo, label_region, name_goal, set_axes


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
    return 0.0045 * max(bounds[1] - bounds[0], bounds[3] - bounds[2])


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
    """Draw wall, keep-outs, goals and numbered holds, and set up the axes."""
    set_axes(axes, task, bounds)
    draw_forbidden(axes, task.world.keep_out)
    _draw_goals(axes, task, bounds, font)
    least = hold_radius(task, bounds)
    crowd = len(task.world.holds) > 80
    for hold in task.world.holds:
        radius = max(hold.radius, least)
        axes.add_patch(Circle((hold.x, hold.y), radius, facecolor=style.HOLD, edgecolor="none", zorder=2))
        if hold.direction is not None:
            half = math.pi / 2 if hold.cone is None else hold.cone
            lower, upper = (hold.direction - half) / DEGREE, (hold.direction + half) / DEGREE
            axes.add_patch(
                Wedge((hold.x, hold.y), 3.2 * radius, lower, upper, facecolor=style.HOLD, alpha=0.25, lw=0, zorder=1.9)
            )
        axes.annotate(
            str(hold.number), (hold.x, hold.y), xytext=(-3, 3), textcoords="offset points", ha="right", va="bottom",
            fontsize=font - (1.5 if crowd else 0.0), color=style.QUIET, zorder=2.5, path_effects=[halo()],
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
