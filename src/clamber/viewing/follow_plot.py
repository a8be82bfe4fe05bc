"""A tool path followed by arm and body: the path in space with the robot at both ends, and error and manipulability over time."""

from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..control.cooperative.footing import SUPPORT_WORDS
from ..control.cooperative.planted import heading_of, turn_of
from ..experiments.cooperative.follow import FollowRun
from ..types import Floats
from . import style
from .output import CANVASES, check_suffix, save_figure
from .style import styled

WANTED: Final = style.QUIET
TOOL: Final = style.PARTS[0]
ARM: Final = style.PARTS[1]
DELTA: Final = style.INK
Y: Final = style.PARTS[2]
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
    check_suffix(path, CANVASES)
    with styled():
        figure = Figure(figsize=(10.0, 5.2), layout="constrained")
        grid = figure.add_gridspec(2, 2, width_ratios=(1.35, 1.0))
        space: Any = figure.add_subplot(grid[:, 0], projection="3d")
        _draw_space(space, run)
        upper = figure.add_subplot(grid[0, 1])
        lower = figure.add_subplot(grid[1, 1], sharex=upper)
        _draw_over_time(upper, lower, run)
        title = f"{run.path.label}: {run.options.dof} degrees of freedom, {SUPPORT_WORDS[run.footing.support]} standing"
        figure.suptitle(title, x=0.01, ha="left", fontsize=11, fontweight="bold")
        figure.supxlabel(run.reason, fontsize=8.5, x=0.01, ha="left", color=style.QUIET)
        save_figure(figure, path)


def _draw_space(space: Any, run: FollowRun) -> None:
    on = run.on_path > 0.0
    space.plot(*run.places[~on].T, color=TOOL, lw=0.9, ls=":", label="way to its start")
    space.plot(*run.path.points.T, color=WANTED, lw=3.2, alpha=0.5, label="path")
    space.plot(*run.places[on].T, color=TOOL, lw=1.3, label="tool")
    if run.off_end > 1e-3:
        space.plot(*run.path.points[-1], marker="x", ms=7, color=style.ALERT, ls="none", label="end, not reached")
    draw_robot(space, run, 0, START_ALPHA)
    draw_robot(space, run, -1, 1.0)
    space.set_aspect("equal")
    for name in "xyz":
        getattr(space, f"set_{name}label")(f"{name} [m]")
        getattr(space, f"{name}axis").pane.set_facecolor(style.WALL)
    space.view_init(elev=18, azim=-62)
    space.locator_params(nbins=5)
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


def draw_robot(space: Any, run: FollowRun, row: int, alpha: float) -> None:
    """Draw frames, standing legs and arm at one row of a run into 3-D axes."""
    q, robot = run.q[row], run.robot
    turn, origin = turn_of(q[3:6]), q[:3]
    feet = run.footing.feet_on_ground()
    offset, twist = np.array(run.footing.offset), run.footing.twist
    if run.footing.support == "y":
        offset = (turn.T @ (feet[1].mean(axis=0) - origin))[:2]
        twist += heading_of(run.footing.pose[3:6]) - heading_of(q[3:6])
    c, s = np.cos(twist), np.sin(twist)
    plate = robot.feet()
    plate[1] = plate[1] @ np.array([[c, s], [-s, c]]) + offset
    over = plate @ turn[:, :2].T + origin
    for frame, colour in enumerate((DELTA, Y)):
        loop = np.vstack([over[frame], over[frame][:1]]) if frame == 0 else _spokes(over[1])
        space.plot(*loop.T, color=colour, lw=2.0, alpha=alpha)
        if frame in run.footing.standing():
            for top, foot in zip(over[frame], feet[frame], strict=True):
                space.plot(*np.array([top, foot]).T, color=colour, lw=1.4, alpha=alpha)
    space.plot(*arm_points(run, row).T, color=ARM, lw=2.6, alpha=alpha, solid_capstyle="round")


def _spokes(tips: Floats) -> Floats:
    """The Y-frame as one line from its middle out to each tip and back."""
    middle = tips.mean(axis=0)
    return np.array([tips[0], middle, tips[1], middle, tips[2]])


def arm_points(run: FollowRun, row: int) -> Floats:
    """The arm's joints and its tool in the world at one row of a run [m], shape (links + 3, 3)."""
    arm = run.robot.arm
    assert arm is not None, "only robots with an arm follow paths"
    q = run.q[row]
    pitches = np.concatenate([[0.0], np.cumsum(q[7:])])
    out = np.concatenate([[0.0, 0.0], arm.out + np.cumsum([0.0, *(np.array(arm.links) * np.cos(pitches[1:]))])])
    up = np.concatenate([[0.0, arm.up], arm.up + np.cumsum([0.0, *(np.array(arm.links) * np.sin(pitches[1:]))])])
    plate = np.column_stack([out * np.cos(q[6]), out * np.sin(q[6]), up])
    points: Floats = plate @ turn_of(q[3:6]).T + q[:3]
    return points
