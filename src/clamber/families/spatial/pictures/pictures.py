"""How robots in space are drawn: a stance, a whole plan, a map of the guide rolled out, and what needs a camera."""

from itertools import pairwise
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon

from ....planning.problem.problem import Replay
from ....tasks.regions import GoalBox
from ....types import Floats
from ....viewing import style
from ....viewing.pictures import Chart, Pictures
from ....viewing.route import FACTS, draw_way, label_ghost, pick_ghosts, whole_title, write_facts
from ....viewing.scene import GOAL_WORDS, Bounds, goal_box, halo
from ....viewing.view import Layout
from ..planning.surface import on_guide
from ..planning.task import SpatialTask
from ..world.guide import GRAIN
from .alone import robot_alone, world_alone
from .camera import Camera, camera_for
from .moments import Moment, settled_moments
from .robot_artists import RobotArtists, limb_colour
from .run_view import RunPicture, RunView
from .spatial_view import SpatialView, describe_pose, stance_bounds
from .world_artists import discs, draw_world, goal_label, hold_radii, mixed, set_axes

GHOSTS: Final = 3
"""Stances that are drawn between start and end of a whole plan, at most."""
GHOST: Final = 0.45
"""Opacity of a stance on the way [-]."""


def draw_stance(task: SpatialTask, stance: np.void, axes: Axes, camera: Camera) -> None:
    """One stance in its world, on given axes."""
    moments = settled_moments(task, np.array([stance]))
    shown, bounds = stance_bounds(task, camera, moments)
    draw_world(axes, task, camera, shown, bounds)
    RobotArtists(axes, task, camera, bounds).update(moments[0])


def draw_route(task: SpatialTask, replay: Replay, camera: Camera) -> Figure:
    """A whole plan: the path of the body, the holds that each limb took, some stances on the way."""
    moments = settled_moments(task, replay.stances)
    shown, bounds = stance_bounds(task, camera, moments)
    layout = Layout(bounds, FACTS + 0.3, height=6.6)
    subtitle = f"{task.title or task.name}. Line: path of the body, dark at the start"
    figure, wall, panel, _ = layout.figure(whole_title("plan", replay), subtitle)
    draw_world(wall, task, camera, shown, bounds)
    _mark_used(wall, task, camera, moments, bounds)
    path = np.array([at.body.place for at in moments])
    flat = camera.flat(path)
    last = len(moments) - 1
    for k in pick_ghosts(flat, GHOSTS) if last else [0]:
        RobotArtists(wall, task, camera, bounds, 1.0 if k == last else GHOST).update(moments[k])
        if k < last:
            label_ghost(wall, k, *flat[k].tolist())
    if last:
        draw_way(wall, flat)
    _write_panel(layout, panel, task, replay, moments)
    return figure


def _mark_used(wall: Axes, task: SpatialTask, camera: Camera, moments: list[Moment], bounds: Bounds) -> None:
    """Colour every hold that a limb took in the limb's colour."""
    radii = hold_radii(task, bounds)
    world = task.world
    for limb in range(len(task.robot.chains.limb_names)):
        taken = sorted({at.holds[limb] for at in moments})
        outlines = camera.flat(discs(world.places[taken], world.normals[taken], 1.25 * radii[taken]))
        wall.add_collection(
            PolyCollection(
                list(outlines),
                facecolors=mixed(limb_colour(limb), style.PAPER, 0.25),
                edgecolors=style.PAPER,
                linewidths=0.4,
                zorder=2.3,
                alpha=0.8,
            )
        )


def _write_panel(layout: Layout, panel: Axes, task: SpatialTask, replay: Replay, moments: list[Moment]) -> None:
    regrabs = sum(before.holds != after.holds for before, after in pairwise(moments))
    path = (
        float(np.linalg.norm(np.diff([at.body.place for at in moments], axis=0), axis=1).sum())
        if len(moments) > 1
        else 0.0
    )
    length = f"{path:.2f} m" if path >= 1.0 else f"{100.0 * path:.0f} cm"
    facts = (
        ("Holds taken", f"{regrabs}, body path {length}"),
        ("End", describe_pose(task, moments[-1].pose).split(", yaw")[0]),
    )
    height = layout.panel[1]
    write_facts(panel, task, replay, facts, height)
    names = task.robot.chains.limb_names
    for limb, name in enumerate(names):
        x, y = 0.05 + 0.9 * (limb % 4), height - FACTS - 0.1 - 0.16 * (limb // 4)
        panel.add_line(Line2D([x], [y], marker="o", ms=4.5, color=limb_colour(limb), ls=""))
        panel.text(x + 0.1, y, name, fontsize=7, va="center", color=style.QUIET)
    layout.fix_panel(panel)


def world_points(task: SpatialTask, camera: Camera) -> Floats:
    """Holds and guide as the camera sees them, shape (n, 2) [m]."""
    return camera.flat(np.vstack((task.world.places, task.world.frames[:, :3])))


def draw_bare_world(axes: Axes, task: SpatialTask, bounds: Bounds, camera: Camera) -> None:
    """A task's world on given axes."""
    draw_world(axes, task, camera, np.vstack((task.world.places, task.world.frames[:, :3])), bounds)


def hold_places(task: SpatialTask) -> Floats:
    """Along and across of the holds, shape (n, 2) [m]."""
    return on_guide(task.world.frames, task.world.places)[:, :2]


def draw_chart(axes: Axes, task: SpatialTask, bounds: Bounds) -> None:
    """Guide, goals and holds on given axes."""
    set_axes(axes, bounds)
    axes.set_xlabel("along the guide [m]", fontsize=8, color=style.QUIET)
    axes.set_ylabel("across [m]", fontsize=8, color=style.QUIET)
    axes.tick_params(labelsize=7, colors=style.QUIET, length=2.5)
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


def pictures_from(asked: str | None) -> Pictures:
    """Pictures from a camera (`camera.camera_for`); None: from one that suits each world."""
    return Pictures(
        lambda task, replay: SpatialView(task, replay, camera_for(task, asked)),
        lambda task, stance, axes: draw_stance(task, stance, axes, camera_for(task, asked)),
        lambda task, replay: draw_route(task, replay, camera_for(task, asked)),
        lambda task: world_points(task, camera_for(task, asked)),
        lambda axes, task, bounds: draw_bare_world(axes, task, bounds, camera_for(task, asked)),
        run=lambda run: RunPicture(RunView(run.task, run.trace, camera_for(run.task, asked))),
        robot_alone=robot_alone,
        world_alone=world_alone,
        chart=Chart(hold_places, draw_chart),
        seen_from=pictures_from,
    )


PICTURES: Final = pictures_from(None)
