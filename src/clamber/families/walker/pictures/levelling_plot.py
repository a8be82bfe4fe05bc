"""Walks with the plate kept level, beside the same walks without: tilt and margin of balance along the way."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np

from ....types import Floats
from ....units import DEGREE
from ....viewing import style
from ....viewing.output import drawing
from ..trials.run_walk import WalkRun

MM: Final = 1e3
FEW: Final = 4000
"""Points of a curve, about."""


def draw_levelling(
    level: Mapping[str, WalkRun], tilted: Mapping[str, WalkRun], *, within: float, path: str | Path
) -> None:
    """Draw the plate's tilt and the margin of balance by the way that the plate has gone, a column for each walk.

    Args:
        level: Name -> walk with the plate kept level.
        tilted: The same names -> walks with the plate as the slope.
        within: What counts as level [deg].
        path: A file (.png, .svg, .pdf).

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
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
                style.bare(axes)
                axes.grid(color=style.FAINT, lw=0.6, axis="y")
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
    gap = max(1, len(way) // FEW)
    starts = np.arange(0, len(way), gap)
    return way[starts], np.maximum.reduceat(tilts, starts), np.minimum.reduceat(margins, starts)
