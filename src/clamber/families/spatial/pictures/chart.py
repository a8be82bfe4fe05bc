"""A world in space as a map: its guide rolled out, places along it to the right and across it up."""

from typing import Final

from matplotlib.axes import Axes
from matplotlib.patches import Polygon

from ....tasks.regions import GoalBox
from ....types import Floats
from ....viewing import style
from ....viewing.pictures import Chart
from ....viewing.scene import GOAL_WORDS, Bounds, goal_box, halo
from ..planning.surface import on_guide
from ..planning.task import SpatialTask
from ..world.guide import GRAIN
from .world_artists import goal_label


def hold_places(task: SpatialTask) -> Floats:
    """Along and across of the holds, shape (n, 2) [m]."""
    return on_guide(task.world.frames, task.world.places)[:, :2]


def draw_chart(axes: Axes, task: SpatialTask, bounds: Bounds) -> None:
    """Guide, goals and holds on given axes."""
    axes.set(xlim=bounds[:2], ylim=bounds[2:])
    axes.set_aspect("equal")
    axes.set_facecolor(style.PAPER)
    axes.set_xlabel("along the guide [m]", fontsize=8, color=style.QUIET)
    axes.set_ylabel("across [m]", fontsize=8, color=style.QUIET)
    axes.tick_params(labelsize=7, colors=style.QUIET, length=2.5)
    for spine in axes.spines.values():
        spine.set_color(style.FAINT)
    axes.plot(
        [0.0, GRAIN * (len(task.world.frames) - 1)], [0.0, 0.0], color=style.QUIET, lw=0.9, ls=(0, (5, 4)), zorder=1.5
    )
    for k, goal in enumerate(task.goals):
        along_min, along_max, across_min, across_max = goal.box
        corners = goal_box(GoalBox(x_min=along_min, x_max=along_max, y_min=across_min, y_max=across_max), bounds)
        if corners is None:
            continue
        last = k == len(task.goals) - 1
        axes.add_patch(Polygon(corners, fc=style.GOAL, ec="none", alpha=0.3 if last else 0.15, zorder=0.5))
        axes.add_patch(Polygon(corners, fc="none", ec=style.GOAL, lw=1.1, zorder=1.05))
        left, top = corners.min(axis=0)[0], corners.max(axis=0)[1]
        axes.annotate(
            goal_label(task, k), (left, top), xytext=(4, -4), textcoords="offset points", va="top", fontsize=8,
            color=GOAL_WORDS, zorder=7, path_effects=[halo(2.0)],
        )  # fmt: skip
    axes.plot(*hold_places(task).T, marker=".", ms=2.6, color=style.HOLD, ls="", zorder=1.3)


CHART: Final = Chart(hold_places, draw_chart)
