"""Walks of studies: inclined plates, plates kept level beside others, ways seen from above."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.axes import Axes

from ....types import Floats
from ....units import DEGREE
from ....viewing import style
from ....viewing.output import drawing
from ..trials.run_walk import WalkRun

AXES: Final = ("along x", "along y")
MOVING: Final = "#EEF1F4"
"""Colour of when legs move."""
EVERY: Final = 8
"""Of the tilts, that have an arrow."""


@dataclass(frozen=True, slots=True, eq=False)
class Tilts:
    """Inclines over time."""

    time: Floats
    """[s], shape (rows,)."""
    wanted: Floats
    """How far the plate's axes are to rise [deg], shape (rows, 2)."""
    read: Floats
    """By inclinometers, likewise."""
    true: Floats
    """As it is, likewise."""
    moves: Sequence[tuple[float, float]]
    """Times of legs' motions [s]."""


def draw_inclining(courses: Mapping[str, Tilts], *, within: float, path: str | Path) -> None:
    """Draw what is wanted and read, and below it the plate's true error.

    Args:
        courses: Title -> course; a column each.
        within: Error that is allowed at rest [deg].
        path: Picture file (`drawing`).
    """
    with drawing(path, (4.9 * len(courses), 5.0)) as figure:
        grid = figure.subplots(2, len(courses), sharex="col", sharey="row", squeeze=False, height_ratios=(1.5, 1.0))
        for (title, course), above, below in zip(courses.items(), *grid, strict=True):
            _draw_inclines(above, course)
            _draw_error(below, course, within)
            above.set_title(title, fontsize=9.5)
        grid[0, 0].set_ylabel("incline [deg]")
        grid[1, 0].set_ylabel("true error [deg]")
        grid[0, 0].legend(fontsize=8, loc="lower left")


def _draw_inclines(axes: Axes, course: Tilts) -> None:
    _shade(axes, course)
    for k, (name, colour) in enumerate(zip(AXES, style.PARTS, strict=False)):
        axes.plot(course.time, course.read[:, k], color=colour, lw=1.2, label=f"read {name}")
        axes.plot(course.time, course.wanted[:, k], color=style.INK, lw=0.7, ls=(0, (4, 2)))
    style.bare(axes)


def _draw_error(axes: Axes, course: Tilts, within: float) -> None:
    _shade(axes, course)
    error = np.hypot(*(course.true - course.wanted).T)
    for begin, arrive in course.moves:
        error[(course.time > begin) & (course.time <= arrive)] = (
            np.nan
        )  # a wanted incline is a jump, the plate's is not
    axes.plot(course.time, error, color=style.PARTS[2], lw=1.2)
    axes.axhline(within, color=style.ALERT, lw=0.9, ls=(0, (4, 3)))
    axes.set_ylim(0.0, max(2.0 * within, 1.05 * float(np.nanmax(error))))
    axes.set_xlabel("time [s]")
    style.bare(axes)


def _shade(axes: Axes, course: Tilts) -> None:
    for begin, arrive in course.moves:
        axes.axvspan(begin, arrive, color=MOVING, lw=0, zorder=0)


def draw_directions(tilts: Floats, angles: Floats, right: Floats, told: Floats, path: str | Path) -> None:
    """Draw the steepest angle over the plate's tilt, and arrows uphill: where it is, and where an equation says it is.

    Args:
        tilts: beta and gamma that are looked at [deg], shape (n,).
        angles: Steepest angle by beta and gamma [deg], shape (n, n).
        right: Its direction, likewise [rad].
        told: The direction that the equation gives, likewise [rad].
        path: Picture file (`drawing`).
    """
    with drawing(path, (6.0, 6.0)) as figure:
        axes = figure.subplots()
        lines = axes.contour(tilts, tilts, angles, levels=np.arange(5.0, 45.0, 5.0), colors=style.FAINT, linewidths=1.2)
        axes.clabel(lines, fontsize=8, fmt="%d°", colors=style.QUIET)
        every = slice(EVERY // 2, None, EVERY)
        places = np.meshgrid(tilts[every], tilts[every])
        looks = ((right, style.QUIET, 0.009, "uphill"), (told, style.ALERT, 0.003, "by arctan of equation 6"))
        for directions, colour, width, name in looks:
            eta = directions[every, every]
            axes.quiver(
                *places, np.cos(eta), np.sin(eta), color=colour, width=width, scale=13.0, headwidth=3.0, headlength=3.5,
                headaxislength=3.2, label=name,
            )  # fmt: skip
        room = 1.15 * float(tilts[-1])
        axes.set(xlabel="gamma [deg]", ylabel="beta [deg]", aspect="equal", xlim=(-room, room), ylim=(-room, room))
        axes.set_title("Steepest angle of the plate (contours), and which way is up in it", fontsize=9.5)
        figure.legend(loc="outside lower center", ncols=2, fontsize=8)


MM: Final = 1e3
CURVE_POINTS: Final = 4000
"""Points of a curve, about."""


def draw_levelling(
    level: Mapping[str, WalkRun], tilted: Mapping[str, WalkRun], *, within: float, path: str | Path
) -> None:
    """Draw the plate's tilt and the margin of balance by the way that the plate has gone, a column for each walk.

    Args:
        level: Name -> walk with the plate kept level.
        tilted: The same names -> walks with the plate as the slope.
        within: What counts as level [deg].
        path: Picture file (`drawing`).
    """
    with drawing(path, (3.6 * len(level), 4.6)) as figure:
        grid = figure.subplots(2, len(level), sharex=True, sharey="row", squeeze=False)
        for (name, run), above, below in zip(level.items(), *grid, strict=True):
            way, tilts, margins = _course(run)
            above.plot(way, tilts, color=style.PARTS[0], lw=0.9)
            above.axhline(within, color=style.ALERT, lw=0.9, ls=(0, (4, 3)))
            above.set_title(name, fontsize=9.5)
            below.plot(way, margins, color=style.PARTS[0], lw=0.9, label="level")
            way, _, margins = _course(tilted[name])
            below.plot(way, margins, color=style.PARTS[1], lw=0.9, label="as the slope")
            below.axhline(0.0, color=style.ALERT, lw=0.9)
            below.set_xlabel("way of the plate [m]")
            for axes in (above, below):
                style.ruled(axes, "y")
        grid[0, 0].set_ylim(bottom=0.0)
        grid[0, 0].set_ylabel("tilt, level [deg]")
        grid[1, 0].set_ylabel("margin of balance [mm]")
        grid[1, 0].legend(fontsize=8)


def _course(run: WalkRun) -> tuple[Floats, Floats, Floats]:
    """Way [m], tilt [deg] and margin [mm] from the first step on; peaks are kept, samples between them are not all."""
    true, rows = run.true, run.walking
    pose, tilts = true.pose[rows, :2], true.tilts[rows] / DEGREE
    way = np.hypot(*(pose - pose[:1]).T)
    margins = true.margins[rows] * MM
    margins[~np.isfinite(margins)] = np.nan
    gap = max(1, len(way) // CURVE_POINTS)
    starts = np.arange(0, len(way), gap)
    return way[starts], np.maximum.reduceat(tilts, starts), np.minimum.reduceat(margins, starts)


WAY_POINTS: Final = 2000
"""Points of a way, about."""
HEADING: Final = 0.08
"""Length of a heading's mark [m]."""


def draw_paths(runs: Mapping[str, WalkRun], centres: Mapping[str, tuple[float, float]], path: str | Path) -> None:
    """Draw the ways of the Delta-frame's origin, with its heading at the end.

    Args:
        runs: Name -> walk.
        centres: Name -> point that it turned about, where it did, in the Delta-frame at the start [m].
        path: Picture file (`drawing`).
    """
    with drawing(path, (6.2, 5.2)) as figure:
        axes = figure.add_subplot()
        for k, (name, run) in enumerate(runs.items()):
            poses = run.true.pose[run.walking][:, [0, 1, 3]]
            if not len(poses):
                continue
            shown = poses[np.unique(np.linspace(0, len(poses) - 1, WAY_POINTS).astype(int))]
            colour, dashes = style.PARTS[k % len(style.PARTS)], "-" if k < len(style.PARTS) else "--"
            axes.plot(shown[:, 0], shown[:, 1], color=colour, ls=dashes, lw=1.3, label=name)
            x, y, heading = poses[-1]
            axes.plot((x, x + HEADING * np.cos(heading)), (y, y + HEADING * np.sin(heading)), color=colour, lw=2.4)
            if name in centres:
                axes.plot(*centres[name], marker="+", ms=9, mew=1.6, color=colour)
        axes.set_aspect("equal", adjustable="datalim")
        axes.set(xlabel="x [m]", ylabel="y [m]")
        style.ruled(axes)
        figure.legend(loc="outside right upper", fontsize=8)
