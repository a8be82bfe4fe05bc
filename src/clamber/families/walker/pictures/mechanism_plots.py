"""What a two-frame mechanism can do: regions and their areas, the widest ditches, a crossing stance after stance."""

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
from ..robot.ditch_plan import Crossing, stances
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
        path: Picture file (`drawing`).
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
        style.entitle(figure, "Where the Y-frame's origin can be in the Delta-frame, by the angle between the frames")


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
        path: Picture file (`drawing`).
    """
    with drawing(path, (7.2, 3.8)) as figure:
        axes = figure.subplots()
        looks = ((style.QUIET, "-"), (style.QUIET, (0, (4, 2))), (FREE, "-"), (GUARDED, "-"))
        for (name, values), (colour, dash) in zip(areas.items(), looks, strict=False):
            axes.plot(thetas, values, color=colour, ls=dash, lw=1.8, label=name)
        axes.set(xlabel="angle of the Y-frame in the Delta-frame [deg]", ylabel="area of the region [cm²]")
        axes.set_ylim(bottom=0.0)
        axes.set_title("How large the region is")
        axes.legend(fontsize=8)
        style.ruled(axes, behind=True)


DELTA, Y = style.PARTS[0], style.PARTS[1]


def draw_ditch_maps(
    thetas: Sequence[float], directions: Sequence[float], maps: Mapping[str, Floats], path: str | Path
) -> None:
    """Draw the widest ditch by angle and direction, a panel for each map.

    Args:
        thetas: Angles of the frames [deg], shape (n,).
        directions: Of crossing [deg], shape (m,).
        maps: Title -> widths [mm], shape (n, m).
        path: Picture file (`drawing`).
    """
    top = max(float(widths.max()) for widths in maps.values())
    with drawing(path, (4.6 * len(maps) + 0.8, 4.2)) as figure:
        row = figure.subplots(1, len(maps), sharey=True, squeeze=False)[0]
        for axes, (title, widths) in zip(row, maps.items(), strict=True):
            shown = axes.pcolormesh(directions, thetas, widths, cmap="viridis", vmin=0.0, vmax=top, shading="nearest")
            lines = axes.contour(
                directions, thetas, widths, levels=np.arange(50, top, 50), colors=style.PAPER, linewidths=0.7
            )
            axes.clabel(lines, fontsize=7, fmt="%d")
            i, j = np.unravel_index(int(np.argmax(widths)), widths.shape)
            axes.plot(directions[int(j)], thetas[int(i)], marker="o", ms=6, mfc="none", mec=style.ALERT, mew=1.6)
            axes.set_title(f"{title}: at most {widths.max():.0f} mm", fontsize=9.5)
            axes.set_xlabel("direction of crossing, in the Delta-frame [deg]")
            axes.set_xticks(range(int(directions[0]), int(directions[-1]) + 1, 30))
        row[0].set_ylabel("angle of the frames, theta [deg]")
        figure.colorbar(shown, ax=row, label="widest ditch [mm]").outline.set_visible(False)


def draw_ditch_curves(directions: Sequence[float], curves: Mapping[float, Floats], path: str | Path) -> None:
    """Draw the widest ditch by direction, a curve for each angle of the frames.

    Args:
        directions: Of crossing [deg], shape (m,).
        curves: Angle of the frames [deg] -> widths [mm], shape (m,).
        path: Picture file (`drawing`).
    """
    with drawing(path, (7.6, 3.8)) as figure:
        axes = figure.subplots()
        for (theta, widths), colour in zip(curves.items(), style.PARTS, strict=False):
            axes.plot(directions, widths, color=colour, lw=1.5, label=f"theta = {theta:g}°")
        axes.set(xticks=range(0, 361, 30), xlim=(0, 360))
        axes.set_ylim(bottom=0.0)
        axes.set(xlabel="direction of crossing, in the Delta-frame [deg]", ylabel="widest ditch [mm]")
        axes.set_title("The widest ditch repeats every 60°")
        style.ruled(axes, behind=True)
        figure.legend(loc="outside lower center", ncols=len(curves), fontsize=8)


def draw_crossing(crossing: Crossing, path: str | Path) -> None:
    """Draw the stance at the start and after every slide, seen from above; the frame that slid is filled.

    Args:
        crossing: One that was found.
        path: Picture file (`drawing`).
    """
    shown = stances(crossing.start, crossing.slides)
    slid = (-1, *(slide.frame for slide in crossing.slides))
    feet = np.array([crossing.footing.feet_at(poses) for poses in shown])
    low, high = feet.reshape(-1, 2).min(axis=0) - 0.05, feet.reshape(-1, 2).max(axis=0) + 0.05
    rows = math.ceil(len(shown) / COLUMNS)
    wide = 2.6
    tall = wide * float((high[1] - low[1]) / (high[0] - low[0]))
    with drawing(path, (wide * COLUMNS, (tall + 0.3) * rows + 0.5)) as figure:
        grid = figure.subplots(rows, COLUMNS, squeeze=False)
        for axes in grid.flat:
            axes.set_axis_off()
        for k, (axes, frame, poses) in enumerate(zip(grid.flat, slid, shown, strict=False)):
            _stance(axes, crossing, frame, poses)
            axes.set(xlim=(low[0] * MM, high[0] * MM), ylim=(low[1] * MM, high[1] * MM), aspect="equal")
            words = (
                "start" if k == 0 else f"{k}: {('Delta', 'Y')[frame]} {'pivots' if k <= crossing.pivots else 'slides'}"
            )
            axes.set_title(words, fontsize=8.5, weight="normal")
        style.entitle(
            figure,
            f"A ditch of {crossing.width * MM:g} mm: {crossing.pivots} pivots, "
            f"{len(crossing.slides) - crossing.pivots} slides (blue: Delta-frame, orange: Y-frame, dot: centre of mass)",
            size=10,
        )


def _stance(axes: Axes, crossing: Crossing, frame: int, poses: Floats) -> None:
    footing = crossing.footing
    axes.axvspan(0.0, crossing.width * MM, color="#E7DCCB", lw=0, zorder=0)
    for k, (feet, colour) in enumerate(zip(footing.feet_at(poses) * MM, (DELTA, Y), strict=True)):
        slid = k == frame
        axes.fill(*feet.T, fc=colour if slid else "none", ec=colour, alpha=0.25 if slid else 1.0, lw=1.2, zorder=2)
        axes.fill(*feet.T, fc="none", ec=colour, lw=1.2, zorder=3)
        axes.plot(*feet.T, ls="none", marker="o", ms=4, color=colour, zorder=4)
    centre = footing.weight.centre(poses) * MM
    axes.plot(*centre, marker="o", ms=4, color=style.INK, zorder=5)
