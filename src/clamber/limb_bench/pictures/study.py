"""Pictures of laws side by side on one limb: a step, a circle, a push, by law in one colour and by matching in one line."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ...types import Floats
from ...viewing import style
from ...viewing.output import drawing
from ...viewing.style import LAW_COLOURS, MATCH_LINES, WANTED
from ..measures import Entry, Run
from .panels import MM, dress, legend_below, study_title

LOOKS: Final[tuple[dict[str, Any], ...]] = (
    {"color": style.BODY, "lw": 4.0, "ls": "-"},
    {"color": style.PARTS[0], "lw": 1.4, "ls": "-"},
    {"color": style.PARTS[1], "lw": 1.1, "ls": (0, (3, 1.5))},
)
"""Of the first, second and third plant."""


def line_of(entry: Entry) -> dict[str, Any]:
    """How a law is drawn: its own colour, and the line of the matching that its label names after a comma."""
    match = entry.label.partition(", ")[2].partition(" ")[0]
    wide = 2.0 if entry.settings.law == "scct" else 1.4
    return {"color": LAW_COLOURS[entry.settings.law], "ls": MATCH_LINES.get(match, "-"), "lw": wide}


def _offsets(run: Run, from_place: tuple[float, float]) -> Floats:
    """True tip from a place [mm], shape (ticks, 2)."""
    out: Floats = (run.trace.true_places()[:, 0, :2] - from_place) * MM
    return out


def draw_step(
    runs: Mapping[str, Sequence[Run]], start: tuple[float, float], step: float, title: str, path: str | Path
) -> None:
    """Draw a step downwards: the tip's path with x stretched, and its way off the line over time.

    Args:
        runs: Heading of a column -> runs.
        start: Where the tip starts [m].
        step: How far down it is to go [m].
        title: Of the picture.
        path: A file (.png, .svg, .pdf).
    """
    with drawing(path, (8.6, 6.6)) as figure:
        grid = figure.subplots(2, len(runs), sharex="row", sharey="row", height_ratios=(1.45, 1.0), squeeze=False)
        for column, (name, shown) in enumerate(runs.items()):
            upper, lower = grid[:, column]
            upper.plot([0, 0], [0, -step * MM], color=WANTED, lw=0.8)
            upper.plot(0, -step * MM, marker="+", ms=10, mew=1.4, color=WANTED, ls="none")
            for run in reversed(shown):
                off = _offsets(run, start)
                upper.plot(off[:, 0], off[:, 1], **line_of(run.entry))
                upper.plot(off[-1, 0], off[-1, 1], marker="o", ms=3.2, color=LAW_COLOURS[run.entry.settings.law])
                lower.plot(run.trace.time, off[:, 0], **line_of(run.entry))
            _hold_axis(upper, lower, [r for each in runs.values() for r in each], start)
            upper.set_title(name, fontsize=9.5)
            dress(upper, "x - 220 mm [mm] (stretched)", grid=0.6)
            dress(lower, "time [s]", grid=0.6)
        grid[0, 0].set_ylabel("y [mm]")
        grid[1, 0].set_ylabel("x - 220 mm [mm]")
        study_title(figure, title)
        _legend(figure, next(iter(runs.values())))


def _hold_axis(upper: Axes, lower: Axes, runs: Sequence[Run], start: tuple[float, float]) -> None:
    """Make room for every law with gains that were matched; a run with "none" may leave the picture."""
    ways = [np.abs(_offsets(run, start)[:, 0]).max() for run in runs if not run.entry.label.endswith(", none")]
    most = 1.15 * float(max(ways))
    upper.set_xlim(-most, most)
    lower.set_ylim(-most, most)


def _legend(figure: Figure, runs: Sequence[Run], columns: int = 4) -> None:
    handles = [Line2D([], [], label=run.entry.label, **line_of(run.entry)) for run in runs]
    figure.legend(handles=handles, loc="outside lower center", ncols=columns, fontsize=8, handlelength=3.2)


def draw_circles(
    runs: Mapping[float, Sequence[Run]], centre: tuple[float, float], radius: float, path: str | Path
) -> None:
    """Draw the last lap of a circle, one panel for each law and time of a lap.

    Args:
        runs: Time of a lap [s] -> runs, the same laws for each.
        centre: Of the circle [m].
        radius: Of it [m].
        path: A file (.png, .svg, .pdf).
    """
    count = len(next(iter(runs.values())))
    angle = np.linspace(0.0, 2 * np.pi, 181)
    with drawing(path, (1.75 * count, 1.8 * len(runs) + 0.6)) as figure:
        grid = figure.subplots(len(runs), count, sharex=True, sharey=True, squeeze=False)
        for row, (lap, laws) in enumerate(runs.items()):
            for axes, run in zip(grid[row], laws, strict=True):
                off = _offsets(run, centre)[-round(lap / run.trace.time[1]) :]
                radial = np.linalg.norm(off, axis=1) - radius * MM
                axes.plot(radius * MM * np.cos(angle), radius * MM * np.sin(angle), color=WANTED, lw=0.7)
                axes.plot(off[:, 0], off[:, 1], color=LAW_COLOURS[run.entry.settings.law], lw=1.5)
                axes.text(
                    0.0, 0.0, f"{np.sqrt(np.mean(radial**2)):.2f} mm", ha="center", va="center", fontsize=9,
                    color=style.INK,
                )  # fmt: skip
                axes.set_aspect("equal")
                axes.set_xticks((-50, 0, 50))
                axes.set_yticks((-50, 0, 50))
                dress(axes, grid=0.6)
                if row == 0:
                    axes.set_title(
                        run.entry.label.replace(", ", ",\n"), fontsize=8.5, fontweight="normal", loc="center"
                    )
            grid[row, 0].set_ylabel(f"{lap:g} s a lap\ny - y0 [mm]")
        for axes in grid[-1]:
            axes.set_xlabel("x - x0 [mm]")
        study_title(figure, "Second lap of a circle; in the middle the radial RMS")


def draw_radial_errors(
    errors: Mapping[str, Mapping[tuple[float, str], float]], laws: Mapping[str, str], path: str | Path
) -> None:
    """Draw the radial RMS of many laws as dots on a logarithmic axis.

    Args:
        errors: Label -> by time of a lap [s] and branch, radial RMS [mm].
        laws: Label -> name of its law.
        path: A file (.png, .svg, .pdf).
    """
    cases = list(next(iter(errors.values())))
    laps = list(dict.fromkeys(lap for lap, _ in cases))
    branches = list(dict.fromkeys(branch for _, branch in cases))
    marks = dict(zip(branches, ("o", "^"), strict=False))
    with drawing(path, (7.6, 0.34 * len(errors) + 1.5)) as figure:
        axes = figure.subplots()
        order = sorted(errors, key=lambda label: max(errors[label].values()))
        for row, label in enumerate(order):
            colour = LAW_COLOURS[laws[label]]
            for (lap, branch), value in errors[label].items():
                slow = lap == max(laps)
                axes.plot(
                    value, row + (0.14 if slow else -0.14), marker=marks[branch], ms=5.5, color=colour, mew=1.2,
                    mfc=style.PAPER if slow else colour, ls="none",
                )  # fmt: skip
        axes.set_yticks(range(len(order)), order, fontsize=8.5)
        axes.set_xscale("log")
        dress(axes, "radial RMS over the second lap [mm]", grid=0.6)
        handles = [
            Line2D([], [], ls="none", marker=marks[branch], color=style.QUIET, ms=5.5,
                   mfc=style.PAPER if lap == max(laps) else style.QUIET, label=f"{lap:g} s a lap, {branch}")
            for lap in laps for branch in branches
        ]  # fmt: skip
        axes.set_title("Radial error on the circle, every law")
        figure.legend(handles=handles, loc="outside lower center", ncols=4, fontsize=8)


def draw_push(
    runs: Mapping[str, Sequence[Run]], start: tuple[float, float], push: tuple[float, float], path: str | Path
) -> None:
    """Draw x and y of the tip over time, while it is pushed along x and after.

    Args:
        runs: Heading of a column -> runs.
        start: Where the tip is to stay [m].
        push: When the push begins and ends [s].
        path: A file (.png, .svg, .pdf).
    """
    with drawing(path, (8.6, 5.6)) as figure:
        grid = figure.subplots(2, len(runs), sharex=True, sharey="row", squeeze=False)
        for column, (name, shown) in enumerate(runs.items()):
            for axes, which in zip(grid[:, column], (0, 1), strict=True):
                axes.axvspan(*push, color=style.FAINT, alpha=0.6, lw=0)
                axes.axhline(0.0, color=WANTED, lw=0.7)
                for run in reversed(shown):
                    axes.plot(run.trace.time, _offsets(run, start)[:, which], **line_of(run.entry))
                dress(axes, grid=0.6)
            grid[0, column].set_title(name, fontsize=9.5)
            grid[-1, column].set_xlabel("time [s]")
        grid[0, 0].set_ylabel("soft: x - 220 mm [mm]")
        grid[1, 0].set_ylabel("stiff: y [mm]")
        study_title(figure, "Pushed along the soft direction (grey) and let go")
        _legend(figure, next(iter(runs.values())), 3)


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
    """
    rows = -(-len(panels) // 3)
    with drawing(path, (8.6, 2.3 * rows + 0.6)) as figure:
        grid = figure.subplots(rows, 3, sharex=True, sharey=True, squeeze=False)
        for axes, panel in zip(grid.flat, panels, strict=False):
            for look, (plant, values) in zip(LOOKS, panel.curves.items(), strict=False):
                axes.plot(panel.time, values, label=plant, **look)
            axes.set_title(panel.title, fontsize=9)
            axes.text(0.97, 0.06, panel.note, transform=axes.transAxes, ha="right", fontsize=8, color=style.QUIET)
            dress(axes, grid=0.6)
        if min(float(values.min()) for panel in panels for values in panel.curves.values()) >= 0.0:
            grid[0, 0].set_ylim(bottom=0.0)
        for axes in grid[-1]:
            axes.set_xlabel("time [s]")
        for axes in grid[:, 0]:
            axes.set_ylabel(quantity)
        study_title(figure, title)
        legend_below(figure, grid[0, 0], 3, handlelength=3.2)
