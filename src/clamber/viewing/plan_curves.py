"""Curves of plans: how a search got on over its generations, how plans load their joints, what one cost gives for the other."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
from matplotlib.ticker import MaxNLocator

from ..family import NotOfFamilyError, family_of
from ..planning.exact.front import Front
from ..planning.problem.problem import Replay
from ..planning.problem.problems import PlanCost, plan_family
from ..shown_units import units_of
from ..tasks import Task
from . import style
from .output import drawing
from .pictures import pictures_of
from .scene import halo
from .style import bare

if TYPE_CHECKING:
    from ..planning.genetic.evolve import Generation


def draw_history(history: Sequence["Generation"], path: str | Path, *, goals: Sequence[str] = ()) -> None:
    """Draw how fitness and furthest progress grew over the generations of a search.

    Args:
        history: One entry per generation.
        path: Picture file (`drawing`).
        goals: Names of sub-goals and goal, in order; each is marked at the generation that first meets it.
    """
    with drawing(path, (7.2, 4.8)) as figure:
        upper, lower = figure.subplots(2, 1, sharex=True)
        number = [entry.generation for entry in history]
        stages = np.array([entry.stage for entry in history])
        furthest = [entry.furthest for entry in history]
        upper.plot(number, furthest, color=style.PARTS[0], lw=1.8, drawstyle="steps-post")
        top = 1.3 * max([*furthest, 1])
        upper.set_ylim(0.0, top)
        for k, goal in enumerate(goals, start=1):
            met = np.nonzero(stages >= k)[0]
            if not len(met):
                continue
            at = number[int(met[0])]
            for axes in (upper, lower):
                axes.axvline(at, color=style.GOAL, lw=1.0, ls="-" if k == len(goals) else (0, (4, 3)), zorder=0.5)
            # labels on rows of their own, for goals are often met close together
            left = at <= 0.6 * max(number[-1], 1)
            upper.annotate(
                goal, (at, top), xytext=(3 if left else -3, -3 - 9 * ((k - 1) % 3)), textcoords="offset points",
                va="top", ha="left" if left else "right", fontsize=8, color="#4F6B20", path_effects=[halo()],
            )  # fmt: skip
        upper.set_ylabel("actions that hold")
        upper.yaxis.set_major_locator(MaxNLocator(integer=True, nbins=5))
        upper.set_title("How far the best plan gets, generation by generation (green: goals met)")
        lower.plot(
            number, [entry.best_fitness for entry in history], color=style.PARTS[2], lw=1.8, drawstyle="steps-post"
        )
        lower.set(ylabel="best fitness", xlabel="generation")
        lower.xaxis.set_major_locator(MaxNLocator(integer=True))
        for axes in (upper, lower):
            style.ruled(axes, "y", behind=True)


def draw_torques(task: Task, replays: Mapping[str, Replay], path: str | Path) -> None:
    """Draw the largest joint torque of every step of one or more plans, as figure 2.18 of Bevly's thesis does for two.

    Args:
        task: The task of all of them; the line is the smallest limit of its joints.
        replays: Label -> the plan carried out.
        path: Picture file (`drawing`).

    Raises:
        NotOfFamilyError: If its robot has no joint torques.
    """
    limits = pictures_of(task).torque_limits
    if limits is None:
        raise NotOfFamilyError(family_of(task).title, "joint torques")
    limit, plans = float(limits(task).min()), family_of(task).plans
    unit, size, digits = units_of(task.document).torque
    with drawing(path, (7.6, 4.0)) as figure:
        axes = figure.subplots()
        most = limit
        for k, (label, replay) in enumerate(replays.items()):
            torques = np.array([plans.torque(stance) for stance in replay.stances[1:]])
            most = max(most, float(torques.max(initial=0.0)))
            peak = f"{label}: largest {torques.max(initial=0.0) / size:.{digits}f} {unit}"
            steps = np.arange(1, len(torques) + 1)
            line = ("-", (0, (4, 1.5)), (0, (1, 1)), (0, (6, 1.5, 1, 1.5)))[k % 4]
            axes.plot(steps, torques / size, color=style.PARTS[k % 8], lw=1.5, ls=line, label=peak)
            top = int(np.argmax(torques)) if len(torques) else 0
            if len(torques):
                axes.plot(steps[top], torques[top] / size, marker="o", ms=5, color=style.PARTS[k % 8])
        axes.axhline(limit / size, color=style.ALERT, lw=1.0)
        words = f"limit {limit / size:.{digits}f} {unit}"
        axes.annotate(
            words, (1.0, limit / size), xycoords=("axes fraction", "data"), xytext=(-3, 3), textcoords="offset points",
            ha="right", fontsize=8, color=style.ALERT,
        )  # fmt: skip
        axes.set_ylim(0.0, 1.12 * most / size)
        axes.set_xlim(left=0.0)
        axes.set(xlabel="step", ylabel=f"largest joint torque [{unit}]")
        axes.set_title("Largest joint torque of every step")
        style.ruled(axes, "y", behind=True)
        figure.legend(loc="outside lower center", ncols=2 if len(replays) > 1 else 1, fontsize=8)


LENGTH: Final = PlanCost(feature="length", title="actions of the plan", unit="")


def draw_front(front: Front, path: str | Path) -> None:
    """Draw the plans of a front as steps: left of and below the line there is none.

    Args:
        front: From `plan_front`.
        path: Picture file (`drawing`).
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
            axes.set(xlim=(ends[0], ends[-1]), ylim=(low, high))
            proved = "no plan lies here" if front.complete else "no plan found here"
            axes.text(0.06, 0.06, proved, transform=axes.transAxes, color=style.QUIET)
        axes.set(xlabel=_label(costs[front.costs[0]]), ylabel=_label(costs[front.costs[1]]))
        for name, axis in zip(front.costs, (axes.xaxis, axes.yaxis), strict=True):
            if name == "length":
                axis.set_major_locator(MaxNLocator(integer=True))
        state = "complete" if front.complete else "as far as it was searched"
        figure.suptitle(front.task.title, x=0.012, ha="left", fontsize=11, fontweight="bold")
        axes.set_title(f"{front.costs[0]} against {front.costs[1]}, {state}", fontsize=9, fontweight="normal")
        figure.supxlabel(f"proved for: {front.model}", fontsize=6.5, color=style.QUIET, wrap=True)


def _label(cost: PlanCost) -> str:
    return f"{cost.title} [{cost.unit}]" if cost.unit else cost.title
