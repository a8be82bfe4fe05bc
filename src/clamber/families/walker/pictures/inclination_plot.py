"""Inclinations as pictures: a plate that is inclined one way after another, and where the steepest direction is told wrongly."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.axes import Axes

from ....types import Floats
from ....viewing import style
from ....viewing.output import drawing

AXES: Final = ("along x", "along y")
MOVING: Final = "#EEF1F4"
"""Colour of times at which legs move."""
EVERY: Final = 8
"""Of the tilts, that have an arrow."""


@dataclass(frozen=True, slots=True, eq=False)
class Course:
    """Inclines over time."""

    time: Floats
    """[s], shape (rows,)."""
    wanted: Floats
    """How far the plate's axes are to rise [deg], shape (rows, 2)."""
    read: Floats
    """As inclinometers read it, likewise."""
    true: Floats
    """As it is, likewise."""
    moves: Sequence[tuple[float, float]]
    """Times between which legs move [s]."""


def draw_inclining(courses: Mapping[str, Course], *, within: float, path: str | Path) -> None:
    """Draw what is wanted and read, and below it the plate's true error.

    Args:
        courses: Title -> course; a column each.
        within: Error that is allowed at rest [deg].
        path: A file (.png, .svg, .pdf).

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
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


def _draw_inclines(axes: Axes, course: Course) -> None:
    _shade(axes, course)
    for k, (name, colour) in enumerate(zip(AXES, style.PARTS, strict=False)):
        axes.plot(course.time, course.read[:, k], color=colour, lw=1.2, label=f"read {name}")
        axes.plot(course.time, course.wanted[:, k], color=style.INK, lw=0.7, ls=(0, (4, 2)))
    style.bare(axes)


def _draw_error(axes: Axes, course: Course, within: float) -> None:
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


def _shade(axes: Axes, course: Course) -> None:
    for begin, arrive in course.moves:
        axes.axvspan(begin, arrive, color=MOVING, lw=0, zorder=0)


def draw_directions(tilts: Floats, angles: Floats, right: Floats, told: Floats, path: str | Path) -> None:
    """Draw the steepest angle over the plate's tilt, and arrows uphill: where it is, and where an equation says it is.

    Args:
        tilts: beta and gamma that are looked at [deg], shape (n,).
        angles: Steepest angle by beta and gamma [deg], shape (n, n).
        right: Its direction, likewise [rad].
        told: The direction that the equation gives, likewise [rad].
        path: A file (.png, .svg, .pdf).

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
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
