"""Pictures of motions of body and arm for a tool, side by side: by freedoms, and by the gain of the manipulability's gradient."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from ....types import Floats
from ....units import DEGREE
from ....viewing import style
from ....viewing.output import drawing
from ..control.cooperative.planted_feet import PlantedFeet
from ..control.cooperative.tool_chain import POSE
from .arm_and_body import draw_from_side

ALPHAS: Final = (0.35, 0.6, 1.0)
"""Of start, middle and end."""
MOTION_COLOURS: Final = (style.INK, style.PARTS[0], style.PARTS[1], style.PARTS[2])
DASHES: Final = ("-", (0, (4, 3)), "-", "-")
"""The second motion may lie on the first."""
COLOURS: Final = (style.QUIET, style.PARTS[0], style.PARTS[1], style.PARTS[2])


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """One motion as the pictures need it."""

    title: str
    footing: PlantedFeet
    q: Floats
    """Freedoms, shape (rows, m)."""
    places: Floats
    """Of the tool [m], shape (rows, 3)."""


def draw_motions(motions: Sequence[Motion], time: Floats, path: str | Path) -> None:
    """Draw start, middle and end of each motion from the side, and below how far each joint of the arm turns in all of them.

    Args:
        motions: Each with a row for each time.
        time: [s], shape (rows,).
        path: A file (.png, .svg, .pdf).

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    joints = motions[0].q.shape[1] - POSE
    with drawing(path, (12.0, 6.1)) as figure:
        above, below = figure.subfigures(2, 1, squeeze=False, height_ratios=(1.4, 1.0))[:, 0]
        sides = above.subplots(1, len(motions), sharex=True, sharey=True)
        for side, motion, colour in zip(sides, motions, MOTION_COLOURS, strict=False):
            for row, alpha in zip((0, len(motion.q) // 2, -1), ALPHAS, strict=True):
                draw_from_side(side, motion.footing, motion.q[row], alpha)
            side.plot(motion.places[:, 0], motion.places[:, 2], color=style.PARTS[0], lw=2.0)
            side.axhline(0.0, color=style.QUIET, lw=0.8)
            side.set_aspect("equal")
            side.set_title(motion.title, fontsize=9.5, color=colour)
            side.set_xlabel("x [m]")
            style.bare(side)
        sides[0].set_ylabel("height [m]")
        for joint, axes in enumerate(below.subplots(1, joints)):
            for motion, colour, dashes in zip(motions, MOTION_COLOURS, DASHES, strict=False):
                turned = (motion.q[:, POSE + joint] - motion.q[0, POSE + joint]) / DEGREE
                axes.plot(time, turned, color=colour, lw=1.8, ls=dashes)
            axes.set_title(f"$\\theta_{joint}$ from its start [deg]", fontsize=9, weight="normal")
            axes.set_xlabel("time [s]")
            axes.grid(color=style.FAINT, lw=0.6, axis="y")
            style.bare(axes)


def draw_gains(time: Floats, courses: Mapping[float, Floats], means: Mapping[int, Floats], path: str | Path) -> None:
    """Draw V over time by gain, and the mean V of random ways over that with the first gain.

    Args:
        time: [s], shape (rows,).
        courses: k_p -> V [-], shape (rows,).
        means: Degrees of freedom -> mean V by way and gain, shape (ways, gains).
        path: A file (.png, .svg, .pdf).

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    gains = list(courses)
    with drawing(path, (9.4, 3.8)) as figure:
        left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.25))
        for colour, (gain, course) in zip(COLOURS, courses.items(), strict=False):
            left.plot(time, course, color=colour, lw=1.6, label=f"$k_p$ = {gain:g}")
        left.set(xlabel="time [s]", ylabel="manipulability V [-]")
        left.legend(fontsize=8)
        rng = np.random.default_rng(0)
        for place, values in enumerate(means.values()):
            for k in range(1, len(gains)):
                ratios = values[:, k] / values[:, 0]
                at = place + 0.22 * (2 * k - len(gains)) + rng.uniform(-0.07, 0.07, len(ratios))
                right.plot(at, ratios, ".", ms=4, color=COLOURS[k], alpha=0.75)
        right.axhline(1.0, color=style.QUIET, lw=0.8)
        right.set_xticks(range(len(means)), [f"{dof} dof" for dof in means])
        right.set_ylabel(f"mean V over that with $k_p$ = {gains[0]:g} [-]")
        for axes in (left, right):
            style.bare(axes)
            axes.grid(color=style.FAINT, lw=0.6, axis="y")


def draw_freedoms(means: Floats, dofs: Sequence[int], gains: Sequence[float], path: str | Path) -> None:
    """Draw the mean V of each way over the number of freedoms.

    Args:
        means: Mean V, shape (gains, ways, sets).
        dofs: Degrees of freedom of each set.
        gains: k_p of each panel.
        path: A file (.png, .svg, .pdf).

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    with drawing(path, (9.4, 3.6)) as figure:
        for axes, gain, values in zip(figure.subplots(1, len(gains), sharey=True), gains, means, strict=True):
            for way in values:
                axes.plot(range(len(dofs)), way, color=style.PARTS[4], lw=0.6, alpha=0.6)
            axes.plot(range(len(dofs)), np.median(values, axis=0), color=style.INK, lw=2.0, marker="o", ms=4)
            axes.set_xticks(range(len(dofs)), [str(dof) for dof in dofs])
            axes.set_xlabel("degrees of freedom")
            axes.set_title(f"$k_p$ = {gain:g}", fontsize=9.5)
            style.bare(axes)
            axes.grid(color=style.FAINT, lw=0.6, axis="y")
        figure.axes[0].set_ylabel("mean V of a way [-]; median in bold")
        figure.axes[0].set_ylim(bottom=0.0)
