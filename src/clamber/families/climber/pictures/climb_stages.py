"""A climb that was carried out, as still pictures: the robot at the end of each action, and the body's way over time."""

from collections.abc import Mapping
from itertools import cycle
from pathlib import Path
from textwrap import wrap
from typing import Final

import numpy as np
from matplotlib.figure import Figure

from ....types import Floats
from ....viewing import style
from ....viewing.output import CANVASES, check_suffix, drawing, save_figure
from ....viewing.scene import Bounds
from ....viewing.style import styled
from ..execution.climb_trace import ClimbTrace
from ..trials.run_plan import ClimbRun
from .climb_run_view import ClimbRunView
from .climber import ClimberArtists
from .wall import draw_scene

ROWS: Final = 2
ROOM: Final = 0.04
"""About the robot in all stages [m]."""
MILLI: Final = 1e3
WIDTH: Final = 130
"""Characters of a line of the actions' names."""


def draw_stages(run: ClimbRun, path: str | Path) -> None:
    """Draw start and end of every action, in order.

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    check_suffix(path, CANVASES)
    actions = run.report.actions
    with styled():
        view = ClimbRunView(run.task, run.trace, actions)
        shown = [view.settled(step) for step in range(len(actions) + 1)]
        titles = ["start", *(action.title for action in actions)]
        points = np.vstack([np.vstack([at.posture.outline, at.posture.chains.reshape(-1, 2)]) for at in shown])
        bounds = _around(points)
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


def _around(points: Floats) -> Bounds:
    low, high = points.min(axis=0) - ROOM, points.max(axis=0) + ROOM
    return float(low[0]), float(high[0]), float(low[1]), float(high[1])


def draw_body_over_time(run: ClimbRun, path: str | Path) -> None:
    """Draw x and y of the body over time, the actions numbered.

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    trace = run.trace
    poses = trace.believed if trace.true_pose is None else trace.true_pose
    with drawing(path, (8.6, 5.2)) as figure:
        grid = figure.subplots(2, 1, sharex=True, height_ratios=(1.0, 1.4))
        for which, (axes, name) in enumerate(zip(grid, ("x [mm]", "y [mm]"), strict=True)):
            axes.plot(trace.time, trace.aim[:, which] * MILLI, color=style.INK, lw=0.9, label="as aimed at")
            axes.plot(trace.time, poses[:, which] * MILLI, color=style.PARTS[0], lw=1.5, label="as it is")
            axes.set_ylabel(name)
            style.bare(axes)
            axes.grid(axis="y", color=style.FAINT, lw=0.6)
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
        path: A file (.png, .svg, .pdf).

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    with drawing(path, (8.6, 3.8)) as figure:
        axes = figure.subplots()
        for (label, trace), colour in zip(traces.items(), cycle(style.PARTS)):
            assert trace.true_pose is not None
            above = (trace.true_pose[:, 1] - trace.aim[:, 1]) * MILLI
            axes.plot(trace.time, above, color=colour, lw=1.4, label=label)
            axes.plot(trace.time[-1:], above[-1:], color=colour, marker="o", ms=4)
        style.bare(axes)
        axes.grid(color=style.FAINT, lw=0.6)
        axes.set_xlabel("time [s]")
        axes.set_ylabel("body above its aim [mm]")
        axes.legend(fontsize=8, ncols=3)
