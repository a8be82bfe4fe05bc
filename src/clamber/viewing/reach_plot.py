"""The reachable space as a picture: each place of the body in the colour of a layer, holds, goals, and what closes the edge."""

import textwrap
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from ..planning.reach.reach import LAYERS, Reach
from ..shown_units import units_of
from ..types import Floats
from . import style
from .output import CANVASES, check_suffix, save_figure
from .pictures import pictures_of
from .scene import fit_bounds, halo
from .style import styled

WIDEST, HIGHEST, NARROWEST = 7.4, 6.4, 4.9
"""Room for the world, and least width of the texts [in]."""
LEFT, RIGHT, HEAD, FOOT = 0.55, 1.15, 0.88, 1.12
"""Room around it for its axis, the colour bar, the title, legend and caption [in]."""
TAIL: Final = 98.0
"""Where the largest value is over twice this percentile, all beyond it share a colour: a stretched limb carries almost anything [%]."""
CLOSERS: Final = ("#D55E00", "#CC79A7", "#8C564B", "#6B6B6B", "#C1272D", "#E69F00", "#56B4E9", "#B5A900")
"""Colours of the edge by the check that closes it, in the order of the family's checks, over and over."""


def draw_reach(reach: Reach, layer: str, path: str | Path) -> None:
    """Draw the places that the body can reach in the colours of a layer.

    Args:
        reach: The reachable space.
        layer: One of the layers of the robot's family.
        path: Picture file (`drawing`).
    """
    check_suffix(path, CANVASES)
    with styled():
        save_figure(reach_figure(reach, layer), path)


def reach_figure(reach: Reach, layer: str) -> Figure:
    """The picture as a figure."""
    task: Any = reach.task
    world = pictures_of(task)
    cell = float(reach.lattice.step[0])
    spots = np.stack([reach.places.floats(axis.column) for axis in reach.lattice.axes[:2]], axis=1)
    chart = world.chart or world
    bounds = fit_bounds(np.vstack([chart.points(task), spots - cell, spots + cell]), task.goals)
    across, up = bounds[1] - bounds[0], bounds[3] - bounds[2]
    scale = min(WIDEST / across, HIGHEST / up)
    wide, high = across * scale, up * scale
    size = LEFT + max(wide, NARROWEST) + RIGHT, HEAD + high + FOOT
    figure = Figure(figsize=size)
    figure.set_facecolor(style.PAPER)

    def place(x: float, y: float, w: float, h: float) -> tuple[float, float, float, float]:
        return x / size[0], y / size[1], w / size[0], h / size[1]

    axes = figure.add_axes(place(LEFT, FOOT, wide, high))
    chart.world(axes, task, bounds)
    shown = _field(axes, reach, layer)
    handles = [*_edge(axes, reach), *_marks(axes, reach)]
    _colour_bar(figure, figure.add_axes(place(LEFT + wide + 0.16, FOOT, 0.16, high)), shown, reach, layer)
    figure.text(*place(LEFT, size[1] - 0.12, 0, 0)[:2], _title(layer), fontsize=11, weight="bold", va="top")
    figure.text(
        *place(LEFT, size[1] - 0.36, 0, 0)[:2],
        _subtitle(reach),
        fontsize=8.5,
        va="top",
        color=style.QUIET,
        linespacing=1.35,
    )
    room = size[0] - LEFT - 0.2
    figure.legend(
        handles=handles, loc="upper left", bbox_to_anchor=place(LEFT - 0.06, FOOT - 0.38, 0, 0)[:2], fontsize=7.5,
        ncols=max(2, int(room / 1.42)), borderaxespad=0.0, handlelength=1.6, columnspacing=1.3, handletextpad=0.5,
    )  # fmt: skip
    left_out = " Hangs, which the task allows, are left out." if reach.without_hangs else ""
    caption = textwrap.fill(f"Holds for: {reach.model}.{left_out}", int(room * 19))
    figure.text(*place(LEFT, 0.1, 0, 0)[:2], caption, fontsize=6.5, va="bottom", color=style.QUIET)
    return figure


def _title(layer: str) -> str:
    words = LAYERS[layer].title
    return f"{words[0].upper()}{words[1:]}"


def _subtitle(reach: Reach) -> str:
    counts = f"{reach.stances} stances, {len(reach.poses)} poses at {len(reach.places)} places"
    goal = "" if reach.goal_reached else ", the goal is not among them"
    seen = (
        f"all that can be reached{goal}" if reach.status == "complete" else f"incomplete, {reach.reason.split(':')[0]}"
    )
    return f"{reach.task.title or reach.task.name}\n{counts}: {seen}"


def _shown(reach: Reach, layer: str) -> tuple[Floats, str, str]:
    """Values of the places, the unit that people read them in, and its name on the colour bar."""
    column = LAYERS[layer].column
    values = reach.places.floats(column)
    if column.endswith("_Nm"):
        unit, size, _ = units_of(reach.task.document).torque
        return values / size, unit, f"torque [{unit}]"
    if column == "margin":
        return 100.0 * values, "%", "margin [% of what is limited]"
    name, _, unit = column.partition("_")[2].rpartition("_")
    unit = "" if unit == "step" else unit
    return values, unit, f"{name.replace('_', ' ')} [{unit}]" if unit else "actions from the start"


def _field(axes: Axes, reach: Reach, layer: str) -> AxesImage:
    """Colour the cell of each place."""
    lattice, cell = reach.places.lattice, float(reach.lattice.step[0])
    values, _, _ = _shown(reach, layer)
    low, high = lattice.min(axis=0), lattice.max(axis=0)
    field = np.full((high[1] - low[1] + 1, high[0] - low[0] + 1), np.nan)
    field[lattice[:, 1] - low[1], lattice[:, 0] - low[0]] = np.where(np.isinf(values), 1e300, values)
    finite = values[np.isfinite(values)]
    if len(finite) == 0:
        finite = np.zeros(1)
    tail, top = float(np.percentile(finite, TAIL)), float(finite.max())
    top = tail if top > 2.0 * tail > 0.0 else top
    bottom = float(finite.min())
    edges = (low[0] - 0.5, high[0] + 0.5, low[1] - 0.5, high[1] + 0.5)
    origin = np.repeat(reach.lattice.origin[:2], 2)
    window = axes.get_xlim(), axes.get_ylim()
    shown = axes.imshow(
        np.ma.masked_invalid(field),
        origin="lower",
        extent=tuple(at + edge * cell for at, edge in zip(origin, edges, strict=True)),
        interpolation="none",
        cmap="viridis" if LAYERS[layer].good else "viridis_r",  # dark is hard in every layer
        norm=Normalize(bottom, top if top > bottom else bottom + 1.0),
        zorder=0.55,  # over the goals' filling, under their outline
    )
    axes.set(xlim=window[0], ylim=window[1])
    return shown


def _edge(axes: Axes, reach: Reach) -> list[Artist]:
    """Outline the places; where all were seen, each side in the colour of the check that forbids most body moves across it."""
    cell, start = float(reach.lattice.step[0]), reach.lattice.origin
    inside = set(map(tuple, reach.places.lattice.tolist()))
    rim = zip(reach.rim.lattice.tolist(), reach.rim.forbidden, strict=True) if reach.status == "complete" else ()
    closers = {(x, y): int(np.argmax(row)) for (x, y), row in rim}
    sides: dict[int, list[Floats]] = {}
    for x, y in sorted(inside):
        for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            if (x + dx, y + dy) in inside:
                continue
            middle = start[:2] + cell * np.array((x + 0.5 * dx, y + 0.5 * dy))
            along = 0.5 * cell * np.array([dy, dx])
            sides.setdefault(closers.get((x + dx, y + dy), -1), []).append(np.stack([middle - along, middle + along]))
    every = [side for group in sides.values() for side in group]
    axes.add_collection(LineCollection(every, colors=style.PAPER, linewidths=3.6, zorder=1.1, capstyle="projecting"))
    handles: list[Artist] = []
    for check in sorted(sides, key=lambda check: (check < 0, -len(sides[check]), check)):
        colour = CLOSERS[check % len(CLOSERS)] if check >= 0 else style.INK
        axes.add_collection(
            LineCollection(sides[check], colors=colour, linewidths=2.0, zorder=1.2, capstyle="projecting")
        )
        words = "no move leads on" if reach.status == "complete" else "seen so far"
        if check >= 0:
            words = f"closed by {reach.rim.checks[check].replace('_', '-')}"
        handles.append(Line2D([], [], color=colour, lw=2.0, label=words))
    return handles


def _marks(axes: Axes, reach: Reach) -> list[Artist]:
    """Mark the start, and the holds that nobody can ever use."""
    task: Any = reach.task
    handles: list[Artist] = []
    (mark,) = axes.plot(
        *reach.lattice.origin[:2], marker="o", ms=6.5, mfc=style.PAPER, mec=style.INK, mew=1.6, ls="", zorder=6,
        label="body at the start",
    )  # fmt: skip
    handles.append(mark)
    chart = pictures_of(task).chart
    if chart is not None and reach.holds:
        handles += _limbs_at(axes, reach, chart.points(task))
    if reach.never_used:
        never = [hold.number in reach.never_used for hold in task.world.holds]
        places = [(hold.x, hold.y) for hold in task.world.holds] if chart is None else chart.points(task)
        spots = np.array(places)[never]
        crosses = axes.scatter(
            spots[:, 0], spots[:, 1], marker="x", s=34, lw=1.7, color=style.ALERT, zorder=6, label="hold never used",
            path_effects=[halo(1.0)],
        )  # fmt: skip
        handles.append(crosses)
    return handles


def _limbs_at(axes: Axes, reach: Reach, places: Floats) -> list[Artist]:
    """Mark the holds that limbs can use, the larger the more limbs can."""
    many = np.array([len(hold.limbs) for hold in reach.holds])
    handles: list[Artist] = []
    for count in sorted(set(many[many > 0].tolist())):
        (marks,) = axes.plot(
            *places[many == count].T, marker="o", ms=2.0 + 0.9 * count, mfc="none", mec=style.INK, mew=0.9, ls="", zorder=5,
            label=f"hold of {count} limb{'s' if count > 1 else ''}", path_effects=[halo(0.6)],
        )  # fmt: skip
        handles.append(marks)
    return handles


def _colour_bar(figure: Figure, axes: Axes, shown: AxesImage, reach: Reach, layer: str) -> None:
    """A bar in the layer's unit; torques with their limit, where all joints have the same."""
    values, _, words = _shown(reach, layer)
    beyond = bool(np.any(values > shown.get_clim()[1] * (1.0 + 1e-12)))
    bar = figure.colorbar(shown, cax=axes, extend="max" if beyond else "neither")
    bar.outline.set_visible(False)
    bar.set_label(words, fontsize=8)
    bar.locator = MaxNLocator(nbins=8, integer=layer == "steps")
    bar.update_ticks()
    torque_limits = pictures_of(reach.task).torque_limits
    if layer == "force" and torque_limits is not None:
        limits = torque_limits(reach.task)
        if np.ptp(limits) == 0.0:
            limit = float(limits.flat[0]) / units_of(reach.task.document).torque[1]
            bar.set_label(f"{words[:-1]}; limit {limit:.4g}]", fontsize=8)
