"""A picture of limit cycles: how far the body moves to and fro, by stiffness, backlash and play."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.lines import Line2D

from ....viewing import style
from ....viewing.output import drawing

LEAST: Final = 0.01
"""Smaller motion is drawn as this [mm]."""
DASHES: Final = ("-", (0, (5, 1.6)), (0, (1, 1.2)))
"""One for each play."""


def draw_onsets(
    gains: Sequence[float],
    swings: Mapping[tuple[str, str, float, str], Sequence[float]],
    cycle: float,
    path: str | Path,
) -> None:
    """Draw one panel for each way to tell the body's place.

    Args:
        gains: Kpx.
        swings: Held, place by, backlash [deg], play -> peak to peak along x at each of them [mm].
        cycle: From which on the body counts as cycling [mm].
        path: A file (.png, .svg, .pdf).

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    places = list(dict.fromkeys(place for _, place, _, _ in swings))
    colours = dict(zip(dict.fromkeys(b for _, _, b, _ in swings), style.PARTS, strict=False))
    dashes = dict(zip(dict.fromkeys(p for _, _, _, p in swings), DASHES, strict=False))
    with drawing(path, (4.4 * len(places), 4.4)) as figure:
        grid = figure.subplots(1, len(places), sharex=True, sharey=True, squeeze=False)[0]
        for axes, place in zip(grid, places, strict=True):
            axes.axhline(cycle, color=style.ALERT, lw=0.8)
            for (_, each, backlash, play), found in swings.items():
                if each == place:
                    values = np.maximum(found, LEAST)
                    axes.plot(gains, values, color=colours[backlash], ls=dashes[play], lw=1.5, marker="o", ms=2.5)
            axes.set_xscale("log")
            axes.set_yscale("log")
            axes.set_title(f"place by {place}", fontsize=9.5)
            axes.set_xlabel("Kpx")
            style.bare(axes)
            axes.grid(color=style.FAINT, lw=0.6)
        grid[0].set_ylabel("left to and fro along x [mm]")
        handles = [Line2D([], [], color=colour, label=f"backlash {b:g} deg") for b, colour in colours.items()]
        handles += [Line2D([], [], color=style.QUIET, ls=dash, label=f"play {p}") for p, dash in dashes.items()]
        figure.legend(handles=handles, loc="outside lower center", ncols=3, fontsize=8, handlelength=3.2)
        figure.suptitle("From which stiffness on the body cycles", x=0.01, ha="left", fontsize=11, fontweight="bold")
