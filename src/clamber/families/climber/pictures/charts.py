"""Curves: how a search got on over its generations, and how plans load their joints."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from matplotlib.ticker import MaxNLocator

from ....planning.problem.problem import Replay
from ....types import Floats
from ....units import OZ_IN
from ....viewing import style
from ....viewing.output import drawing
from ....viewing.scene import halo
from ..planning.task import LimbedTask
from .torques import torque_limits


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
        path: A file (.png, .svg, .pdf).
        goals: Names of sub-goals and goal, in order; each is marked at the generation that first meets it.

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
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
        path: A file (.png, .svg, .pdf).
        limit: Torque limit to draw [N m]; None: the smallest of the robot's joints.

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
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
