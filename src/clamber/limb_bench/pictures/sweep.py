"""A sweep of laws as curves or a map of the best law, with where each goes unstable; a tuning as maps of kp and kd."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from ...planning.axes import Axis
from ...sim.flaw_texts import plant_words
from ...types import Floats
from ...viewing import style
from ...viewing.output import drawing
from ...viewing.style import bare
from ..entries import gain_unit
from ..measures import measure_scale
from ..sweep import LimbSweep
from ..tune import Tuned, Tuning
from .panels import LINES, dress, head, legend_below

WIDE: Final = 8.0
"""Curves whose largest value is so many times the smallest are drawn to a logarithmic scale."""
MOST_TICKS: Final = 12
NONE: Final = "#ECE9E6"
"""Fill of where no law is stable, under a hatch."""


def draw_sweep(sweep: LimbSweep, path: str | Path) -> None:
    """Draw the measure of every law over one axis, or the best law over two."""
    scale, unit = measure_scale(sweep.bench.measure)
    with drawing(path, (8.4, 5.4)) as figure:
        axes = figure.subplots()
        words = f"{sweep.bench.measure.replace('_', ' ')}{f' [{unit}]' if unit else ''}"
        if len(sweep.axes) == 1:
            _curves(axes, sweep, scale)
            axes.set_ylabel(words)
            handles: Sequence[Artist] = axes.get_legend_handles_labels()[0]
        else:
            handles = _map(axes, sweep)
        figure.legend(handles=handles, loc="outside lower center", ncols=3, fontsize=8)
        _head(figure, sweep, words)


def _head(figure: Figure, sweep: LimbSweep, words: str) -> None:
    bench = sweep.bench
    what = {"step": "a step", "circle": f"a circle in {bench.command.get('lap', 0.0):g} s", "push": "a push"}[
        bench.kind
    ]
    title = f"Laws on {what} over {' and '.join(axis.key.replace('_', ' ') for axis in sweep.axes)}: {words}"
    under = f"plant: {sweep.plant_words()}\ngains: {sweep.gain_words()}"
    head(figure, title, under, room=0.885, tops=(0.985, 0.945))


def _title(axis: Axis) -> str:
    name = axis.key.replace("_", " ")
    return f"{name} [{axis.unit}]" if axis.unit else name


def _colour(k: int) -> str:
    return style.PARTS[k % len(style.PARTS)]


def _limit(k: int) -> dict[str, Any]:
    """How the limit of a law is drawn in a map."""
    return {"color": _colour(k), "lw": 1.8, "ls": LINES[k % len(LINES)], "marker": "o", "ms": 3.5}


def _curves(axes: Axes, sweep: LimbSweep, scale: float) -> None:
    axis = sweep.axes[0]
    assert axis.numbers is not None
    order = np.argsort(axis.numbers)
    at = np.array(axis.numbers)[order]
    top, least = 0.0, np.inf
    for k, label in enumerate(sweep.labels):
        cells = [sweep.points[j][label] for j in order]
        values = np.array([np.nan if cell.value is None else scale * cell.value for cell in cells])
        steady = np.array([cell.steady for cell in cells])
        calm = np.where(steady, values, np.nan)
        edges = sorted(each.at for each in sweep.boundaries if each.label == label)
        ends = np.interp(edges, at, values)
        x, y = np.concatenate((at, edges)), np.concatenate((calm, ends))
        path = np.argsort(x, kind="stable")
        axes.plot(
            x[path], y[path], color=_colour(k), lw=1.7, ls=LINES[k % len(LINES)], marker="o", ms=3,
            markevery=[int(j) for j, p in enumerate(path) if p < len(at)], label=label,
        )  # fmt: skip
        axes.plot(at[~steady], values[~steady], color=_colour(k), ls="none", marker="x", ms=5, mew=1.1, alpha=0.8)
        axes.plot(edges, ends, color=_colour(k), ls="none", marker="|", ms=15, mew=2.2)
        shown = y[np.isfinite(y)]
        top, least = max(top, shown.max(initial=0.0)), min(least, shown.min(initial=np.inf))
    if least > 0.0 and top > WIDE * least:
        axes.set_yscale("log")
        axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axes.yaxis.set_minor_locator(NullLocator())
    elif top > 0.0:
        axes.set_ylim(0.0, 1.15 * top)
    axes.plot([], [], color=style.QUIET, ls="none", marker="|", ms=11, mew=2.0, label="stability ends here")
    axes.plot([], [], color=style.QUIET, ls="none", marker="x", ms=5, label="unstable")
    dress(axes, _title(axis))


def rims(numbers: Floats) -> Floats:
    """Rims of fields about sorted numbers, half-way between them."""
    inner = (numbers[1:] + numbers[:-1]) / 2
    return np.concatenate(([numbers[0] - (inner[0] - numbers[0])], inner, [numbers[-1] + (numbers[-1] - inner[-1])]))


def _map(axes: Axes, sweep: LimbSweep) -> list[Patch | Line2D]:
    across, up = sweep.axes
    assert across.numbers is not None and up.numbers is not None
    shape = (len(across.numbers), len(up.numbers))
    place = {label: k for k, label in enumerate(sweep.labels)}
    winners = [sweep.winner(k) for k in range(len(sweep.points))]
    field = np.array([-1 if name is None else place[name] for name in winners]).reshape(shape)
    columns, rows = np.argsort(across.numbers), np.argsort(up.numbers)
    x, y = np.array(across.numbers)[columns], np.array(up.numbers)[rows]
    field = field[np.ix_(columns, rows)].T
    shades = ListedColormap([NONE, *(_colour(k) for k in range(len(place)))])
    axes.pcolormesh(
        rims(x), rims(y), field + 1, cmap=shades, vmin=-0.5, vmax=len(place) + 0.5, alpha=0.45, edgecolor=style.PAPER, lw=0.8,
    )  # fmt: skip
    left, low = rims(x), rims(y)
    for row, column in np.argwhere(field < 0):
        axes.fill(
            left[[column, column + 1, column + 1, column]], low[[row, row, row + 1, row + 1]],
            fill=False, hatch="////", edgecolor=style.QUIET, lw=0.0,
        )  # fmt: skip
    for k, label in enumerate(sweep.labels):
        _boundary(axes, sweep, k, label)
    axes.set_xlim(left[0], left[-1])
    axes.set_ylim(low[0], low[-1])
    axes.set_xlabel(_title(across))
    axes.set_ylabel(_title(up))
    axes.set_xticks(x[:: -(-len(x) // MOST_TICKS)])
    axes.set_yticks(y[:: -(-len(y) // MOST_TICKS)])
    axes.tick_params(length=0)
    for spine in axes.spines.values():
        spine.set_visible(False)
    return _legend(sweep)


def _boundary(axes: Axes, sweep: LimbSweep, k: int, label: str) -> None:
    """The lowest boundary of a law at each value of the other axis, joined where it has one at every neighbour."""
    scan = next(axis for axis in sweep.axes if axis.key == sweep.scan)
    other = next(axis for axis in sweep.axes if axis is not scan)
    assert other.numbers is not None
    mine = [each for each in sweep.boundaries if each.label == label]
    lowest = [
        min((each.at for each in mine if each.beside == value), default=np.nan) for value in sorted(other.numbers)
    ]
    line = (sorted(other.numbers), lowest) if scan is sweep.axes[1] else (lowest, sorted(other.numbers))
    axes.plot(*line, color=style.PAPER, lw=3.4, zorder=4)
    axes.plot(*line, zorder=5, **_limit(k))


def _legend(sweep: LimbSweep) -> list[Patch | Line2D]:
    wins = sweep.wins()
    bounded = {each.label for each in sweep.boundaries}
    out: list[Patch | Line2D] = [
        Patch(facecolor=_colour(k), alpha=0.45, label=f"best: {label}")
        for k, label in enumerate(sweep.labels)
        if wins[label]
    ]
    if sum(wins.values()) < len(sweep.points):
        out.append(Patch(facecolor=NONE, hatch="////", edgecolor=style.QUIET, lw=0.0, label="no law is stable"))
    for k, label in enumerate(sweep.labels):
        if label in bounded:
            out.append(Line2D([], [], label=f"{label}: limit", **_limit(k)))
    return out


COLUMNS: Final = 4
CALM: Final = "#DCEBF5"
"""Fill of where the limb comes to rest."""


def draw_tuning(result: Tuning, path: str | Path) -> None:
    """Draw a panel for each law: limit, linear limit, recommended gains."""
    columns = min(COLUMNS, len(result.laws))
    rows = math.ceil(len(result.laws) / columns)
    with drawing(path, (max(5.0, 2.6 * columns), 0.9 + 2.5 * rows)) as figure:
        grid = figure.subplots(rows, columns, squeeze=False).ravel()
        for axes, law in zip(grid, result.laws, strict=False):
            _panel(axes, law)
        for axes in grid[len(result.laws) :]:
            axes.set_visible(False)
        legend_below(figure, grid[0], COLUMNS)
        title = f"Largest stable gains, {result.limb.robot.name}'s {result.limb.name} limb"
        under = f"{plant_words(result.flaws)}; margin {result.margin:g}"
        height = figure.get_figheight()
        head(figure, title, under, room=1.0 - 0.55 / height, tops=(1.0 - 0.08 / height, 1.0 - 0.32 / height))


def _panel(axes: Axes, law: Tuned) -> None:
    edges = sorted(law.edges, key=lambda edge: edge.damping_time)
    kp, times = np.array([edge.kp for edge in edges]), np.array([edge.damping_time for edge in edges])
    linear = np.array([edge.linear_kp for edge in edges])
    for edge in edges:  # what was searched: rays of equal kd/kp
        axes.plot([0.0, edge.kp], [0.0, edge.kp * edge.damping_time], color=style.PAPER, lw=0.8, zorder=2)
    axes.fill([0.0, *kp], [0.0, *(kp * times)], color=CALM, lw=0, zorder=1, label="comes to rest")
    line: dict[str, Any] = {"color": style.PARTS[0], "zorder": 3}
    axes.plot(kp, kp * times, lw=1.6, marker="o", ms=3, label="limit, simulated with play and friction", **line)
    axes.plot(linear, linear * times, lw=1.0, ls=(0, (4, 2)), color=style.INK, zorder=3, label="limit, linear")
    limit = law.limit_kp
    axes.plot([law.kp, limit], [law.kd, limit * law.damping_time], color=style.ALERT, lw=1.0, zorder=4)
    axes.plot([law.kp], [law.kd], color=style.ALERT, marker="o", ms=5, ls="none", zorder=5, label="recommended")
    axes.annotate(
        f"{law.kp:.4g}, {law.kd:.3g}", (law.kp, law.kd), xytext=(6, -3), textcoords="offset points", fontsize=7.5, va="top",
        color=style.ALERT, zorder=6,
    )  # fmt: skip
    axes.set_title(law.law, fontsize=8.5)
    axes.set_xlim(0.0, 1.08 * max(kp.max(), linear.max()))
    axes.set_ylim(0.0, 1.12 * max((kp * times).max(), (linear * times).max()))
    name = law.law.partition(":")[0]
    axes.set_xlabel(f"kp [{gain_unit(name, 'kp')}]", fontsize=8)
    axes.set_ylabel(f"kd [{gain_unit(name, 'kd')}]", fontsize=8)
    axes.locator_params(nbins=4)
    bare(axes)
