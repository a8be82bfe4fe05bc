"""What stands still in a picture: the wall with its holds and keep-outs, its goals, the axes in the task's unit."""

import math
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Polygon, Wedge
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FuncFormatter, MultipleLocator

from ..tasks.limbed import Goal, LimbedTask
from ..types import Floats
from ..units import DEGREE
from . import style
from .geometry import Posture
from .words import length_unit

PAD: Final = 0.05
"""Least room around everything that is drawn [m]."""

Bounds = tuple[float, float, float, float]
"""x from, x to, y from, y to, world frame [m]."""


def find_bounds(task: LimbedTask, postures: list[Posture]) -> Bounds:
    """The part of the wall that holds the board, closed goals and every posture."""
    parts: list[Floats] = [task.world.positions()]
    parts += [np.array(polygon) for polygon in task.world.keep_out]
    parts += [np.vstack([posture.outline, posture.chains.reshape(-1, 2)]) for posture in postures]
    parts += [np.array(goal.region) for goal in task.goals if goal.region is not None]
    points = np.vstack(parts)
    low, high = points.min(axis=0), points.max(axis=0)
    pad = max(PAD, 0.03 * float((high - low).max()))
    x0, y0, x1, y1 = (float(edge) for edge in (*(low - pad).tolist(), *(high + pad).tolist()))
    room = 2 * pad
    for goal in task.goals:  # an edge of a goal must be seen, with some of what lies beyond
        for edge, along_x, sign in (
            (goal.x_min, True, 1), (goal.x_max, True, -1), (goal.y_min, False, 1), (goal.y_max, False, -1)
        ):  # fmt: skip
            if edge is None:
                continue
            if along_x:
                x0, x1 = min(x0, edge + min(sign * room, 0.0)), max(x1, edge + max(sign * room, 0.0))
            else:
                y0, y1 = min(y0, edge + min(sign * room, 0.0)), max(y1, edge + max(sign * room, 0.0))
    return x0, x1, y0, y1


def hold_radius(task: LimbedTask, bounds: Bounds) -> float:
    """Smallest radius with which a hold is drawn, so that it can be seen [m]."""
    return 0.0045 * max(bounds[1] - bounds[0], bounds[3] - bounds[2])


def goal_outline(goal: Goal, bounds: Bounds) -> Floats | None:
    """Corners of a goal's region or box, open sides cut off at the picture's edge, shape (n, 2); None without either."""
    if goal.region is not None:
        return np.array(goal.region, dtype=np.float64)
    if all(side is None for side in (goal.x_min, goal.x_max, goal.y_min, goal.y_max)):
        return None
    x0, x1, y0, y1 = (
        given if given is not None else edge
        for given, edge in zip((goal.x_min, goal.x_max, goal.y_min, goal.y_max), bounds, strict=True)
    )
    return np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])


def goal_label(task: LimbedTask, index: int) -> str:
    """What a goal is called in pictures."""
    goal = task.goals[index]
    last = index == len(task.goals) - 1
    word = "Goal" if last else f"{index + 1}"
    name = f"{word}: {goal.name}" if goal.name else word
    extra = []
    if goal.turns is not None:
        extra.append(f"{goal.turns:+g} turn" + ("s" if abs(goal.turns) != 1 else ""))
    if goal.theta_min is not None and goal.theta_max is not None:
        extra.append(f"{goal.theta_min / DEGREE:.0f} to {goal.theta_max / DEGREE:.0f}°")
    extra += [f"{limb} on {number}" for limb, number in goal.holds.items()]
    return name + (f" ({', '.join(extra)})" if extra else "")


def draw_scene(axes: Axes, task: LimbedTask, bounds: Bounds, *, font: float = 7.0) -> None:
    """Draw wall, keep-outs, goals and numbered holds, and set up the axes."""
    _set_axes(axes, task, bounds)
    for polygon in task.world.keep_out:
        axes.add_patch(
            Polygon(np.array(polygon), facecolor="#ECEEF1", edgecolor=style.QUIET, hatch="////", lw=0.8, zorder=1)
        )
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


def halo(width: float = 1.8) -> withStroke:
    """A light rim that keeps text readable on anything."""
    return withStroke(linewidth=width, foreground=style.PAPER)


def _set_axes(axes: Axes, task: LimbedTask, bounds: Bounds) -> None:
    unit, size = length_unit(task)
    axes.set_xlim(bounds[0], bounds[1])
    axes.set_ylim(bounds[2], bounds[3])
    axes.set_aspect("equal")
    axes.set_facecolor(style.WALL)
    span = max(bounds[1] - bounds[0], bounds[3] - bounds[2]) / size
    every = next(step for step in (3, 6, 12, 24, 48, 96, 1e9) if span / step <= 8) if unit == "in" else _round(span / 6)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MultipleLocator(every * size))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value / size + 0.0:.0f}"))
    axes.set_xlabel(f"x [{unit}]", fontsize=8, labelpad=1)
    axes.set_ylabel(f"y [{unit}]", fontsize=8, labelpad=1)
    for spine in axes.spines.values():
        spine.set_color(style.FAINT)
    axes.tick_params(color=style.FAINT)


def _round(about: float) -> float:
    power = float(10.0 ** math.floor(math.log10(about)))
    return next(m * power for m in (1, 2, 5, 10) if m * power >= about)


def _draw_goals(axes: Axes, task: LimbedTask, bounds: Bounds, font: float) -> None:
    least = hold_radius(task, bounds)
    for index, goal in enumerate(task.goals):
        last = index == len(task.goals) - 1
        alpha = 0.20 if last else 0.11
        corners = goal_outline(goal, bounds)
        text_at = None
        if corners is not None:
            axes.add_patch(Polygon(corners, facecolor=style.GOAL, edgecolor="none", alpha=alpha, zorder=0.5))
            axes.add_patch(
                Polygon(corners, fill=False, edgecolor=style.GOAL, lw=1.1, ls="-" if last else (0, (3, 2)), zorder=0.6)
            )
            text_at = float(corners[:, 0].min()), float(corners[:, 1].max())
        if goal.turns is not None and goal.centre is not None:
            axes.plot(*goal.centre, marker="+", ms=9, mew=1.2, color=style.GOAL, zorder=0.7)
            text_at = text_at or goal.centre
        for number in goal.holds.values():
            hold = task.world.by_number(number)
            ring = Circle((hold.x, hold.y), 2.2 * least + hold.radius, fill=False, ec=style.GOAL, lw=1.4, zorder=1.5)
            axes.add_patch(ring)
            text_at = text_at or (hold.x, hold.y)
        if text_at is not None:
            left = text_at[0] <= 0.5 * (bounds[0] + bounds[1])
            x = text_at[0] if left or corners is None else float(corners[:, 0].max())
            axes.annotate(
                goal_label(task, index), (x, text_at[1]), xytext=(2 if left else -2, 2),
                textcoords="offset points", ha="left" if left else "right", va="bottom",
                fontsize=font + 0.5, color="#4F6B20", zorder=9, path_effects=[halo()],
            )  # fmt: skip
