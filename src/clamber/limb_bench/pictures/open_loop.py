"""Pictures of the open loop: paths of the tip under steady torques, and how far its first motion is off in every direction."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from ...types import Floats
from ...viewing.law_colours import LAW_COLOURS, WANTED
from ...viewing.output import drawing
from ..open_loop import OpenLoopResult, OpenLoopRun
from .panels import MM, dress, legend_below, study_title

NEAR: Final = 10.0
"""Way of the close view [mm]."""


class Drawn(NamedTuple):
    """A run, its label and how it is drawn."""

    label: str
    run: OpenLoopRun
    line: Any = "-"
    width: float = 1.8


def draw_open_loop(columns: Mapping[str, Sequence[Drawn]], far: float, title: str, path: str | Path) -> None:
    """Draw paths of the tip, the wanted direction downwards: up to `far` to scale, and the first centimetre stretched across.

    Args:
        columns: Heading -> paths.
        far: How far along the wanted direction [mm].
        title: Of the picture.
        path: A file (.png, .svg, .pdf).
    """
    with drawing(path, (9.2 if len(columns) > 1 else 6.4, 4.6)) as figure:
        grid = figure.subplots(1, 2 * len(columns), squeeze=False)[0]
        for views, reach in ((grid[::2], far), (grid[1::2], NEAR)):
            low, high = _sides([shown.run for paths in columns.values() for shown in paths], reach)
            for axes, (name, paths) in zip(views, columns.items(), strict=True):
                for shown in paths:
                    across, along = _as_far_as(shown.run, reach)
                    axes.plot(
                        across, -along, color=LAW_COLOURS[shown.run.transform], ls=shown.line, lw=shown.width,
                        label=shown.label,
                    )  # fmt: skip
                axes.plot([0, 0], [0, -reach], color=WANTED, lw=0.7, zorder=0.5)
                axes.set_xlim(low, high)
                axes.set_ylim(-reach, 0.03 * reach)
                dress(axes, grid=0.6)
                if reach == far:
                    axes.set_aspect("equal", anchor="N")
                    axes.set_title(f"{name}, to scale", fontsize=9.5)
                    axes.set_xlabel("across [mm]")
                else:
                    axes.set_title(f"{name}, first {reach:g} mm", fontsize=9.5)
                    axes.set_xlabel("across, stretched [mm]")
        grid[0].set_ylabel("along the wanted direction [mm]")
        study_title(figure, title)
        legend_below(figure, grid[0], 5, handlelength=3.2)


def draw_open_loop_result(result: OpenLoopResult, path: str | Path) -> None:
    """Draw the paths of one limb's tip, every transform in the colour of its law."""
    lines = ("-", "-", (0, (4, 1.5)), (0, (1, 1)))
    drawn = [Drawn(run.transform, run, lines[k % 4], 2.2 - 0.3 * (k % 4)) for k, run in enumerate(result.runs)]
    # as far as any transform gets, to a tenth of a metre at most
    far = min(100.0, max(10.0, *(float(run.along.max()) * MM for run in result.runs)))
    kind = "torques that follow the pose" if result.renewed else "steady torques"
    title = f"Open loop: {kind}, {result.runs[0].force:g} N along {math.degrees(result.direction):g} deg"
    draw_open_loop({f"{result.limb.robot.name}, {result.limb.name}": drawn}, far, title, path)


def _as_far_as(run: OpenLoopRun, reach: float) -> tuple[Floats, Floats]:
    """Ways across and along the wanted direction up to `reach` along it [mm]."""
    along, across = run.along * MM, run.across * MM
    end = int(np.argmax(along > reach)) + 1 if along.max() > reach else len(along)
    return across[:end], along[:end]


def _sides(runs: Sequence[OpenLoopRun], reach: float) -> tuple[float, float]:
    """Limits of an axis that shows all ways across, with some room."""
    ways = np.concatenate([_as_far_as(run, reach)[0] for run in runs])
    room = 0.06 * float(np.ptp(ways))
    return float(ways.min()) - room, float(ways.max()) + room


def draw_turns(
    directions: Floats, turns: Mapping[str, Mapping[str, Floats]], names: Mapping[str, str], path: str | Path
) -> None:
    """Draw how far the first motion is off the wanted direction, for every direction.

    Args:
        directions: From the x axis, shape (n,) [rad].
        turns: Name of a law -> branch -> angle off, anticlockwise positive, shape (n,) [deg].
        names: Name of a law -> its label.
        path: A file (.png, .svg, .pdf).
    """
    lines = ("-", (0, (4, 1.5)))
    with drawing(path, (7.6, 4.0)) as figure:
        axes = figure.subplots()
        for law, branches in turns.items():
            for line, (branch, values) in zip(lines, branches.items(), strict=False):
                label = f"{names[law]}, {branch}"
                axes.plot(np.degrees(directions), values, color=LAW_COLOURS[law], ls=line, lw=1.6, label=label)
        axes.axvline(math.degrees(1.5 * math.pi), color=WANTED, lw=0.8)
        axes.text(math.degrees(1.5 * math.pi) + 3, axes.get_ylim()[1], "-y", va="top", fontsize=9)
        axes.set_xlim(0.0, 360.0)
        axes.margins(y=0.08)
        axes.set_xticks(range(0, 361, 45), [f"{a}" for a in range(0, 361, 45)])
        axes.set_xlabel("wanted direction from +x [deg]")
        axes.set_ylabel("first acceleration off it [deg]")
        dress(axes, grid=0.6)
        axes.set_title("How straight each transform starts, without friction")
        figure.legend(loc="outside lower center", ncols=4, fontsize=8, handlelength=3.0)
