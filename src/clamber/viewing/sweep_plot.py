"""A sweep as a picture: curves over one axis, or a field of colours over two."""

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from ..planning.axes import Axis, Mark
from ..planning.sweep import NO_START, SUCCESS, Sweep
from ..types import Floats
from . import style
from .output import CANVASES, check_suffix, save_figure
from .style import styled

SHADES = LinearSegmentedColormap.from_list("lengths", ["#E4F0F7", "#7FB0D0", "#0072B2", "#08304F"])
"""From short plans to long ones."""
ALONG: dict[str, Any] = {"ha": "center"}
UPRIGHT: dict[str, Any] = {"va": "center", "rotation": "vertical"}
MOST_WRITTEN = 150
"""Fields of more points show colours alone."""


def draw_sweep(sweep: Sweep, path: str | Path) -> None:
    """Draw the plans' lengths and torques over one axis, or the lengths over two.

    Args:
        sweep: One or two axes.
        path: Picture file (`drawing`).
    """
    check_suffix(path, CANVASES)
    with styled():
        figure = _curves(sweep) if len(sweep.axes) == 1 else _field(sweep)
        save_figure(figure, path)


def _numbers(values: list[Any]) -> Floats:
    return np.array([np.nan if value is None else value for value in values], np.float64)


def _title(axis: Axis) -> str:
    return f"{axis.key} [{axis.unit}]" if axis.unit else axis.key


def _span(axis: Axis, mark: Mark) -> tuple[float, float]:
    """A mark among the fields of an axis, whose centres are 0, 1, ...: around the fields that it holds, else between them."""
    assert axis.numbers is not None
    inside = [k for k, number in enumerate(axis.numbers) if mark.holds(number)]
    if inside:
        return inside[0] - 0.5, inside[-1] + 0.5
    at = np.array(axis.numbers)
    order = np.argsort(at)
    low, high = np.interp((mark.low, mark.high), at[order], np.arange(len(at))[order])
    return float(low), float(high)


def _draw_mark(axes: Any, low: float, high: float, *, across: bool) -> None:
    """A dashed line at a marked value, or two around a marked range."""
    for end in {low, high}:
        draw = axes.axvline if across else axes.axhline
        draw(end, color=style.INK, lw=1.2, ls=(0, (4, 3)), zorder=3)


def _curves(sweep: Sweep) -> Figure:
    figure = Figure(figsize=(7.2, 5.0), layout="constrained")
    upper, lower = figure.subplots(2, 1, sharex=True)
    unit, size, _ = sweep.units.torque
    axis = sweep.axes[0]
    named = axis.numbers is None
    at = np.arange(len(axis.values)) if axis.numbers is None else np.array(axis.numbers)
    order = np.argsort(at, kind="stable")
    points = [sweep.points[k] for k in order]
    at = at[order]
    line = "none" if named else "-"  # between names there is nothing to read off
    lengths = _numbers([point.length for point in points])
    upper.plot(at, lengths, color=style.PARTS[0], lw=1.8, ls=line, marker="o", ms=4.5)
    upper.set_ylabel("actions of the shortest plan" if sweep.planner == "exact" else "actions of the plan")
    upper.yaxis.set_major_locator(MaxNLocator(integer=True, nbins=6))
    for name, values, colour in (
        ("of that plan", _numbers([point.largest_torque for point in points]), style.PARTS[1]),
        ("least of any plan", _numbers([point.least_torque for point in points]), style.PARTS[2]),
    ):
        if not np.all(np.isnan(values)):
            lower.plot(at, values / size, color=colour, lw=1.8, ls=line, marker="o", ms=4.5, label=name)
    lower.set_ylabel(f"largest joint torque [{unit}]")
    lower.set_ylim(bottom=0.0)
    lower.set_xlabel(_title(axis))
    without = np.array([point.status not in SUCCESS for point in points])
    if without.any():
        for axes in (upper, lower):
            axes.plot(
                at[without], np.full(int(without.sum()), 0.03), transform=axes.get_xaxis_transform(), color=style.ALERT,
                ls="none", marker="x", ms=6, mew=1.6, clip_on=False, label="no plan" if axes is lower else None,
            )  # fmt: skip
    if named:
        lower.set_xticks(at, [axis.values[k] for k in order])
    for k, mark in enumerate(sweep.marks):
        for axes in (upper, lower):
            _draw_mark(axes, mark.low, mark.high, across=True)
        upper.annotate(
            mark.text, ((mark.low + mark.high) / 2.0, 1.0), xycoords=upper.get_xaxis_transform(), xytext=(0, 3 + 10 * (k % 2)),
            textcoords="offset points", ha="center", fontsize=8, color=style.INK, annotation_clip=False,
        )  # fmt: skip
    for axes in (upper, lower):
        style.ruled(axes, "y", behind=True)
    title = f"'{sweep.task}' over {axis.key}: {sweep.found} of {len(points)} points have a plan"
    upper.set_title(title, pad=28.0 if sweep.marks else None)
    figure.legend(loc="outside lower center", ncols=3, fontsize=8)
    return figure


def _field(sweep: Sweep) -> Figure:
    figure = Figure(figsize=(7.2, 4.8), layout="constrained")
    axes = figure.subplots()
    across, up = sweep.axes
    shape = (len(across.values), len(up.values))
    lengths = _numbers([point.length for point in sweep.points]).reshape(shape).T  # rows: the second axis
    axes.set_facecolor("#F0EDED")
    shown = axes.imshow(lengths, origin="lower", aspect="auto", cmap=SHADES, interpolation="none")
    low, high = (np.nanmin(lengths), np.nanmax(lengths)) if sweep.found else (0.0, 1.0)
    if low == high:
        shown.set_clim(low - 1.0, high + 1.0)
    for k, point in enumerate(sweep.points):
        x, y = divmod(k, shape[1])
        if point.length is None:
            ring: dict[str, Any] = {"marker": "o", "mfc": "none", "color": style.QUIET}
            cross: dict[str, Any] = {"marker": "x", "color": style.ALERT}
            axes.plot(x, y, ms=6, mew=1.4, **(ring if point.status == NO_START else cross))
        elif len(sweep.points) <= MOST_WRITTEN:
            dark = high > low and (point.length - low) / (high - low) > 0.45
            axes.text(
                x, y, str(point.length), ha="center", va="center", fontsize=8, color=style.PAPER if dark else style.INK
            )
    for axis, rule, set_ticks in ((across, shape[0], axes.set_xticks), (up, shape[1], axes.set_yticks)):
        every = range(0, rule, max(1, -(-rule // 12)))
        words = [axis.values[k] if axis.numbers is None else f"{axis.numbers[k]:.4g}" for k in every]
        set_ticks(list(every), words)
    axes.set_xticks(np.arange(shape[0] + 1) - 0.5, minor=True)
    axes.set_yticks(np.arange(shape[1] + 1) - 0.5, minor=True)
    axes.grid(which="minor", color=style.PAPER, lw=1.5)
    axes.tick_params(which="both", length=0)
    for spine in axes.spines.values():
        spine.set_visible(False)
    for mark in sweep.marks:
        axis = across if mark.key == across.key else up
        low, high = _span(axis, mark)
        _draw_mark(axes, low, high, across=axis is across)
        if axis is across:
            where, shift, hold = ((low + high) / 2.0, 1.0), (0.0, 3.0), ALONG
            frame = axes.get_xaxis_transform()
        else:
            where, shift, hold = (1.0, (low + high) / 2.0), (3.0, 0.0), UPRIGHT
            frame = axes.get_yaxis_transform()
        axes.annotate(
            mark.text,
            where,
            xycoords=frame,
            xytext=shift,
            textcoords="offset points",
            fontsize=8,
            color=style.INK,
            annotation_clip=False,
            **hold,
        )
    axes.set(xlim=(-0.5, shape[0] - 0.5), ylim=(-0.5, shape[1] - 0.5), xlabel=_title(across))
    axes.set_ylabel(_title(up))
    lengths_of = "actions of the shortest plan" if sweep.planner == "exact" else "actions of the plan"
    axes.set_title(
        f"'{sweep.task}': {lengths_of}; crosses: no plan, rings: no start", pad=18.0 if sweep.marks else None
    )
    bar = figure.colorbar(shown, ax=axes, pad=0.05 if sweep.marks else 0.02)
    bar.outline.set_visible(False)
    bar.locator = MaxNLocator(integer=True, nbins=6)
    bar.update_ticks()
    return figure
