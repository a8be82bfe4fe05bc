"""A comparison of laws on the limb bench as one picture: where the tip went, when, and what the motors gave."""

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...types import Floats
from ...viewing import style
from ...viewing.output import drawing
from ...viewing.style import LAW_COLOURS, OUTSIDE
from ..measures import components, radial_error
from ..result import LimbResult, Row
from .panels import DASHED, LINES, MM, dress, head, legend_below

MAGNIFY: Final = (1, 2, 5, 10, 20, 50, 100, 200)
"""By how much an error may be drawn larger than it is."""


def draw_comparison(result: LimbResult, path: str | Path) -> None:
    """Draw the first trial of every law: true paths as lines, what the encoders told as thin ones where it differs."""
    with drawing(path, (9.6, 6.6)) as figure:
        (_draw_circle if result.scenario.kind == "circle" else _draw_line)(figure, result)
        legend_below(figure, figure.axes[0], 4)
        title = f"{result.title()}, {result.limb.robot.name}'s {result.limb.name} limb"
        under = f"gains {result.match_words()}\nplant: {result.plant_words()}"
        if result.trials > 1:
            under += f"; first of {result.trials} trials"
        if result.imperfect:
            under += "; thin: as the encoders tell"
        head(figure, title[0].upper() + title[1:], under, room=0.9, tops=(0.985, 0.95))


def _look(row: Row, k: int) -> dict[str, Any]:
    return {"color": LAW_COLOURS.get(row.entry.settings.law, OUTSIDE), "ls": LINES[k % len(LINES)], "lw": 1.5}


def _paths(result: LimbResult, row: Row, k: int) -> Iterator[tuple[Floats, dict[str, Any], str | None]]:
    """The tip's places [m], how they are drawn and their label: in truth, and by the encoders where these differ."""
    trace, when = row.run.trace, row.measures[0].unstable_at
    label = row.entry.label if when is None else f"{row.entry.label} (unstable from {when:.1f} s)"
    look = _look(row, k)
    yield trace.true_places()[:, 0, :2], look, label
    if result.imperfect:
        yield trace.sensed_places()[:, 0, :2], {"color": look["color"], "lw": 0.6, "alpha": 0.7}, None


def _draw_line(figure: Figure, result: LimbResult) -> None:
    """A step or a push: the path, and over time the parts along it and across it, and the torques."""
    scenario = result.scenario
    stepped = scenario.kind == "step"
    grid = figure.add_gridspec(3, 2, width_ratios=(1.0, 1.15))
    plane = figure.add_subplot(grid[:, 0])
    along_axes, across_axes = (figure.add_subplot(grid[k, 1]) for k in (0, 1))
    torque_axes = figure.add_subplot(grid[2, 1], sharex=along_axes)
    aim = result.rows[0].run.trace.wanted_places()[-1, 0, :2]
    origin = np.array(scenario.start) if stepped else aim
    for k, row in enumerate(result.rows):
        trace = row.run.trace
        for places, look, label in _paths(result, row, k):
            along, across = (MM * part for part in components(places - origin, scenario.direction))
            plane.plot(*((across, along) if stepped else (along, across)), label=label, **look)
            along_axes.plot(trace.time, along, **look)
            across_axes.plot(trace.time, across, **look)
        for j, width in ((0, 1.3), (1, 0.7)):
            torque = trace.applied[:, 0, min(j, trace.applied.shape[2] - 1)]
            torque_axes.plot(trace.time, torque, **(_look(row, k) | {"lw": width}))
    if stepped:
        length = MM * float(components(aim - origin, scenario.direction)[0])
        _finish_step(plane, along_axes, across_axes, length)
        along_axes.set_xlim(0.0, result.shown_until())
        across_axes.set_xlim(0.0, result.shown_until())
    else:
        _finish_push(result, plane, (along_axes, across_axes, torque_axes))
    for axes in (along_axes, across_axes):
        axes.tick_params(labelbottom=False)
    dress(along_axes, "", "along [mm]")
    dress(across_axes, "", "across [mm]")
    dress(torque_axes, "time [s]", "torque [N m]")
    torque_axes.set_title(
        "thick: shoulder, thin: elbow", loc="right", fontsize=7, fontweight="normal", color=style.QUIET, pad=2
    )


def _finish_step(plane: Axes, along: Axes, across: Axes, length: float) -> None:
    """The step's line, of `length` [mm]; its path is seen from the start downwards."""
    along.axhline(length, **DASHED)
    across.axhline(0.0, **DASHED)
    plane.plot([0.0, 0.0], [0.0, length], **DASHED)
    plane.plot([0.0], [length], ls="none", marker="+", ms=9, color=style.INK)
    plane.invert_yaxis()
    low, high = plane.get_xlim()
    widest = max(abs(low), abs(high), 0.1)
    plane.set_xlim(-widest, widest)
    dress(plane, "across the step, to its left [mm]", "along the step [mm]")
    plane.set_title("path (sideways drawn larger)", fontsize=9, fontweight="normal")


def _finish_push(result: LimbResult, plane: Axes, over_time: tuple[Axes, ...]) -> None:
    """The place that is held, and when the tip is pushed."""
    plane.plot([0.0], [0.0], ls="none", marker="+", ms=9, color=style.INK)
    plane.set_aspect("equal", adjustable="datalim")
    push, end = result.scenario.push, float(result.rows[0].run.trace.time[-1])
    for axes in over_time:
        axes.set_xlim(0.0, end)
        if push is not None:
            axes.axvspan(push.start, push.end + push.rise, color=style.FAINT, alpha=0.5, lw=0)
    dress(plane, "along the push [mm]", "across the push, to its left [mm]")
    plane.set_title("path", fontsize=9, fontweight="normal")


def _magnified(result: LimbResult, last: Any, radius: float) -> int:
    """By how much distances from the circle are drawn larger, so that the largest of a stable law fills a third of the radius."""
    stable = [row.run.trace.true_places()[:, 0, :2] for row in result.rows if row.measures[0].unstable_at is None]
    off = [np.abs(radial_error(places[last], result.scenario)).max() for places in stable]
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

    def round_trip(angle: Floats, size: Any) -> tuple[Floats, Floats]:
        return MM * (centre[0] + size * np.cos(angle)), MM * (centre[1] + size * np.sin(angle))

    plane.plot(
        *round_trip(np.linspace(0.0, math.tau, 361), radius), color=style.INK, lw=0.8, ls=(0, (2, 2)), label="wanted"
    )
    for k, row in enumerate(result.rows):
        for places, look, label in _paths(result, row, k):
            off = radial_error(places[last], scenario)
            angle = np.arctan2(*(places[last] - centre).T[::-1])
            plane.plot(*round_trip(angle, radius + times * off), label=label, **look)
            off_axes.plot(degrees, MM * off, **look)
            lag_axes.plot(degrees, np.degrees(np.angle(np.exp(1j * (turned - angle)))), **look)
    plane.set_aspect("equal")
    reach = 1.5 * MM * radius
    plane.set_xlim(MM * centre[0] - reach, MM * centre[0] + reach)
    plane.set_ylim(MM * centre[1] - reach, MM * centre[1] + reach)
    grown = f", distance from the circle drawn {times} times as large" if times > 1 else ""
    plane.set_title(f"path of the last lap{grown}", fontsize=9, fontweight="normal")
    dress(plane, "x [mm]", "y [mm]")
    dress(off_axes, "", "off the circle, outwards [mm]")
    dress(lag_axes, "aim's angle since the lap began [deg]", "behind the aim [deg]")
    for axes in (off_axes, lag_axes):
        axes.axhline(0.0, **DASHED)
        axes.set_xlim(0.0, 360.0)
        axes.set_xticks(range(0, 361, 60))
    off_axes.tick_params(labelbottom=False)
