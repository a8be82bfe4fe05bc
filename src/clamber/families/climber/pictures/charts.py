"""Charts of studies and trials: shortest plans by the cone of hooks, success of many climbs."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, PercentFormatter

from ....shown_units import SI, ShownUnits
from ....trials.sensitivity import VERDICTS, Effect
from ....viewing import style
from ....viewing.output import CANVASES, check_suffix, drawing, save_figure
from ....viewing.style import bare, styled
from ..trials.noise import NOISE
from ..trials.trial_summary import Spread, TrialSummary

APART: Final = 0.05
"""Least distance of two names, as a part of the height."""


def draw_cones(lengths: Mapping[str, Mapping[float, int | None]], path: str | Path) -> None:
    """Draw one curve per board.

    Args:
        lengths: Board -> half angle of the cone [deg] -> actions of the shortest plan, None where there is none.
        path: Picture file (`drawing`).
    """
    with drawing(path, (7.2, 4.8)) as figure:
        axes = figure.subplots()
        bare(axes)
        ends: list[tuple[float, str, str]] = []
        for k, (board, by_cone) in enumerate(lengths.items()):
            colour = style.PARTS[k % len(style.PARTS)]
            known = [(degrees, length) for degrees, length in sorted(by_cone.items()) if length is not None]
            none = [degrees for degrees, length in by_cone.items() if length is None]
            if not known:
                continue
            across, up = zip(*known, strict=True)
            axes.plot(across, up, color=colour, lw=1.6, marker="o", ms=3.5)
            if none:
                axes.plot(across[0], up[0], color=colour, ls="none", marker="|", ms=16, mew=2.2)
            axes.annotate(
                f"{across[0]:g}\N{DEGREE SIGN}", (across[0], up[0]), xytext=(0, 9), textcoords="offset points", ha="center",
                color=colour, fontsize=8.5,
            )  # fmt: skip
            ends.append((up[-1], board, colour))
        low, high = axes.get_ylim()
        for height, (_, board, colour) in zip(_apart(sorted(ends), APART * (high - low)), sorted(ends), strict=True):
            axes.annotate(
                board, (90.0, height), xytext=(7, 0), textcoords="offset points", va="center", color=colour, fontsize=8.5,
                annotation_clip=False,
            )  # fmt: skip
        axes.grid(axis="y", color=style.FAINT, lw=0.6)
        axes.set_axisbelow(True)
        axes.margins(y=0.08)
        axes.set(xlim=(0.0, 90.0), xticks=range(0, 91, 15))
        axes.yaxis.set_major_locator(MaxNLocator(integer=True))
        axes.set_xlabel("half angle of the cone about the grab direction [deg]")
        axes.set_ylabel("actions of the shortest plan")
        axes.set_title("Hooks that only pull: narrower cones, longer plans")
        figure.supxlabel(
            "bars and angles: the narrowest cone; left of them there is no plan, proved", fontsize=8, color=style.QUIET
        )


def _apart(ends: Sequence[tuple[float, str, str]], room: float) -> list[float]:
    """Heights of names, from below, none nearer than `room` to the one below it."""
    heights: list[float] = []
    for height, _, _ in ends:
        heights.append(height if not heights else max(height, heights[-1] + room))
    return heights


ACROSS: Final = 3
"""Keys of the noise beside each other."""
MOST_CAUSES: Final = 8
"""Bars; rarer causes are left to the table."""
SPREAD: Final = 0.75
"""Of a line showing a spread [in]."""
HEIGHT: Final = 1.8
"""Of a row of panels [in]."""


def draw_trials(summary: TrialSummary, path: str | Path, units: ShownUnits = SI) -> None:
    """Draw how often climbs succeed, by each key of the noise, and why they fail; of climbs that all did, what was measured.

    Args:
        summary: Of one climb or more.
        path: Of the picture (`drawing`).
        units: In which it is told.
    """
    check_suffix(path, CANVASES)
    with styled():
        save_figure(trials_figure(summary, units), path)


def trials_figure(summary: TrialSummary, units: ShownUnits = SI) -> Figure:
    """The picture as a figure."""
    effects = () if summary.n and summary.done == summary.n else summary.effects  # all succeeded, whatever was drawn
    spreads = () if effects else _spreads(summary, units)
    rows = -(-len(effects) // ACROSS)
    causes = summary.causes[:MOST_CAUSES]
    low = 0.8 + 0.24 * max(1, len(causes))
    high = HEIGHT * rows + SPREAD * len(spreads)
    figure = Figure(figsize=(7.6, 0.8 + high + low), layout="constrained")
    upper, lower = np.ravel(np.array(figure.subfigures(2, 1, height_ratios=(max(high, 0.01), low))))
    if summary.n:
        share = (100.0 * part for part in (summary.done / summary.n, *summary.interval))
        words = "{:.1f} % ({:.1f} to {:.1f} %, 95 %)".format(*share)
        title = f"'{summary.task}': {summary.done} of {summary.n} climbs succeeded, {words}"
    else:
        title = f"'{summary.task}': no climb ended"
    figure.suptitle(title, x=0.01, ha="left", fontsize=11, fontweight="bold")
    panels: list[Axes] = list(np.ravel(upper.subplots(rows, ACROSS, sharey=True, squeeze=False))) if rows else []
    for k, panel in enumerate(panels):
        if k < len(effects):
            _draw_effect(panel, effects[k], summary, first=k % ACROSS == 0)
        else:
            panel.set_visible(False)
    for axes, (words, scale, unit, spread) in zip(
        np.ravel(upper.subplots(len(spreads), 1, squeeze=False)) if spreads else (), spreads, strict=True
    ):
        _draw_spread(axes, words, scale, unit, spread)
    _draw_causes(lower.subplots(), summary)
    return figure


def _spreads(summary: TrialSummary, units: ShownUnits) -> tuple[tuple[str, float, str, Spread], ...]:
    """What was measured of climbs that were carried out: in words, in which unit, of what size."""
    small, size, _ = units.gap
    found = (
        ("time of a climb", 1.0, "s", summary.seconds),
        ("time for each 6 in of the body's way", 1.0, "s", summary.per_rung),
        ("how far the body ended off its goal", size, small, summary.short),
    )
    return tuple((words, scale, unit, spread) for words, scale, unit, spread in found if spread is not None)


def _draw_spread(axes: Axes, words: str, scale: float, unit: str, spread: Spread) -> None:
    """The middle of what was measured, and what all but 5 % at either end are between."""
    low, middle, high = (value / scale for value in (spread.low, spread.median, spread.high))
    axes.plot([low, high], [0.0, 0.0], color=style.PARTS[0], lw=2.2, solid_capstyle="butt", marker="|", ms=9)
    axes.plot([middle], [0.0], color=style.PARTS[0], ls="none", marker="o", ms=5.0)
    axes.set_title(f"{words} [{unit}]: median {middle:.3g}, 90 % between {low:.3g} and {high:.3g}", fontsize=9)
    axes.set_xlim(0.0, max(1.1 * high, 1.0))
    axes.set_yticks([])
    style.bare(axes)
    axes.spines["left"].set_visible(False)


def _draw_effect(axes: Axes, effect: Effect, summary: TrialSummary, *, first: bool) -> None:
    """Success of each third at the middle of what it drew, over the band of all climbs."""
    kind = NOISE[effect.key]
    axes.axhspan(*summary.interval, color=style.FAINT, lw=0.0)
    if summary.n:
        axes.axhline(summary.done / summary.n, color=style.QUIET, lw=0.8)
    told = effect.verdict not in ("too few", "none")
    colour = style.ALERT if told else style.PARTS[0]
    at = [(third.low + third.high) / 2.0 / kind.scale for third in effect.thirds]
    for x, third in zip(at, effect.thirds, strict=True):
        low, high = third.interval
        axes.plot([third.low / kind.scale, third.high / kind.scale], [third.done / third.n] * 2, color=colour, lw=2.2)
        axes.plot([x, x], [low, high], color=colour, lw=1.0)
    axes.plot(at, [third.done / third.n for third in effect.thirds], color=colour, ls="none", marker="o", ms=4.0)
    axes.set_ylim(-0.02, 1.02)
    axes.yaxis.set_major_formatter(PercentFormatter(1.0, decimals=0))
    axes.xaxis.set_major_locator(MaxNLocator(nbins=5))
    which = ", largest" if kind.many else ""
    axes.set_title(f"{effect.key.replace('_', ' ')}{which} [{kind.unit}]", fontsize=9)
    axes.set_xlabel(VERDICTS[effect.verdict], fontsize=7, color=colour if told else style.QUIET)
    if first:
        axes.set_ylabel("success")
    style.bare(axes)


def _draw_causes(axes: Axes, summary: TrialSummary) -> None:
    """A bar for each way in which climbs ended early."""
    causes = summary.causes[:MOST_CAUSES]
    axes.set_title("What ended the climbs that failed, of all climbs", fontsize=9)
    if not causes:
        axes.text(0.0, 0.5, "none failed", transform=axes.transAxes, color=style.QUIET)
        axes.set_axis_off()
        return
    at = np.arange(len(causes))[::-1]
    for y, cause in zip(at, causes, strict=True):
        axes.barh(y, cause.n / cause.of, height=0.6, color=style.PARTS[1])
        axes.plot(cause.interval, [y, y], color=style.INK, lw=1.0)
        axes.text(cause.interval[1], y, f"  {cause.n}", va="center", fontsize=8)
    axes.set_yticks(at, [cause.words for cause in causes])
    axes.set_ylim(-0.6, len(causes) - 0.4)
    axes.set_xlim(left=0.0)
    axes.xaxis.set_major_formatter(PercentFormatter(1.0, decimals=0))
    style.bare(axes)
