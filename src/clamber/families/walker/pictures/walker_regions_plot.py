"""Regions of a two-frame mechanism as pictures: exact arcs at one angle after another, and their areas."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Patch, PathPatch
from matplotlib.path import Path as Outline

from ....types import Floats
from ....units import DEGREE
from ....viewing import style
from ....viewing.output import drawing
from ..robot.curves import INSIDE
from ..robot.geometry import TwoFrames
from ..robot.workspace import Part, best_directions, stride, workspace

MM: Final = 1e3
STROKES: Final = "#DCE6EE"
FREE: Final = "#8FBCD9"
GUARDED: Final = style.PARTS[0]
COLUMNS: Final = 4


def draw_regions(frames: TwoFrames, thetas: Sequence[float], path: str | Path) -> None:
    """Draw a panel for each angle: all that the strokes allow, the part without singular poses, and what the guard leaves.

    Args:
        frames: The mechanism.
        thetas: Angles of the Y-frame in the Delta-frame [deg].
        path: A file (.png, .svg, .pdf).

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    rows = math.ceil(len(thetas) / COLUMNS)
    with drawing(path, (2.35 * COLUMNS, 2.5 * rows + 0.7)) as figure:
        grid = figure.subplots(rows, COLUMNS, sharex=True, sharey=True, squeeze=False)
        for axes in grid.flat[len(thetas) :]:
            axes.set_visible(False)
        for axes, theta in zip(grid.flat, thetas, strict=False):
            _panel(axes, frames, theta)
        for axes in grid[:, 0]:
            axes.set_ylabel("y [mm]")
        for axes in grid[-1]:
            axes.set_xlabel("x [mm]")
        handles: list[Artist] = [
            Patch(fc=STROKES, ec=style.QUIET, lw=0.6, label="strokes alone"),
            Patch(fc=FREE, ec=style.QUIET, lw=0.6, label="and short of a singular pose"),
            Patch(fc=GUARDED, ec=style.QUIET, lw=0.6, label=f"within {frames.guard:g} of the singular distance"),
            Line2D([], [], color=style.ALERT, lw=1.0, ls=(0, (4, 3)), label="singular"),
        ]
        figure.legend(handles=handles, loc="outside lower center", ncols=4, fontsize=8)
        figure.suptitle(
            "Where the Y-frame's origin can be in the Delta-frame, by the angle between the frames",
            x=0.01, ha="left", fontsize=11, weight="bold",
        )  # fmt: skip


def _panel(axes: Axes, frames: TwoFrames, theta: float) -> None:
    space = workspace(frames, theta * DEGREE)
    for part in space.parts:
        axes.add_patch(_filled(part, STROKES))
    singular = workspace(frames, theta * DEGREE, guard=1.0)
    guarded = workspace(frames, theta * DEGREE, guard=frames.guard)
    for region, colour in ((singular, FREE), (guarded, GUARDED)):
        if region.central is not None:
            axes.add_patch(_filled(region.central, colour))
    kind, x, y, radius = singular.curves[-1][:4]
    if kind == INSIDE and len(singular.curves) > 6:
        axes.add_patch(Circle((x * MM, y * MM), radius * MM, fill=False, ec=style.ALERT, lw=1.0, ls=(0, (4, 3))))
    directions, _ = best_directions(frames, theta * DEGREE, guard=frames.guard)
    step = stride(frames, theta * DEGREE, directions[0], guard=frames.guard)
    ends = np.array([-step.back, step.ahead])[:, None] * (math.cos(directions[0]), math.sin(directions[0])) * MM
    axes.plot(*ends.T, color=style.PAPER, lw=1.2)
    axes.plot(0, 0, marker="+", ms=6, color=style.INK)
    axes.set_aspect("equal")
    axes.set(xlim=(-310, 310), ylim=(-310, 310))
    area = space.area * 1e4
    axes.set_title(f"theta = {theta:g}°", fontsize=9.5)
    axes.text(
        0.03, 0.97, f"{area:.0f} cm²" if area >= 10 else f"{area:.1f} cm²", transform=axes.transAxes, va="top",
        fontsize=7.5, color=style.QUIET,
    )  # fmt: skip
    style.bare(axes)


def _filled(part: Part, colour: str) -> PathPatch:
    corners: list[Floats] = []
    codes: list[int] = []
    for loop in part.loops:
        points = np.vstack([arc.points() for arc in loop]) * MM
        corners += [points, points[:1]]
        codes += [int(Outline.MOVETO), *[int(Outline.LINETO)] * (len(points) - 1), int(Outline.CLOSEPOLY)]
    return PathPatch(Outline(np.vstack(corners), codes), fc=colour, ec=style.QUIET, lw=0.5)


def draw_areas(thetas: Sequence[float], areas: Mapping[str, Floats], path: str | Path) -> None:
    """Draw areas by the angle between the frames.

    Args:
        thetas: Angles [deg], shape (n,).
        areas: What they are of -> areas [cm^2], shape (n,).
        path: A file (.png, .svg, .pdf).

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    with drawing(path, (7.2, 3.8)) as figure:
        axes = figure.subplots()
        looks = ((style.QUIET, "-"), (style.QUIET, (0, (4, 2))), (FREE, "-"), (GUARDED, "-"))
        for (name, values), (colour, dash) in zip(areas.items(), looks, strict=False):
            axes.plot(thetas, values, color=colour, ls=dash, lw=1.8, label=name)
        axes.set_xlabel("angle of the Y-frame in the Delta-frame [deg]")
        axes.set_ylabel("area of the region [cm²]")
        axes.set_ylim(bottom=0.0)
        axes.set_title("How large the region is")
        axes.legend(fontsize=8)
        axes.grid(color=style.FAINT, lw=0.6)
        axes.set_axisbelow(True)
        style.bare(axes)
