"""What stands still in any picture, and its words: axes in the task's unit, hatched regions, goals, poses."""

import math
from collections.abc import Iterable, Sequence
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FuncFormatter, MultipleLocator

from ..shown_units import units_of
from ..tasks import Task
from ..tasks.regions import GoalBox
from ..types import Floats
from ..units import DEGREE
from . import style

DIRECTIONS: Final = (("right", 1.0 + 0j), ("left", -1.0 + 0j), ("up", 1j), ("down", -1j))


def length_unit(task: Task) -> tuple[str, float]:
    """Unit of length for people, and its size [m]: as the task's files are written, or as was chosen."""
    return units_of(task.document).place[:2]


def describe_pose(task: Task, x: float, y: float, angle: float) -> str:
    """A pose in words: x, y in the task's unit, angle in degrees."""
    unit, size = length_unit(task)
    turn = math.remainder(angle, math.tau) / DEGREE
    return f"x {x / size:.1f} {unit},  y {y / size:.1f} {unit},  {round(turn)}°"


PAD: Final = 0.05
"""Least room around everything that is drawn [m]."""
GOAL_WORDS: Final = "#4F6B20"
"""Colour of goals' names."""

Bounds = tuple[float, float, float, float]
"""x from, x to, y from, y to, world frame [m]."""


def fit_bounds(points: Floats, goals: Iterable[GoalBox]) -> Bounds:
    """The part of the world that holds some points, shape (n, 2), with room around them, and every edge of a goal."""
    low, high = points.min(axis=0), points.max(axis=0)
    pad = max(PAD, 0.03 * float((high - low).max()))
    ends = [(float(first), float(last)) for first, last in zip(low - pad, high + pad, strict=True)]
    for goal in goals:  # an edge of a goal must be seen, with some of what lies beyond
        for k, edge in enumerate(goal.box):
            if math.isfinite(edge):
                first, last = ends[k // 2]
                beyond = -2 * pad if k % 2 else 2 * pad
                ends[k // 2] = min(first, edge + min(beyond, 0.0)), max(last, edge + max(beyond, 0.0))
    return *ends[0], *ends[1]


def goal_box(goal: GoalBox, bounds: Bounds) -> Floats | None:
    """Corners of a goal's box, open sides cut off at the picture's edge, shape (4, 2); None where all are open."""
    if not any(map(math.isfinite, goal.box)):
        return None
    x0, x1, y0, y1 = (side if math.isfinite(side) else edge for side, edge in zip(goal.box, bounds, strict=True))
    return np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])


def join(first: Bounds, second: Bounds) -> Bounds:
    """The part of a world that holds both parts."""
    return min(first[0], second[0]), max(first[1], second[1]), min(first[2], second[2]), max(first[3], second[3])


def name_goal(goals: Sequence[GoalBox], index: int, extra: Sequence[str] = ()) -> str:
    """What a goal is called in pictures, with what it asks for beside a place."""
    goal = goals[index]
    word = "Goal" if index == len(goals) - 1 else f"{index + 1}"
    asked = list(extra)
    if goal.theta_min is not None and goal.theta_max is not None:
        asked.insert(0, f"{goal.theta_min / DEGREE:.0f} to {goal.theta_max / DEGREE:.0f}°")
    return (f"{word}: {goal.name}" if goal.name else word) + (f" ({', '.join(asked)})" if asked else "")


def halo(width: float = 1.8) -> withStroke:
    """A light rim that keeps text readable on anything."""
    return withStroke(linewidth=width, foreground=style.PAPER)


def set_axes(axes: Axes, task: Task, bounds: Bounds) -> None:
    """Set up axes of world metres with ticks in the task's unit."""
    unit, size = length_unit(task)
    axes.set(xlim=(bounds[0], bounds[1]), ylim=(bounds[2], bounds[3]))
    axes.set_aspect("equal")
    axes.set_facecolor(style.WALL)
    span = max(bounds[1] - bounds[0], bounds[3] - bounds[2]) / size
    every = 3.0 * 2.0 ** max(0, math.ceil(math.log2(span / 24))) if unit == "in" else _round(span / 8)
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


def draw_forbidden(axes: Axes, polygons: Iterable[Iterable[tuple[float, float]]]) -> None:
    """Hatch the regions that the robot must keep out of."""
    for polygon in polygons:
        axes.add_patch(
            Polygon(np.array(polygon), facecolor="#ECEEF1", edgecolor=style.QUIET, hatch="////", lw=0.8, zorder=1)
        )


def draw_region(axes: Axes, corners: Floats, *, last: bool) -> None:
    """Shade a goal's region; the last goal's more strongly."""
    alpha = 0.20 if last else 0.11
    axes.add_patch(Polygon(corners, facecolor=style.GOAL, edgecolor="none", alpha=alpha, zorder=0.5))
    axes.add_patch(
        Polygon(corners, fill=False, edgecolor=style.GOAL, lw=1.1, ls="-" if last else (0, (3, 2)), zorder=0.6)
    )


def label_region(axes: Axes, corners: Floats, words: str, bounds: Bounds, font: float) -> None:
    """Write a goal's name above its region's upper corner, on the side that has room; a point is a region, too."""
    left = float(corners[:, 0].min()) <= 0.5 * (bounds[0] + bounds[1])
    x = float(corners[:, 0].min() if left else corners[:, 0].max())
    axes.annotate(
        words,
        (x, float(corners[:, 1].max())),
        xytext=(2 if left else -2, 2),
        textcoords="offset points",
        ha="left" if left else "right",
        va="bottom",
        fontsize=font + 0.5,
        color=GOAL_WORDS,
        zorder=9,
        path_effects=[halo()],
    )
