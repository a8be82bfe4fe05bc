"""Curves of single joints on several plants, one panel a joint."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final, NamedTuple

from ...types import Floats
from ...viewing import style
from ...viewing.output import drawing

LOOKS: Final[tuple[dict[str, Any], ...]] = (
    {"color": style.BODY, "lw": 4.0, "ls": "-"},
    {"color": style.PARTS[0], "lw": 1.4, "ls": "-"},
    {"color": style.PARTS[1], "lw": 1.1, "ls": (0, (3, 1.5))},
)
"""Of the first, second and third plant."""


class JointCurves(NamedTuple):
    """One panel."""

    title: str
    note: str
    time: Floats
    """Shape (ticks,) [s]."""
    curves: Mapping[str, Floats]
    """Plant -> values, shape (ticks,)."""


def draw_joint_curves(panels: Sequence[JointCurves], quantity: str, title: str, path: str | Path) -> None:
    """Draw three panels a row, each with the same plants.

    Args:
        panels: In order.
        quantity: Label of the vertical axes, with its unit.
        title: Of the picture.
        path: A file (.png, .svg, .pdf).

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    rows = -(-len(panels) // 3)
    with drawing(path, (8.6, 2.3 * rows + 0.6)) as figure:
        grid = figure.subplots(rows, 3, sharex=True, sharey=True, squeeze=False)
        for axes, panel in zip(grid.flat, panels, strict=False):
            for look, (plant, values) in zip(LOOKS, panel.curves.items(), strict=False):
                axes.plot(panel.time, values, label=plant, **look)
            axes.set_title(panel.title, fontsize=9)
            axes.text(0.97, 0.06, panel.note, transform=axes.transAxes, ha="right", fontsize=8, color=style.QUIET)
            style.bare(axes)
            axes.grid(color=style.FAINT, lw=0.6)
            axes.set_axisbelow(True)
        if min(float(values.min()) for panel in panels for values in panel.curves.values()) >= 0.0:
            grid[0, 0].set_ylim(bottom=0.0)
        for axes in grid[-1]:
            axes.set_xlabel("time [s]")
        for axes in grid[:, 0]:
            axes.set_ylabel(quantity)
        figure.suptitle(title, x=0.01, ha="left", fontsize=11, fontweight="bold")
        handles, labels = grid[0, 0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=8, handlelength=3.2)
