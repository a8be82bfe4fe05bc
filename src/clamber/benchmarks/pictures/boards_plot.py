"""The benchmark of boards as a picture: boards solved over actions judged, and how much longer than the optimum the plans are."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter

from ...viewing import style
from ...viewing.output import drawing
from ..contest import Contest, Truth
from ..tables import Standing, ranking

LINES: Final = ("-", (0, (5, 1.5)), (0, (1.2, 1.2)))
"""The first eight planners have colours of their own, the next ones the same colours in dashes."""
FAR: Final = 1e12
"""Checks beyond any axis: a curve goes on at its last height."""
SPREAD: Final = 0.32
"""Half the height over which a planner's dots are scattered, so that they don't hide each other."""


def draw_boards(contest: Contest, path: str | Path) -> None:
    """Draw how soon each planner solves the boards, and how long its plans are.

    Args:
        contest: All trials.
        path: A file (.png, .svg, .pdf).

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    truths = contest.truths()
    order = ranking(contest, truths)
    looks = {
        contender.name: {"color": style.PARTS[k % len(style.PARTS)], "ls": LINES[k // len(style.PARTS) % len(LINES)]}
        for k, contender in enumerate(contest.contenders)
    }
    with drawing(path, (9.6, 2.6 + 0.24 * max(8, len(order)))) as figure:
        left, right = figure.subplots(1, 2, width_ratios=(1.25, 1.0))
        _solved(left, contest, truths, order, looks)
        _gaps(right, order, looks)
        figure.legend(loc="outside lower center", ncols=min(7, len(order)), fontsize=8)


def _solved(axes: Axes, contest: Contest, truths: dict[str, Truth], order: Sequence[Standing], looks: Any) -> None:
    """Share of trials, on boards that have a plan, that found one, over the actions judged up to it."""
    most = contest.allowance.checks
    for one in order:
        trials = [trial for trial in contest.of(one.contender) if truths[trial.case].feasible]
        costs = np.sort([trial.cost for trial in trials if trial.length is not None])
        most = max(most, int(costs.max(initial=0)))
        share = 100.0 * np.arange(len(costs) + 1) / max(1, len(trials))
        axes.step(
            [*costs[:1], *costs, FAR],
            [*share, share[-1]] if len(costs) else [0.0],
            where="post",
            lw=1.8,
            label=one.contender,
            **looks[one.contender],
        )
    axes.axvline(contest.allowance.checks, color=style.QUIET, lw=0.8, ls=(0, (4, 3)))
    axes.annotate(
        "allowance", (contest.allowance.checks, 1.0), xycoords=("data", "axes fraction"), xytext=(0, 3),
        textcoords="offset points", ha="center", fontsize=8, color=style.QUIET,
    )  # fmt: skip
    axes.set_xscale("log")
    axes.set_xlim(100.0, 1.3 * most)
    axes.set_ylim(0.0, 104.0)
    axes.set_xlabel("actions judged up to the first plan")
    axes.set_ylabel("trials that found a plan [%]")
    boards = sum(truth.feasible is True for truth in truths.values())
    axes.set_title(f"Solved, of {boards} boards that have a plan")
    style.ruled(axes)
    axes.set_axisbelow(True)


def _gaps(axes: Axes, order: Sequence[Standing], looks: Any) -> None:
    """Length above the optimum of every plan, a row a planner, the median as a bar."""
    for row, one in enumerate(order):
        gaps = 100.0 * np.array(sorted(one.gaps))
        height = row + SPREAD * np.sin(2.4 * np.arange(len(gaps)))  # steps of a golden angle, so neighbours part
        colour = looks[one.contender]["color"]
        axes.plot(gaps, height, ls="none", marker="o", ms=3.2, mew=0.0, alpha=0.55, color=colour)
        if len(gaps):
            axes.plot([100.0 * one.gap] * 2, [row - 0.42, row + 0.42], color=style.INK, lw=2.0, solid_capstyle="butt")
    axes.set_xscale("symlog", linthresh=10.0, linscale=0.6)
    axes.set_xlim(left=-1.0)
    axes.set_xticks([0, 5, 10, 20, 50, 100, 200, 500])
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.minorticks_off()
    top = max((100.0 * one.worst_gap for one in order if one.gaps), default=10.0)
    axes.set_xlim(right=max(20.0, 1.15 * top))
    axes.set_yticks(range(len(order)), [one.contender for one in order])
    axes.set_ylim(len(order) - 0.4, -0.6)
    axes.tick_params(axis="y", length=0, labelcolor=style.INK)
    axes.set_xlabel("actions above the optimum [%] (bar: median)")
    axes.set_title("How long the plans are")
    style.ruled(axes, "x")
    axes.set_axisbelow(True)
