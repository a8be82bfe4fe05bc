"""How climbers are drawn: whole plans, and climbs stage by stage."""

from collections.abc import Mapping
from itertools import cycle
from pathlib import Path
from textwrap import wrap
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ....planning.problem.problem import Replay
from ....types import Floats
from ....viewing import style
from ....viewing.output import CANVASES, check_suffix, drawing, save_figure
from ....viewing.pictures import Pictures
from ....viewing.route import FACTS, ROW, draw_way, label_ghost, pick_ghosts, whole_title, write_facts
from ....viewing.scene import Bounds
from ....viewing.style import styled
from ....viewing.view import PANEL_WIDTH, Layout, is_wide
from ..execution.climb_trace import ClimbTrace
from ..planning.task import LimbedTask
from ..trials.run_plan import ClimbRun
from .alone import board_alone, climber_alone
from .artists import ClimberArtists, draw_scene, find_bounds, torque_gauges, torque_limits, unloaded
from .climb_run import ClimbFilm, run_picture
from .climb_view import ClimbView, Transition, draw_climb, near_climb
from .geometry import Posture, stance_posture
from .report import climb_page

ROWS: Final = 2
ROOM: Final = 0.04
"""About the robot in all stages [m]."""
MILLI: Final = 1e3
WIDTH: Final = 130
"""Characters of a line of the actions' names."""


def draw_stages(run: ClimbRun, path: str | Path) -> None:
    """Draw start and end of every action, in order."""
    check_suffix(path, CANVASES)
    actions = run.report.actions
    with styled():
        view = ClimbFilm(run.task, run.trace, actions)
        shown = [view.settled(step) for step in range(len(actions) + 1)]
        titles = ["start", *(action.title for action in actions)]
        points = np.vstack([np.vstack([at.posture.outline, at.posture.chains.reshape(-1, 2)]) for at in shown])
        low = points.min(axis=0) - ROOM
        high = points.max(axis=0) + ROOM
        bounds = float(low[0]), float(high[0]), float(low[1]), float(high[1])
        columns = -(-len(shown) // ROWS)
        height = 2.1 * (bounds[3] - bounds[2]) / (bounds[1] - bounds[0])
        figure = Figure(figsize=(2.1 * columns, ROWS * (height + 0.35)), layout="constrained")
        grid = figure.subplots(ROWS, columns, squeeze=False)
        for k, axes in enumerate(grid.flat):
            axes.set_visible(k < len(shown))
            if k < len(shown):
                draw_scene(axes, run.task, bounds, font=6.0)
                ClimberArtists(axes, run.task, bounds, arrows=False).update(shown[k])
                axes.set(xlim=bounds[:2], ylim=bounds[2:], xlabel="", ylabel="")
                axes.set_title(f"{k}  {titles[k]}", fontsize=7.5, fontweight="normal", pad=9)
                axes.tick_params(labelsize=6)
        save_figure(figure, path)


def draw_body_over_time(run: ClimbRun, path: str | Path) -> None:
    """Draw x and y of the body over time, the actions numbered."""
    trace = run.trace
    poses = trace.believed if trace.true_pose is None else trace.true_pose
    with drawing(path, (8.6, 5.2)) as figure:
        grid = figure.subplots(2, 1, sharex=True, height_ratios=(1.0, 1.4))
        for which, (axes, name) in enumerate(zip(grid, ("x [mm]", "y [mm]"), strict=True)):
            axes.plot(trace.time, trace.aim[:, which] * MILLI, color=style.INK, lw=0.9, label="as aimed at")
            axes.plot(trace.time, poses[:, which] * MILLI, color=style.PARTS[0], lw=1.5, label="as it is")
            axes.set_ylabel(name)
            style.ruled(axes, "y")
            for number, action in enumerate(run.report.actions, 1):
                axes.axvline(action.start, color=style.FAINT, lw=0.8, zorder=0)
                if which == 0:
                    axes.text(
                        action.start + action.seconds / 2, 1.02, str(number), ha="center", va="bottom", fontsize=8,
                        color=style.QUIET, transform=axes.get_xaxis_transform(),
                    )  # fmt: skip
        grid[0].legend(loc="best", fontsize=8, ncols=2)
        grid[1].set_xlabel("time [s]")
        what = "; ".join(f"{number} {action.title}" for number, action in enumerate(run.report.actions, 1))
        figure.suptitle("\n".join(wrap(what, WIDTH)), x=0.01, ha="left", fontsize=8, color=style.QUIET)


def draw_heights(traces: Mapping[str, ClimbTrace], path: str | Path) -> None:
    """Draw how far above its aim the body truly is over time, one line for each control.

    Args:
        traces: Label -> a climb of a plant that tells the truth.
        path: Of the picture (`drawing`).
    """
    with drawing(path, (8.6, 3.8)) as figure:
        axes = figure.subplots()
        for (label, trace), colour in zip(traces.items(), cycle(style.PARTS)):
            assert trace.true_pose is not None
            above = (trace.true_pose[:, 1] - trace.aim[:, 1]) * MILLI
            axes.plot(trace.time, above, color=colour, lw=1.4, label=label)
            axes.plot(trace.time[-1:], above[-1:], color=colour, marker="o", ms=4)
        style.ruled(axes)
        axes.set(xlabel="time [s]", ylabel="body above its aim [mm]")
        axes.legend(fontsize=8, ncols=3)


MOST_ROWS: Final = 9
"""Rows of holds that are listed for one limb."""
ARC: Final = 12
"""Points of the body's way within one swing."""


def climb_route(task: LimbedTask, replay: Replay) -> Figure:
    """A whole climb as one picture."""
    shown = [stance_posture(task.robot, task.world, stance) for stance in replay.stances]
    bounds = find_bounds(task, shown)
    uses = [
        shorten(wrap_words(f"{name}:  " + " › ".join(map(str, numbers))))
        for name, numbers in zip(task.robot.limb_names, holds_used(task, replay), strict=True)
    ]
    words = 0.4 + sum(ROW * len(rows) + 0.05 for rows in uses)
    layout = Layout(bounds, max(words, FACTS) if is_wide(bounds) else FACTS + words, height=6.6)
    subtitle = f"{task.title}. Line: way of the body, dark at the start"
    figure, wall, panel, _ = layout.figure(whole_title("climb", replay), subtitle)
    draw_scene(wall, task, bounds)
    _draw_ghosts(wall, task, shown, bounds)
    draw_way(wall, body_way(task, replay))
    height = layout.panel[1]
    write_facts(panel, task, replay, _facts(task, replay), height)
    _write_uses(panel, uses, *((PANEL_WIDTH + 0.4, height) if layout.below else (0.0, height - FACTS)))
    layout.fix_panel(panel)
    return figure


def _draw_ghosts(wall: Axes, task: LimbedTask, shown: list[Posture], bounds: Bounds) -> None:
    last = len(shown) - 1
    for k in pick_ghosts(np.array([(posture.x, posture.y) for posture in shown])):
        climber = ClimberArtists(wall, task, bounds, alpha=1.0 if k == last else 0.3, arrows=False)
        climber.update(unloaded(shown[k]))
        if k < last:
            label_ghost(wall, k, shown[k].x, shown[k].y)


def _facts(task: LimbedTask, replay: Replay) -> tuple[tuple[str, str], ...]:
    gauges = torque_gauges(task)
    torque = float(np.max(np.abs(replay.stances["torques"][:, : len(task.robot.limbs)])))
    most, limit = map(gauges.show, (torque, float(gauges.high.max())))
    return ("Hangs", str(int(replay.stances["hangs"][-1]))), ("Largest torque", f"{most} of {limit}")


def _write_uses(panel: Axes, uses: list[list[str]], left: float, top: float) -> None:
    panel.text(left, top, "Holds in the order of use", fontsize=9, weight="bold", va="top")
    y = top - 0.26
    for i, rows in enumerate(uses):
        colour = style.PARTS[i % len(style.PARTS)]
        panel.add_line(Line2D([left + 0.04], [y - 0.06], marker="s", ms=6, color=colour, ls=""))
        for row in rows:
            panel.text(left + 0.18, y, row, fontsize=7, va="top")
            y -= ROW
        y -= 0.05


def holds_used(task: LimbedTask, replay: Replay) -> list[list[int]]:
    """Numbers of the holds that each limb takes, in order, the start's first."""
    uses: list[list[int]] = [[] for _ in task.robot.limbs]
    for stance in replay.stances:
        for i, numbers in enumerate(uses):
            held = int(stance["hold"][i])
            if held >= 0 and (not numbers or numbers[-1] != task.world.holds[held].number):
                numbers.append(task.world.holds[held].number)
    return uses


def body_way(task: LimbedTask, replay: Replay) -> Floats:
    """Way of the body's origin, swings as arcs, world frame [m], shape (n, 2)."""
    points = [(float(replay.stances["x"][0]), float(replay.stances["y"][0]))]
    for before, after in zip(replay.stances[:-1], replay.stances[1:], strict=True):
        for phase in Transition(task.robot, task.world, before, after).phases():
            shares = np.linspace(0, 1, ARC)[1:] if phase.kind == "swing" else (1.0,)
            for share in shares if phase.kind in ("move", "swing") else ():
                at = phase.at(float(share))
                points.append((at.x, at.y))
    return np.array(points)


def shorten(rows: list[str], most: int = MOST_ROWS) -> list[str]:
    """The first rows and the last two, where there are more than `most`."""
    if len(rows) <= most:
        return rows
    return [*rows[: most - 3], f"   ... {len(rows) - most + 1} rows left out ...", *rows[-2:]]


def wrap_words(line: str, most: int = 60) -> list[str]:
    """A line broken between words."""
    rows, row = [], ""
    for word in line.split(" › "):
        if row and len(row) + len(word) + 3 > most:
            rows.append(row + " ›")
            row = "   " + word
        else:
            row = f"{row} › {word}" if row else word
    return [*rows, row]


def wall_points(task: LimbedTask) -> Floats:
    """Holds and corners of regions to keep out of, world frame [m], shape (n, 2)."""
    return np.vstack([task.world.positions(), *(np.array(polygon) for polygon in task.world.keep_out)])


PICTURES: Final = Pictures(
    ClimbView,
    draw_climb,
    climb_route,
    wall_points,
    draw_scene,
    torque_limits,
    run_picture,
    climb_page,
    near=near_climb,
    robot_alone=climber_alone,
    world_alone=board_alone,
)
