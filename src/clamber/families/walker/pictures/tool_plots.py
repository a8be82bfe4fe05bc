"""Motions of body and arm for a tool: a path that is followed, and runs side by side by freedoms and by gain."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes

from ....types import Floats
from ....units import DEGREE
from ....viewing import style
from ....viewing.output import drawing
from ..control.cooperative.planted import heading_of, turn_of
from ..control.cooperative.planted_feet import SUPPORT_WORDS, PlantedFeet
from ..control.cooperative.tool_chain import POSE
from ..robot.weight import arm_places
from ..trials.cooperative.follow import FollowRun

ARM: Final = style.PARTS[1]
DELTA: Final = style.INK
Y: Final = style.PARTS[2]


def draw_robot(axes: Any, footing: PlantedFeet, q: Floats, alpha: float, seen: Sequence[int] = (0, 1, 2)) -> None:
    """Draw frames, standing legs, arm.

    Args:
        axes: As many dimensions as are seen.
        footing: What it stands on.
        q: Freedoms of body and arm, shape (6 + joints,).
        alpha: Opacity.
        seen: Of x, y and z, in order; x and z are the robot as seen along y.
    """
    for points, colour, width in robot_lines(footing, q):
        axes.plot(*points[:, seen].T, color=colour, lw=width, alpha=alpha, solid_capstyle="round")


def robot_lines(footing: PlantedFeet, q: Floats) -> Iterator[tuple[Floats, str, float]]:
    """Points, shape (n, 3) [m], colour and width of the lines of frames, standing legs and arm."""
    robot, turn, origin = footing.robot, turn_of(q[3:6]), q[:3]
    feet = footing.feet_on_ground()
    offset, twist = np.array(footing.offset), footing.twist
    if footing.support == "y":
        offset = (turn.T @ (feet[1].mean(axis=0) - origin))[:2]
        twist += heading_of(footing.pose[3:6]) - heading_of(q[3:6])
    over = robot.feet_in_plate(np.array((*offset, twist))) @ turn[:, :2].T + origin
    for frame, colour in enumerate((DELTA, Y)):
        yield np.vstack([over[frame], over[frame][:1]]) if frame == 0 else _spokes(over[1]), colour, 2.0
        if frame in footing.standing():
            for top, foot in zip(over[frame], feet[frame], strict=True):
                yield np.array([top, foot]), colour, 1.4
    arm = np.vstack([np.zeros(3), [0.0, 0.0, robot.own_arm.up], arm_places(robot.own_arm, q[6:].tolist())])
    yield arm @ turn.T + origin, ARM, 2.6


def set_space(space: Any) -> None:
    """Equal scales, named axes and a view from the side."""
    space.set_aspect("equal")
    for name in "xyz":
        getattr(space, f"set_{name}label")(f"{name} [m]")
        getattr(space, f"{name}axis").pane.set_facecolor(style.WALL)
    space.view_init(elev=18, azim=-62)
    space.locator_params(nbins=5)


def _spokes(tips: Floats) -> Floats:
    """The Y-frame as one line from its middle out to each tip and back."""
    middle = tips.mean(axis=0)
    return np.array([tips[0], middle, tips[1], middle, tips[2]])


WANTED: Final = style.QUIET
TOOL: Final = style.PARTS[0]
START_ALPHA: Final = 0.3
MILLI: Final = 1e3


def draw_follow(run: FollowRun, path: str | Path) -> None:
    """Draw a run.

    Args:
        run: What was followed.
        path: Picture file (`drawing`).
    """
    with drawing(path, (10.0, 5.2)) as figure:
        grid = figure.add_gridspec(2, 2, width_ratios=(1.35, 1.0))
        space: Any = figure.add_subplot(grid[:, 0], projection="3d")
        _draw_space(space, run)
        upper = figure.add_subplot(grid[0, 1])
        lower = figure.add_subplot(grid[1, 1], sharex=upper)
        _draw_over_time(upper, lower, run)
        title = f"{run.path.label}: {run.options.dof} degrees of freedom, {SUPPORT_WORDS[run.footing.support]} standing"
        style.entitle(figure, title)
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
    lower.set(ylabel="tool off its place [mm]", xlabel="time [s]")
    for axes in (upper, lower):
        style.ruled(axes)
        axes.axvspan(0.0, begins, color=style.WALL, zorder=0)
    upper.annotate(
        "way to its start", (0.5 * begins, 0.03), xycoords=("data", "axes fraction"), ha="center", fontsize=7.5,
        color=style.QUIET,
    )  # fmt: skip


ALPHAS: Final = (0.35, 0.6, 1.0)
"""Of start, middle and end."""
MOTION_COLOURS: Final = (style.INK, style.PARTS[0], style.PARTS[1], style.PARTS[2])
DASHES: Final = ("-", (0, (4, 3)), "-", "-")
"""The second may lie on the first."""
COLOURS: Final = (style.QUIET, style.PARTS[0], style.PARTS[1], style.PARTS[2])


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """A motion as pictures need it."""

    title: str
    footing: PlantedFeet
    q: Floats
    """Freedoms, shape (rows, m)."""
    places: Floats
    """Of the tool [m], shape (rows, 3)."""


def draw_motions(motions: Sequence[Motion], time: Floats, path: str | Path) -> None:
    """Draw start, middle and end of each motion from the side, and below how far each joint of the arm turns in all of them.

    Args:
        motions: Each with a row for each time.
        time: [s], shape (rows,).
        path: Picture file (`drawing`).
    """
    joints = motions[0].q.shape[1] - POSE
    with drawing(path, (12.0, 6.1)) as figure:
        above, below = figure.subfigures(2, 1, squeeze=False, height_ratios=(1.4, 1.0))[:, 0]
        sides = above.subplots(1, len(motions), sharex=True, sharey=True)
        for side, motion, colour in zip(sides, motions, MOTION_COLOURS, strict=False):
            for row, alpha in zip((0, len(motion.q) // 2, -1), ALPHAS, strict=True):
                draw_robot(side, motion.footing, motion.q[row], alpha, (0, 2))
            side.plot(motion.places[:, 0], motion.places[:, 2], color=style.PARTS[0], lw=2.0)
            side.axhline(0.0, color=style.QUIET, lw=0.8)
            side.set_aspect("equal")
            side.set_title(motion.title, fontsize=9.5, color=colour)
            side.set_xlabel("x [m]")
            style.bare(side)
        sides[0].set_ylabel("height [m]")
        for joint, axes in enumerate(below.subplots(1, joints)):
            for motion, colour, dashes in zip(motions, MOTION_COLOURS, DASHES, strict=False):
                turned = (motion.q[:, POSE + joint] - motion.q[0, POSE + joint]) / DEGREE
                axes.plot(time, turned, color=colour, lw=1.8, ls=dashes)
            axes.set_title(f"$\\theta_{joint}$ from its start [deg]", fontsize=9, weight="normal")
            axes.set_xlabel("time [s]")
            style.ruled(axes, "y")


def draw_gains(time: Floats, courses: Mapping[float, Floats], means: Mapping[int, Floats], path: str | Path) -> None:
    """Draw V over time by gain, and the mean V of random ways over that with the first gain.

    Args:
        time: [s], shape (rows,).
        courses: k_p -> V [-], shape (rows,).
        means: Degrees of freedom -> mean V by way and gain, shape (ways, gains).
        path: Picture file (`drawing`).
    """
    gains = list(courses)
    with drawing(path, (9.4, 3.8)) as figure:
        left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.25))
        for colour, (gain, course) in zip(COLOURS, courses.items(), strict=False):
            left.plot(time, course, color=colour, lw=1.6, label=f"$k_p$ = {gain:g}")
        left.set(xlabel="time [s]", ylabel="manipulability V [-]")
        left.legend(fontsize=8)
        rng = np.random.default_rng(0)
        for place, values in enumerate(means.values()):
            for k in range(1, len(gains)):
                ratios = values[:, k] / values[:, 0]
                at = place + 0.22 * (2 * k - len(gains)) + rng.uniform(-0.07, 0.07, len(ratios))
                right.plot(at, ratios, ".", ms=4, color=COLOURS[k], alpha=0.75)
        right.axhline(1.0, color=style.QUIET, lw=0.8)
        right.set_xticks(range(len(means)), [f"{dof} dof" for dof in means])
        right.set_ylabel(f"mean V over that with $k_p$ = {gains[0]:g} [-]")
        for axes in (left, right):
            style.ruled(axes, "y")


def draw_freedoms(means: Floats, dofs: Sequence[int], gains: Sequence[float], path: str | Path) -> None:
    """Draw the mean V of each way over the number of freedoms.

    Args:
        means: Mean V, shape (gains, ways, sets).
        dofs: Degrees of freedom of each set.
        gains: k_p of each panel.
        path: Picture file (`drawing`).
    """
    with drawing(path, (9.4, 3.6)) as figure:
        for axes, gain, values in zip(figure.subplots(1, len(gains), sharey=True), gains, means, strict=True):
            for way in values:
                axes.plot(range(len(dofs)), way, color=style.PARTS[4], lw=0.6, alpha=0.6)
            axes.plot(range(len(dofs)), np.median(values, axis=0), color=style.INK, lw=2.0, marker="o", ms=4)
            axes.set_xticks(range(len(dofs)), [str(dof) for dof in dofs])
            axes.set_xlabel("degrees of freedom")
            axes.set_title(f"$k_p$ = {gain:g}", fontsize=9.5)
            style.ruled(axes, "y")
        figure.axes[0].set_ylabel("mean V of a way [-]; median in bold")
        figure.axes[0].set_ylim(bottom=0.0)
