"""A comparison of laws on the limb bench as one picture: where the tip went, when, and what the motors gave."""

import math
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...types import Floats
from ...viewing import style
from ...viewing.law_colours import LAW_COLOURS, OUTSIDE
from ...viewing.output import drawing
from ...viewing.style import bare
from ..measures import components, radial_error
from ..result import LimbResult, Row

MM: Final = 1e3
LINES: Final = ("-", (0, (5, 1.5)), (0, (1, 1)), (0, (6, 1.5, 1, 1.5)), (0, (3, 1, 1, 1, 1, 1)), (0, (8, 2)))
"""So that laws whose curves coincide are both seen."""
HEAD: Final = 0.9
"""Part of the picture's height below the title."""
MAGNIFY: Final = (1, 2, 5, 10, 20, 50, 100, 200)
"""By how much an error may be drawn larger than it is."""


def draw_limb_result(result: LimbResult, path: str | Path) -> None:
    """Draw the first trial of every law: true paths as lines, what the encoders told as thin ones where it differs.

    Args:
        result: From `compare_laws`.
        path: A file (.png, .svg, .pdf).

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    with drawing(path, (9.6, 6.6)) as figure:
        figure.get_layout_engine().set(rect=(0.0, 0.0, 1.0, HEAD))  # type: ignore[union-attr, call-arg]
        if result.scenario.kind == "circle":
            _draw_circle(figure, result)
        elif result.scenario.kind == "step":
            _draw_step(figure, result)
        else:
            _draw_holding(figure, result)
        handles, labels = figure.axes[0].get_legend_handles_labels()
        kept = dict(zip(labels, handles, strict=True))
        figure.legend(kept.values(), kept.keys(), loc="outside lower center", ncols=min(4, len(kept)), fontsize=8)
        _head(figure, result)


def _head(figure: Figure, result: LimbResult) -> None:
    """What was asked for, how gains were matched, and of what plant, in the space above the panels."""
    title = f"{result.title()}, {result.limb.robot.name}'s {result.limb.name} limb"
    figure.text(0.012, 0.985, title[0].upper() + title[1:], va="top", fontsize=11, fontweight="bold")
    under = f"gains {result.match_words()}\nplant: {result.plant_words()}"
    if result.trials > 1:
        under += f"; first of {result.trials} trials"
    if result.imperfect:
        under += "; thin: as the encoders tell"
    figure.text(0.012, 0.95, under, va="top", fontsize=8, color=style.QUIET, linespacing=1.4)


def _look(row: Row, k: int) -> dict[str, Any]:
    return {"color": LAW_COLOURS.get(row.entry.settings.law, OUTSIDE), "ls": LINES[k % len(LINES)], "lw": 1.5}


def _faint(row: Row) -> dict[str, Any]:
    return {"color": LAW_COLOURS.get(row.entry.settings.law, OUTSIDE), "lw": 0.6, "alpha": 0.7}


def _name(row: Row) -> str:
    when = row.measures[0].unstable_at
    return row.entry.label if when is None else f"{row.entry.label} (unstable from {when:.1f} s)"


def _paths(row: Row) -> tuple[Floats, Floats]:
    trace = row.run.trace
    return trace.true_places()[:, 0, :2], trace.sensed_places()[:, 0, :2]


def _dress(axes: Axes, across: str, up: str) -> None:
    bare(axes)
    axes.grid(color=style.FAINT, lw=0.5)
    axes.set_axisbelow(True)
    axes.set_xlabel(across)
    axes.set_ylabel(up)


def _draw_step(figure: Figure, result: LimbResult) -> None:
    scenario = result.scenario
    grid = figure.add_gridspec(3, 2, width_ratios=(1.0, 1.15))
    plane = figure.add_subplot(grid[:, 0])
    along_axes, across_axes = (figure.add_subplot(grid[k, 1]) for k in (0, 1))
    torque_axes = figure.add_subplot(grid[2, 1], sharex=along_axes)
    until = result.shown_until()
    aim = result.rows[0].run.trace.wanted_places()[-1, 0, :2]
    start = np.array(scenario.start)
    length = components(aim - start, scenario.direction)[0]
    for k, row in enumerate(result.rows):
        time = row.run.trace.time
        for places, look, label in zip(_paths(row), (_look(row, k), _faint(row)), (_name(row), None), strict=True):
            if label is None and not result.imperfect:
                continue
            along, across = (MM * part for part in components(places - start, scenario.direction))
            plane.plot(across, along, label=label, **look)
            along_axes.plot(time, along, **look)
            across_axes.plot(time, across, **look)
        _torques(torque_axes, row, k)
    for axes, level in ((along_axes, MM * float(length)), (across_axes, 0.0)):
        axes.axhline(level, color=style.INK, lw=0.7, ls=(0, (2, 2)), zorder=1)
        axes.set_xlim(0.0, until)
        axes.tick_params(labelbottom=False)
    plane.plot([0.0, 0.0], [0.0, MM * float(length)], color=style.INK, lw=0.7, ls=(0, (2, 2)), zorder=1)
    plane.plot([0.0], [MM * float(length)], ls="none", marker="+", ms=9, color=style.INK)
    plane.invert_yaxis()
    low, high = plane.get_xlim()
    widest = max(abs(low), abs(high), 0.1)
    plane.set_xlim(-widest, widest)
    _dress(plane, "across the step, to its left [mm]", "along the step [mm]")
    plane.set_title("path (sideways drawn larger)", fontsize=9, fontweight="normal")
    _dress(along_axes, "", "along [mm]")
    _dress(across_axes, "", "across [mm]")
    _finish_torques(torque_axes, result)


def _torques(axes: Axes, row: Row, k: int) -> None:
    trace = row.run.trace
    for j, width in ((0, 1.3), (1, 0.7)):
        torque = trace.applied[:, 0, min(j, trace.applied.shape[2] - 1)]
        axes.plot(trace.time, torque, **(_look(row, k) | {"lw": width}))


def _finish_torques(axes: Axes, result: LimbResult) -> None:
    _dress(axes, "time [s]", "torque [N m]")
    axes.set_title(
        "thick: shoulder, thin: elbow", loc="right", fontsize=7, fontweight="normal", color=style.QUIET, pad=2
    )


def _magnified(result: LimbResult, last: Any, radius: float) -> int:
    """By how much distances from the circle are drawn larger, so that the largest of a stable law fills a third of the radius."""
    stable = [row for row in result.rows if row.measures[0].unstable_at is None]
    off = [np.abs(radial_error(_paths(row)[0][last], result.scenario)).max() for row in stable]
    return max(factor for factor in MAGNIFY if factor == 1 or factor * max(off, default=radius) <= radius / 3)


def _draw_circle(figure: Figure, result: LimbResult) -> None:
    scenario = result.scenario
    assert scenario.centre is not None and scenario.radius is not None
    grid = figure.add_gridspec(2, 2, width_ratios=(1.15, 1.0))
    plane = figure.add_subplot(grid[:, 0])
    off_axes, lag_axes = (figure.add_subplot(grid[k, 1]) for k in (0, 1))
    centre, radius = np.array(scenario.centre), scenario.radius
    last = result.rows[0].run.trace.time >= scenario.settle
    wanted = result.rows[0].run.trace.wanted_places()[last, 0, :2] - centre
    turned = np.unwrap(np.arctan2(wanted[:, 1], wanted[:, 0]))
    degrees = np.degrees(turned - turned[0])
    times = _magnified(result, last, radius)
    round_ = np.linspace(0.0, math.tau, 361)
    plane.plot(
        MM * (centre[0] + radius * np.cos(round_)), MM * (centre[1] + radius * np.sin(round_)),
        color=style.INK, lw=0.8, ls=(0, (2, 2)), label="wanted",
    )  # fmt: skip
    for k, row in enumerate(result.rows):
        for places, look, label in zip(_paths(row), (_look(row, k), _faint(row)), (_name(row), None), strict=True):
            if label is None and not result.imperfect:
                continue
            off = radial_error(places[last], scenario)
            angle = np.arctan2(*(places[last] - centre).T[::-1])
            size = radius + times * off
            plane.plot(
                MM * (centre[0] + size * np.cos(angle)), MM * (centre[1] + size * np.sin(angle)), label=label, **look
            )
            off_axes.plot(degrees, MM * off, **look)
            behind = np.degrees(np.angle(np.exp(1j * (turned - angle))))
            lag_axes.plot(degrees, behind, **look)
    plane.set_aspect("equal")
    reach = 1.5 * MM * radius
    plane.set_xlim(MM * centre[0] - reach, MM * centre[0] + reach)
    plane.set_ylim(MM * centre[1] - reach, MM * centre[1] + reach)
    _dress(plane, "x [mm]", "y [mm]")
    grown = f", distance from the circle drawn {times} times as large" if times > 1 else ""
    plane.set_title(f"path of the last lap{grown}", fontsize=9, fontweight="normal")
    _dress(off_axes, "", "off the circle, outwards [mm]")
    _dress(lag_axes, "aim's angle since the lap began [deg]", "behind the aim [deg]")
    for axes in (off_axes, lag_axes):
        axes.axhline(0.0, color=style.INK, lw=0.7, ls=(0, (2, 2)), zorder=1)
        axes.set_xlim(0.0, 360.0)
        axes.set_xticks(range(0, 361, 60))
    off_axes.tick_params(labelbottom=False)


def _draw_holding(figure: Figure, result: LimbResult) -> None:
    scenario = result.scenario
    grid = figure.add_gridspec(3, 2, width_ratios=(1.0, 1.15))
    plane = figure.add_subplot(grid[:, 0])
    along_axes, across_axes = (figure.add_subplot(grid[k, 1]) for k in (0, 1))
    torque_axes = figure.add_subplot(grid[2, 1], sharex=along_axes)
    aim = result.rows[0].run.trace.wanted_places()[-1, 0, :2]
    for k, row in enumerate(result.rows):
        time = row.run.trace.time
        for places, look, label in zip(_paths(row), (_look(row, k), _faint(row)), (_name(row), None), strict=True):
            if label is None and not result.imperfect:
                continue
            along, across = (MM * part for part in components(places - aim, scenario.direction))
            plane.plot(along, across, label=label, **look)
            along_axes.plot(time, along, **look)
            across_axes.plot(time, across, **look)
        _torques(torque_axes, row, k)
    plane.plot([0.0], [0.0], ls="none", marker="+", ms=9, color=style.INK)
    plane.set_aspect("equal", adjustable="datalim")
    end = float(result.rows[0].run.trace.time[-1])
    for axes in (along_axes, across_axes, torque_axes):
        axes.set_xlim(0.0, end)
        if scenario.push is not None:
            axes.axvspan(
                scenario.push.start, scenario.push.end + scenario.push.rise, color=style.FAINT, alpha=0.5, lw=0
            )
    for axes in (along_axes, across_axes):
        axes.tick_params(labelbottom=False)
    _dress(plane, "along the push [mm]", "across the push, to its left [mm]")
    plane.set_title("path", fontsize=9, fontweight="normal")
    _dress(along_axes, "", "along [mm]")
    _dress(across_axes, "", "across [mm]")
    _finish_torques(torque_axes, result)
