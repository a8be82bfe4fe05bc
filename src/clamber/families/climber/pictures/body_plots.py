"""Pictures of a body on its limbs: circles side by side, x, y, angle and hooks over time, limit cycles, a force held."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from ....viewing import style
from ....viewing.output import drawing
from ....viewing.style import LAW_COLOURS, MATCH_LINES, WANTED, bare
from ..trials.body_bench import SLOT, BodyEntry, BodyRun
from ..trials.body_stand import BodyScenario
from ..trials.hold_force import Pressed

MILLI: Final = 1e3
COORDINATED: Final = "#8C564B"
"""Colour of the earlier scheme."""
OWN: Final = "#B5A900"
"""Colour of the robot's own control as it climbs."""


def line_of(entry: BodyEntry) -> dict[str, Any]:
    """How a control is drawn: in its law's colour, in the line of the matching that its label names, dashed where it works leg by leg."""
    gains = entry.gains
    if gains.scheme == "coordinated":
        return {"color": COORDINATED, "lw": 1.4}
    if gains.mapping == "wrench":
        return {"color": OWN, "lw": 1.4}
    wide = 2.0 if gains.law == "scct" and gains.scheme == "body" else 1.4
    match = entry.label.partition(", ")[2]
    line = MATCH_LINES.get(match, "-") if gains.scheme == "body" else MATCH_LINES["mean"]
    return {"color": LAW_COLOURS[gains.law], "lw": wide, "ls": line}


def _quiet(axes: Axes) -> None:
    style.ruled(axes)
    axes.set_axisbelow(True)


def draw_bodies(runs: Sequence[BodyRun], scenario: BodyScenario, path: str | Path) -> None:
    """Draw runs of one scenario: paths of a circle, else over time."""
    if scenario.kind == "circle":
        draw_body_circles({f"{scenario.radius * 100:g} cm": (scenario, runs)}, path)
    else:
        what = {"push": "Pushed (grey) and let go", "push-up": "A push-up on two limbs"}[scenario.kind]
        draw_body_times({"": runs}, what, path)


def draw_body_circles(laps: Mapping[str, tuple[BodyScenario, Sequence[BodyRun]]], path: str | Path) -> None:
    """Draw the last lap of the body's circle, one panel for each control and time of a lap.

    Args:
        laps: Heading of a row -> its scenario and runs, the same controls for each.
        path: Picture file (`drawing`).
    """
    count = len(next(iter(laps.values()))[1])
    angle = np.linspace(0.0, 2 * np.pi, 181)
    with drawing(path, (max(3.6, 1.9 * count), 2.0 * len(laps) + 0.7)) as figure:
        grid = figure.subplots(len(laps), count, sharex=True, sharey=True, squeeze=False)
        for row, (name, (scenario, runs)) in enumerate(laps.items()):
            assert scenario.centre is not None
            radius = scenario.radius * MILLI
            for axes, run in zip(grid[row], runs, strict=True):
                off = (run.trace.pose[scenario.begin :, :2] - scenario.centre) * MILLI
                rms = np.sqrt(np.mean((np.linalg.norm(off, axis=1) - radius) ** 2))
                axes.plot(radius * np.cos(angle), radius * np.sin(angle), color=WANTED, lw=0.7)
                axes.plot(off[:, 0], off[:, 1], **line_of(run.entry))
                axes.text(0.0, 0.0, f"{rms:.2f} mm", ha="center", va="center", fontsize=9, color=style.INK)
                axes.set_aspect("equal")
                _quiet(axes)
                if row == 0:
                    title = run.entry.label.replace(", ", ",\n")
                    axes.set_title(title, fontsize=8.5, fontweight="normal", loc="center")
            grid[row, 0].set_ylabel(f"{name}\ny [mm]")
        for axes in grid[-1]:
            axes.set_xlabel("x [mm]")
        figure.suptitle("Last lap; in the middle the radial RMS", x=0.01, ha="left", fontsize=11, fontweight="bold")


def draw_body_times(
    columns: Mapping[str, Sequence[BodyRun]], title: str, path: str | Path, *, from_aim: bool = False
) -> None:
    """Draw x, y, angle and the hooks' distance from their pegs over time, a column for each heading.

    Args:
        columns: Heading -> runs.
        title: Of the picture.
        path: Picture file (`drawing`).
        from_aim: Whether y is told from the aim, else from where the aim began.
    """
    names = ("x [mm]", "y off the aim [mm]" if from_aim else "y [mm]", "angle [deg]", "tip off its peg [mm]")
    with drawing(path, (max(6.0, 4.2 * len(columns)), 7.4)) as figure:
        grid = figure.subplots(4, len(columns), sharex=True, sharey="row", squeeze=False)
        for column, (name, runs) in enumerate(columns.items()):
            for run in reversed(runs):
                _draw_times(list(grid[:, column]), run, from_aim)
            trace = runs[0].trace
            if not from_aim:
                grid[1, column].plot(trace.time, (trace.aim[:, 1] - trace.aim[0, 1]) * MILLI, color=WANTED, lw=0.8)
            pushed = trace.time[np.abs(trace.push).max(axis=1) > 0.0]
            for axes in grid[:, column]:
                if len(pushed):
                    axes.axvspan(pushed[0], pushed[-1], color=style.FAINT, alpha=0.6, lw=0)
                _quiet(axes)
                axes.set_xlim(-0.2, trace.time[-1])
            grid[3, column].axhline(SLOT * MILLI, color=style.ALERT, lw=0.8)
            grid[0, column].set_title(name, fontsize=9.5)
            grid[-1, column].set_xlabel("time [s]")
        for axes, label in zip(grid[:, 0], names, strict=True):
            axes.set_ylabel(label)
        grid[3, 0].set_ylim(0.0, 2.5 * SLOT * MILLI)
        grid[0, 0].set_ylim(*_room(columns, 0))
        grid[1, 0].set_ylim(*_room(columns, 1, from_aim=from_aim))
        grid[2, 0].set_ylim(*_room(columns, 2))
        figure.suptitle(title, x=0.01, ha="left", fontsize=11, fontweight="bold")
        shown: dict[str, Line2D] = {}
        for runs in columns.values():
            for run in runs:
                shown.setdefault(run.entry.label, Line2D([], [], label=run.entry.label, **line_of(run.entry)))
        figure.legend(handles=list(shown.values()), loc="outside lower center", ncols=3, fontsize=8, handlelength=3.2)


def _draw_times(axes: Sequence[Axes], run: BodyRun, from_aim: bool) -> None:
    trace = run.trace
    y = trace.pose[:, 1] - (trace.aim[:, 1] if from_aim else trace.aim[0, 1])
    lines = (
        (trace.pose[:, 0] - trace.aim[:, 0]) * MILLI,
        y * MILLI,
        np.degrees(trace.pose[:, 2] - trace.aim[:, 2]),
        trace.off.max(axis=1) * MILLI,
    )
    for each, values in zip(axes, lines, strict=True):
        each.plot(trace.time, values, **line_of(run.entry))


def _room(columns: Mapping[str, Sequence[BodyRun]], which: int, *, from_aim: bool = False) -> tuple[float, float]:
    """Limits that show every run whose hooks stay on; a fall leaves the picture."""
    scale = MILLI if which < 2 else float(np.degrees(1.0))
    runs = [run for each in columns.values() for run in each]
    kept = [run for run in runs if run.trace.unhooked_at is None] or runs
    values = []
    for run in kept:
        base = run.trace.aim[0, 1] if which == 1 and not from_aim else run.trace.aim[:, which]
        values.append((run.trace.pose[:, which] - base)[run.trace.time >= -0.2] * scale)
    low, high = min(float(np.nanmin(each)) for each in values), max(float(np.nanmax(each)) for each in values)
    margin = 0.08 * max(high - low, 1e-3)
    return low - margin, high + margin


LEAST: Final = 0.01
"""Smaller motion is drawn as this [mm]."""
PLAY_DASHES: Final = ("-", (0, (5, 1.6)), (0, (1, 1.2)))
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
        path: Picture file (`drawing`).
    """
    places = list(dict.fromkeys(place for _, place, _, _ in swings))
    colours = dict(zip(dict.fromkeys(b for _, _, b, _ in swings), style.PARTS, strict=False))
    dashes = dict(zip(dict.fromkeys(p for _, _, _, p in swings), PLAY_DASHES, strict=False))
    with drawing(path, (4.4 * len(places), 4.4)) as figure:
        grid = figure.subplots(1, len(places), sharex=True, sharey=True, squeeze=False)[0]
        for axes, place in zip(grid, places, strict=True):
            axes.axhline(cycle, color=style.ALERT, lw=0.8)
            for (_, each, backlash, play), found in swings.items():
                if each == place:
                    values = np.maximum(found, LEAST)
                    axes.plot(gains, values, color=colours[backlash], ls=dashes[play], lw=1.5, marker="o", ms=2.5)
            axes.set(xscale="log", yscale="log")
            axes.set_title(f"place by {place}", fontsize=9.5)
            axes.set_xlabel("Kpx")
            style.ruled(axes)
        grid[0].set_ylabel("left to and fro along x [mm]")
        handles = [Line2D([], [], color=colour, label=f"backlash {b:g} deg") for b, colour in colours.items()]
        handles += [Line2D([], [], color=style.QUIET, ls=dash, label=f"play {p}") for p, dash in dashes.items()]
        figure.legend(handles=handles, loc="outside lower center", ncols=3, fontsize=8, handlelength=3.2)
        figure.suptitle("From which stiffness on the body cycles", x=0.01, ha="left", fontsize=11, fontweight="bold")


FORCE, ASKED, TRUE = "#0072B2", "#999999", "#D55E00"


def draw_press(result: Pressed, path: str | Path) -> None:
    """Draw the true force with its band of a tenth, and how far the body went beside what it was asked.

    Args:
        result: From `run_press`.
        path: Picture file (`drawing`).
    """
    with drawing(path, (7.2, 5.0)) as figure:
        force, body = figure.subplots(2, 1, sharex=True, height_ratios=(1.4, 1.0))
        force.axhspan(0.9 * result.wanted, 1.1 * result.wanted, color=FORCE, alpha=0.12, lw=0)
        force.plot(result.time, result.force, color=FORCE, lw=0.9)
        force.set_ylabel("force on the wall [N]")
        force.set_title(f"{result.wanted:.3g} N held while the body moves; the band is a tenth", loc="left")
        for k, (axis, dashes) in enumerate((("x", (3, 1.5)), ("y", (1, 0)))):
            start = result.aim[0, k]
            body.plot(result.time, 1e3 * (result.aim[:, k] - start), color=ASKED, lw=0.9, dashes=dashes)
            body.plot(result.time, 1e3 * (result.body[:, k] - start), color=TRUE, lw=1.2, dashes=dashes, label=axis)
        body.set(ylabel="body from its first aim [mm]", xlabel="time [s]")
        body.legend(frameon=False, loc="upper left")
        for axes in (force, body):
            bare(axes)
