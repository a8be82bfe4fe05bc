"""Walks from above: the way of each robot's plate, as it truly was, all from one start."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np

from ....viewing import style
from ....viewing.output import drawing
from ..trials.run_walk import WalkRun

FEW: Final = 2000
"""Points of a way, about."""
HEADING: Final = 0.08
"""Length of the mark of a heading [m]."""


def draw_paths(runs: Mapping[str, WalkRun], centres: Mapping[str, tuple[float, float]], path: str | Path) -> None:
    """Draw the ways of the Delta-frame's origin, with its heading at the end.

    Args:
        runs: Name -> walk.
        centres: Name -> point that it turned about, where it did, in the Delta-frame at the start [m].
        path: A file (.png, .svg, .pdf).

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    with drawing(path, (6.2, 5.2)) as figure:
        axes = figure.add_subplot()
        for k, (name, run) in enumerate(runs.items()):
            poses = run.true.pose[run.walking][:, [0, 1, 3]]
            if not len(poses):
                continue
            shown = poses[np.unique(np.linspace(0, len(poses) - 1, FEW).astype(int))]
            colour, dashes = style.PARTS[k % len(style.PARTS)], "-" if k < len(style.PARTS) else "--"
            axes.plot(shown[:, 0], shown[:, 1], color=colour, ls=dashes, lw=1.3, label=name)
            x, y, heading = poses[-1]
            axes.plot((x, x + HEADING * np.cos(heading)), (y, y + HEADING * np.sin(heading)), color=colour, lw=2.4)
            if name in centres:
                axes.plot(*centres[name], marker="+", ms=9, mew=1.6, color=colour)
        axes.set_aspect("equal", adjustable="datalim")
        axes.set_xlabel("x [m]")
        axes.set_ylabel("y [m]")
        axes.grid(color=style.FAINT, lw=0.6)
        style.bare(axes)
        figure.legend(loc="outside right upper", fontsize=8)
