"""Curves: searches over their generations, joints' loads by plan, shortest plans by the cone of hooks, success of many climbs."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final, Protocol

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, PercentFormatter

from ....planning.problem.problem import Replay
from ....types import Floats
from ....units import OZ_IN
from ....viewing import style
from ....viewing.output import CANVASES, check_suffix, drawing, save_figure
from ....viewing.scene import halo
from ....viewing.style import bare, styled
from ..planning.task import LimbedTask
from ..trials.noise import NOISE
from ..trials.sensitivity import VERDICTS, Effect
from ..trials.trial_summary import TrialSummary
from .artists import torque_limits


class Generation(Protocol):
    """What a picture needs to know of one generation of a search."""

    @property
    def generation(self) -> int:
        """Its number, from 0."""

    @property
    def best_fitness(self) -> float:
        """Best fitness so far [-]."""

    @property
    def furthest(self) -> int:
        """Actions that hold in the plan that got furthest."""

    @property
    def stage(self) -> int:
        """Goals that it meets."""


def draw_history(history: Sequence[Generation], path: str | Path, *, goals: Sequence[str] = ()) -> None:
    """Draw how fitness and furthest progress grew over the generations of a search.

    Args:
        history: One entry per generation.
        path: Of the picture (`drawing`).
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
        lower.set_ylabel("best fitness")
        lower.set_xlabel("generation")
        lower.xaxis.set_major_locator(MaxNLocator(integer=True))
        for axes in (upper, lower):
            style.bare(axes)
            axes.grid(axis="y", color=style.FAINT, lw=0.6)
            axes.set_axisbelow(True)


def largest_torques(task: LimbedTask, replay: Replay) -> Floats:
    """Largest |torque| over all joints after each action [N m], shape (n_actions,)."""
    torques: Floats = np.abs(replay.stances["torques"][1:, : len(task.robot.limbs)]).reshape(len(replay.reasons), -1)
    largest: Floats = torques.max(axis=1, initial=0.0)
    return largest


def _from_ounces(torque: Any) -> Any:
    return torque * OZ_IN


def _to_ounces(torque: Any) -> Any:
    return torque / OZ_IN


def draw_torques(
    task: LimbedTask, replays: Mapping[str, Replay], path: str | Path, *, limit: float | None = None
) -> None:
    """Draw the largest joint torque of every step of one or more plans, as figure 2.18 of Bevly's thesis does for two.

    Args:
        task: The task of all of them.
        replays: Label -> the plan carried out.
        path: Of the picture (`drawing`).
        limit: Torque limit to draw [N m]; None: the smallest of the robot's joints.
    """
    limit = float(torque_limits(task).min()) if limit is None else limit
    with drawing(path, (7.6, 4.0)) as figure:
        axes = figure.subplots()
        most = limit
        for k, (label, replay) in enumerate(replays.items()):
            torques = largest_torques(task, replay)
            most = max(most, float(torques.max(initial=0.0)))
            peak = f"{label}: largest {torques.max(initial=0.0) / OZ_IN:.0f} oz-in ({torques.max(initial=0.0):.2f} N m)"
            steps = np.arange(1, len(torques) + 1)
            line = ("-", (0, (4, 1.5)), (0, (1, 1)), (0, (6, 1.5, 1, 1.5)))[k % 4]
            axes.plot(steps, torques / OZ_IN, color=style.PARTS[k % 8], lw=1.5, ls=line, label=peak)
            top = int(np.argmax(torques)) if len(torques) else 0
            if len(torques):
                axes.plot(steps[top], torques[top] / OZ_IN, marker="o", ms=5, color=style.PARTS[k % 8])
        axes.axhline(limit / OZ_IN, color=style.ALERT, lw=1.0)
        words = f"limit {limit / OZ_IN:.0f} oz-in"
        axes.annotate(
            words, (1.0, limit / OZ_IN), xycoords=("axes fraction", "data"), xytext=(-3, 3), textcoords="offset points",
            ha="right", fontsize=8, color=style.ALERT,
        )  # fmt: skip
        axes.set_ylim(0.0, 1.12 * most / OZ_IN)
        axes.set_xlim(left=0.0)
        axes.set_xlabel("step")
        axes.set_ylabel("largest joint torque [oz-in]")
        metric = axes.secondary_yaxis("right", functions=(_from_ounces, _to_ounces))
        metric.set_ylabel("[N m]")
        metric.spines["right"].set_color(style.FAINT)
        axes.set_title("Largest joint torque of every step")
        axes.spines["top"].set_visible(False)
        axes.grid(axis="y", color=style.FAINT, lw=0.6)
        axes.set_axisbelow(True)
        figure.legend(loc="outside lower center", ncols=2 if len(replays) > 1 else 1, fontsize=8)


APART: Final = 0.05
"""Least distance of two names, as a part of the height."""


def draw_cones(lengths: Mapping[str, Mapping[float, int | None]], path: str | Path) -> None:
    """Draw one curve per board.

    Args:
        lengths: Board -> half angle of the cone [deg] -> actions of the shortest plan, None where there is none.
        path: Of the picture (`drawing`).
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
        axes.set_xlim(0.0, 90.0)
        axes.set_xticks(range(0, 91, 15))
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
HEIGHT: Final = 1.8
"""Of a row of panels [in]."""


def draw_trials(summary: TrialSummary, path: str | Path) -> None:
    """Draw how often climbs succeed, by each key of the noise, and why they fail.

    Args:
        summary: Of one climb or more.
        path: Of the picture (`drawing`).
    """
    check_suffix(path, CANVASES)
    with styled():
        save_figure(trials_figure(summary), path)


def trials_figure(summary: TrialSummary) -> Figure:
    """The picture as a figure."""
    rows = -(-len(summary.effects) // ACROSS)
    causes = summary.causes[:MOST_CAUSES]
    low = 0.8 + 0.24 * max(1, len(causes))
    figure = Figure(figsize=(7.6, 0.8 + HEIGHT * rows + low), layout="constrained")
    upper, lower = np.ravel(np.array(figure.subfigures(2, 1, height_ratios=(max(HEIGHT * rows, 0.01), low))))
    if summary.n:
        share = (100.0 * part for part in (summary.done / summary.n, *summary.interval))
        words = "{:.1f} % ({:.1f} to {:.1f} %, 95 %)".format(*share)
        title = f"'{summary.task}': {summary.done} of {summary.n} climbs succeeded, {words}"
    else:
        title = f"'{summary.task}': no climb ended"
    figure.suptitle(title, x=0.01, ha="left", fontsize=11, fontweight="bold")
    panels: list[Axes] = list(np.ravel(upper.subplots(rows, ACROSS, sharey=True, squeeze=False))) if rows else []
    for k, panel in enumerate(panels):
        if k < len(summary.effects):
            _draw_effect(panel, summary.effects[k], summary, first=k % ACROSS == 0)
        else:
            panel.set_visible(False)
    _draw_causes(lower.subplots(), summary)
    return figure


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
