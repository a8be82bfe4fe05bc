"""Ditches as pictures: the widest by angle and direction, and a crossing, stance after stance."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.axes import Axes

from ....types import Floats
from ....viewing import style
from ....viewing.output import drawing
from ..robot.ditch_plan import Crossing

MM: Final = 1e3
DELTA, Y = style.PARTS[0], style.PARTS[1]
COLUMNS: Final = 4


def draw_ditch_maps(
    thetas: Sequence[float], directions: Sequence[float], maps: Mapping[str, Floats], path: str | Path
) -> None:
    """Draw the widest ditch by angle and direction, a panel for each map.

    Args:
        thetas: Angles of the frames [deg], shape (n,).
        directions: Of crossing [deg], shape (m,).
        maps: Title -> widths [mm], shape (n, m).
        path: A file (.png, .svg, .pdf).

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
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
        path: A file (.png, .svg, .pdf).

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    with drawing(path, (7.6, 3.8)) as figure:
        axes = figure.subplots()
        for (theta, widths), colour in zip(curves.items(), style.PARTS, strict=False):
            axes.plot(directions, widths, color=colour, lw=1.5, label=f"theta = {theta:g}°")
        axes.set_xticks(range(0, 361, 30))
        axes.set_xlim(0, 360)
        axes.set_ylim(bottom=0.0)
        axes.set_xlabel("direction of crossing, in the Delta-frame [deg]")
        axes.set_ylabel("widest ditch [mm]")
        axes.set_title("The widest ditch repeats every 60°")
        axes.grid(color=style.FAINT, lw=0.6)
        axes.set_axisbelow(True)
        style.bare(axes)
        figure.legend(loc="outside lower center", ncols=len(curves), fontsize=8)


def draw_crossing(crossing: Crossing, path: str | Path) -> None:
    """Draw the stance at the start and after every slide, seen from above; the frame that slid is filled.

    Args:
        crossing: One that was found.
        path: A file (.png, .svg, .pdf).

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    stances = [(-1, crossing.start.copy())]
    for slide in crossing.slides:
        poses = stances[-1][1].copy()
        poses[slide.frame] = slide.way[-1]
        stances.append((slide.frame, poses))
    feet = np.array([crossing.footing.feet_at(poses) for _, poses in stances])
    low, high = feet.reshape(-1, 2).min(axis=0) - 0.05, feet.reshape(-1, 2).max(axis=0) + 0.05
    rows = math.ceil(len(stances) / COLUMNS)
    wide = 2.6
    tall = wide * float((high[1] - low[1]) / (high[0] - low[0]))
    with drawing(path, (wide * COLUMNS, (tall + 0.3) * rows + 0.5)) as figure:
        grid = figure.subplots(rows, COLUMNS, squeeze=False)
        for axes in grid.flat:
            axes.set_axis_off()
        for k, (axes, (frame, poses)) in enumerate(zip(grid.flat, stances, strict=False)):
            _stance(axes, crossing, frame, poses)
            axes.set(xlim=(low[0] * MM, high[0] * MM), ylim=(low[1] * MM, high[1] * MM), aspect="equal")
            words = (
                "start" if k == 0 else f"{k}: {('Delta', 'Y')[frame]} {'pivots' if k <= crossing.pivots else 'slides'}"
            )
            axes.set_title(words, fontsize=8.5, weight="normal")
        figure.suptitle(
            f"A ditch of {crossing.width * MM:g} mm: {crossing.pivots} pivots, "
            f"{len(crossing.slides) - crossing.pivots} slides (blue: Delta-frame, orange: Y-frame, dot: centre of mass)",
            x=0.01, ha="left", fontsize=10, weight="bold",
        )  # fmt: skip


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
