"""A front as a picture: what one cost gives for the other."""

from pathlib import Path
from typing import Final

from matplotlib.ticker import MaxNLocator

from ..planning.exact.front import Front
from ..planning.problem.problems import PlanCost, plan_family
from . import style
from .output import drawing
from .style import bare

LENGTH: Final = PlanCost(feature="length", title="actions of the plan", unit="")


def draw_front(front: Front, path: str | Path) -> None:
    """Draw the plans of a front as steps: left of and below the line there is none.

    Args:
        front: From `plan_front`.
        path: Of the picture (`drawing`).
    """
    with drawing(path, (7.2, 4.4)) as figure:
        axes = figure.subplots()
        bare(axes)
        costs = {"length": LENGTH, **plan_family(front.task).costs(front.task)}
        across, up = ([trade.costs[name] / costs[name].per_unit for trade in front.trades] for name in front.costs)
        axes.step(across, up, where="post", color=style.PARTS[0], lw=1.4, alpha=0.6)
        axes.plot(across, up, ls="none", marker="o", ms=5, color=style.PARTS[0])
        if front.trades:
            low, high = axes.get_ylim()
            room = 0.04 * (across[-1] - across[0] or 1.0)
            ends = [across[0] - room, *across, across[-1] + room]
            axes.fill_between(ends, [high, *up, up[-1]], low, step="post", color=style.FAINT, alpha=0.6, lw=0)
            axes.plot([across[0]] * 2, [high, up[0]], color=style.PARTS[0], lw=1.4, alpha=0.6)
            axes.plot(ends[-2:], [up[-1]] * 2, color=style.PARTS[0], lw=1.4, alpha=0.6)
            axes.set_xlim(ends[0], ends[-1])
            axes.set_ylim(low, high)
            proved = "no plan lies here" if front.complete else "no plan found here"
            axes.text(0.06, 0.06, proved, transform=axes.transAxes, color=style.QUIET)
        axes.set_xlabel(_label(costs[front.costs[0]]))
        axes.set_ylabel(_label(costs[front.costs[1]]))
        for name, axis in zip(front.costs, (axes.xaxis, axes.yaxis), strict=True):
            if name == "length":
                axis.set_major_locator(MaxNLocator(integer=True))
        state = "complete" if front.complete else "as far as it was searched"
        figure.suptitle(front.task.title, x=0.012, ha="left", fontsize=11, fontweight="bold")
        axes.set_title(f"{front.costs[0]} against {front.costs[1]}, {state}", fontsize=9, fontweight="normal")
        figure.supxlabel(f"proved for: {front.model}", fontsize=6.5, color=style.QUIET, wrap=True)


def _label(cost: PlanCost) -> str:
    return f"{cost.title} [{cost.unit}]" if cost.unit else cost.title
