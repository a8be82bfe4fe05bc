"""How walkers are drawn."""

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ....planning.problem.problem import Replay
from ....types import Floats
from ....viewing import style
from ....viewing.pictures import Pictures
from ....viewing.route import FACTS, draw_way, label_ghost, pick_ghosts, whole_title, write_facts
from ....viewing.scene import Bounds, length_unit
from ....viewing.view import Layout
from ..planning.task import WalkerTask
from ..robot import FRAME_TITLES
from .alone import ground_alone, walker_alone
from .report import walk_page
from .walk_run_view import run_picture
from .walker_motion import COLOURS, WalkerMoment, settled_moment
from .walker_view import WalkerArtists, WalkerView, draw_ground, draw_walk, near_walk, walker_bounds

GHOSTS: Final = 2
"""Stances drawn between start and end, at most: a walker covers most of its own steps."""


def walker_route(task: WalkerTask, replay: Replay) -> Figure:
    """A whole walk as one picture."""
    moments = [settled_moment(task, stance) for stance in replay.stances]
    bounds = walker_bounds(task, moments)
    layout = Layout(bounds, FACTS + 0.3, height=6.6)
    subtitle = f"{task.title or task.name}. Line: way of the Delta-frame, dark at the start"
    figure, ground, panel, _ = layout.figure(whole_title("walk", replay), subtitle)
    draw_ground(ground, task, bounds)
    _draw_prints(ground, moments)
    _draw_ghosts(ground, task, moments, bounds)
    draw_way(ground, np.array([at.poses[0, :2] for at in moments]))
    unit, size = length_unit(task)
    way = np.abs(np.diff([at.poses[0, :2] for at in moments], axis=0)).sum()
    swaps = int(np.sum(np.diff(replay.stances["stands"]) != 0))
    facts = ("Swaps", str(swaps)), ("Way", f"{way / size:.0f} {unit}, Delta-frame")
    height = layout.panel[1]
    write_facts(panel, task, replay, facts, height)
    for f, (name, colour) in enumerate(zip(FRAME_TITLES, COLOURS, strict=True)):
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
    near=near_walk,
    report=walk_page,
    robot_alone=walker_alone,
    world_alone=ground_alone,
)
