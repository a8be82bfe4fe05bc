"""A tool path followed by arm and body: the path in space with the robot at both ends, and error and manipulability over time."""

from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes

from ....viewing import style
from ....viewing.output import drawing
from ..control.cooperative.planted_feet import SUPPORT_WORDS
from ..trials.cooperative.follow import FollowRun
from .arm_and_body import draw_robot, set_space

WANTED: Final = style.QUIET
TOOL: Final = style.PARTS[0]
START_ALPHA: Final = 0.3
MILLI: Final = 1e3


def draw_follow(run: FollowRun, path: str | Path) -> None:
    """Draw a run.

    Args:
        run: What was followed.
        path: A file (.png, .svg, .pdf).

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    with drawing(path, (10.0, 5.2)) as figure:
        grid = figure.add_gridspec(2, 2, width_ratios=(1.35, 1.0))
        space: Any = figure.add_subplot(grid[:, 0], projection="3d")
        _draw_space(space, run)
        upper = figure.add_subplot(grid[0, 1])
        lower = figure.add_subplot(grid[1, 1], sharex=upper)
        _draw_over_time(upper, lower, run)
        title = f"{run.path.label}: {run.options.dof} degrees of freedom, {SUPPORT_WORDS[run.footing.support]} standing"
        figure.suptitle(title, x=0.01, ha="left", fontsize=11, fontweight="bold")
        figure.supxlabel(run.reason, fontsize=8.5, x=0.01, ha="left", color=style.QUIET)


def _draw_space(space: Any, run: FollowRun) -> None:
    on = run.on_path > 0.0
    space.plot(*run.places[~on].T, color=TOOL, lw=0.9, ls=":", label="way to its start")
    space.plot(*run.path.points.T, color=WANTED, lw=3.2, alpha=0.5, label="path")
    space.plot(*run.places[on].T, color=TOOL, lw=1.3, label="tool")
    if run.off_end > 1e-3:
        space.plot(*run.path.points[-1], marker="x", ms=7, color=style.ALERT, ls="none", label="end, not reached")
    draw_robot(space, run.footing, run.q[0], START_ALPHA)
    draw_robot(space, run.footing, run.q[-1], 1.0)
    set_space(space)
    space.legend(loc="upper left", fontsize=8)


def _draw_over_time(upper: Axes, lower: Axes, run: FollowRun) -> None:
    on = run.on_path > 0.0
    begins = float(run.time[on][0])
    upper.plot(run.time, run.measure, color=TOOL, lw=1.5)
    upper.set_ylabel("manipulability V [-]")
    upper.set_ylim(bottom=0.0)
    lower.plot(run.time, np.linalg.norm(run.places - run.wanted, axis=1) * MILLI, color=style.ALERT, lw=1.2)
    lower.set_ylabel("tool off its place [mm]")
    lower.set_xlabel("time [s]")
    for axes in (upper, lower):
        style.bare(axes)
        axes.grid(color=style.FAINT, lw=0.6)
        axes.axvspan(0.0, begins, color=style.WALL, zorder=0)
    upper.annotate(
        "way to its start", (0.5 * begins, 0.03), xycoords=("data", "axes fraction"), ha="center", fontsize=7.5,
        color=style.QUIET,
    )  # fmt: skip
