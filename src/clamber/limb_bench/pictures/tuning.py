"""A tuning as a picture: for each law, where in kp and kd the limb comes to rest, and the gains that are recommended."""

import math
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes

from ...sim.flaw_texts import plant_words
from ...viewing import style
from ...viewing.output import drawing
from ...viewing.style import bare
from ..entries import gain_unit
from ..tune import Tuned, Tuning
from .panels import head, legend_below

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
