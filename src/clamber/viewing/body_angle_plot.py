"""A picture of two rules for the body's angle: how far each is off, by how steep the line between the two holds is."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from ..types import Floats
from . import style
from .output import drawing


def draw_angle_errors(inclined: Floats, errors: Mapping[str, Sequence[float]], path: str | Path) -> None:
    """Draw one point for each stance and rule.

    Args:
        inclined: Of the line between the holds at each stance [deg].
        errors: Rule -> RMS error of its angle there [deg].
        path: A file (.png, .svg, .pdf).

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    with drawing(path, (6.4, 4.2)) as figure:
        axes = figure.subplots()
        for (rule, found), colour, marker in zip(errors.items(), style.PARTS, ("o", "s"), strict=False):
            axes.scatter(inclined, found, s=16, color=colour, marker=marker, alpha=0.6, linewidths=0, label=rule)
        axes.set_yscale("log")
        axes.set_xlim(-2.0, 92.0)
        axes.set_xticks(range(0, 91, 15))
        axes.set_xlabel("inclination of the line between the two holds [deg]")
        axes.set_ylabel("RMS error of the angle [deg]")
        axes.grid(color=style.FAINT, lw=0.6)
        style.bare(axes)
        axes.legend(fontsize=8.5, loc="upper left")
        figure.suptitle("The body's angle from two limbs", x=0.01, ha="left", fontsize=11, fontweight="bold")
