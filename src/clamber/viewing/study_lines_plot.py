"""Lines or points of a few curves over a common axis, a panel each group: the pictures of studies that need no more."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from ..types import Floats
from . import style
from .output import drawing

ACROSS: Final = 3
"""Most panels in one row; more come two by two."""


@dataclass(frozen=True, slots=True, eq=False)
class Points:
    """A curve."""

    x: Sequence[float] | Floats
    y: Sequence[float] | Floats
    marked: bool = False
    """Whether it is drawn as points without a line."""
    dashed: bool = False


def draw_panels(
    panels: Mapping[str, Mapping[str, Points]], axes_labels: tuple[str, str], title: str, path: str | Path
) -> None:
    """Draw one panel for each group of curves, with a common scale; the same label has the same colour in all.

    Args:
        panels: Panel's title -> label -> curve.
        axes_labels: Of the x and the y axis.
        title: Of the picture.
        path: Picture file (`drawing`).
    """
    labels = list(dict.fromkeys(label for curves in panels.values() for label in curves))
    colours = dict(zip(labels, style.PARTS, strict=False))
    columns = len(panels) if len(panels) <= ACROSS else 2
    rows = -(-len(panels) // columns)
    with drawing(path, (1.6 + (4.0 if columns < 3 else 3.2) * columns, 0.8 + 3.2 * rows)) as figure:
        grid = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
        for axes, (name, curves) in zip(grid.flat, panels.items(), strict=False):
            for label, curve in curves.items():
                if curve.marked:
                    axes.scatter(curve.x, curve.y, s=18, color=colours[label], alpha=0.7, linewidths=0, label=label)
                else:
                    axes.plot(
                        curve.x, curve.y, color=colours[label], lw=1.6, ls="--" if curve.dashed else "-", label=label
                    )
            axes.set_title(name, fontsize=9.5)
            style.ruled(axes)
        for axes in grid.flat[len(panels) :]:
            axes.set_visible(False)
        for axes in grid[-1]:
            axes.set_xlabel(axes_labels[0])
        for axes in grid[:, 0]:
            axes.set_ylabel(axes_labels[1])
        lines = {line.get_label(): line for axes in grid.flat for line in axes.get_legend_handles_labels()[0]}
        if lines:
            figure.legend(handles=[*lines.values()], loc="outside lower center", ncols=min(len(lines), 3), fontsize=8.5)
        style.entitle(figure, title)


def draw_angle_errors(inclined: Floats, errors: Mapping[str, Sequence[float]], path: str | Path) -> None:
    """Draw one point for each stance and rule.

    Args:
        inclined: Of the line between the holds at each stance [deg].
        errors: Rule -> RMS error of its angle there [deg].
        path: Picture file (`drawing`).
    """
    with drawing(path, (6.4, 4.2)) as figure:
        axes = figure.subplots()
        for (rule, found), colour, marker in zip(errors.items(), style.PARTS, ("o", "s"), strict=False):
            axes.scatter(inclined, found, s=16, color=colour, marker=marker, alpha=0.6, linewidths=0, label=rule)
        axes.set(yscale="log", xlim=(-2.0, 92.0), xticks=range(0, 91, 15))
        axes.set_xlabel("inclination of the line between the two holds [deg]")
        axes.set_ylabel("RMS error of the angle [deg]")
        style.ruled(axes)
        axes.legend(fontsize=8.5, loc="upper left")
        style.entitle(figure, "The body's angle from two limbs")
