"""What still pictures of whole plans share: ghosts along the way, the way itself, facts and strip in the panel."""

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection

from ..planning.problem.problem import Replay
from ..planning.problem.problems import normalisation_of, plan_family
from ..types import Floats
from . import style
from .margins import all_limiting, grade
from .panel import Place, StepStrip
from .scene import halo
from .view import PANEL_WIDTH

GHOSTS: Final = 6
"""Postures drawn between start and end, at most."""
FACTS: Final = 1.85
"""Height of the panel's facts and strip [in]."""
ROW: Final = 0.15
"""Of a row of small print [in]."""


def pick_ghosts(places: Floats, most: int = GHOSTS) -> list[int]:
    """Stances to draw: the start, the end, and between them some that are equally far apart along the body's way.

    Args:
        places: Place of the body in every stance, world frame [m], shape (n, 2).
        most: Largest number of stances between the ends.
    """
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(places, axis=0).T))])
    marks = np.linspace(0.0, way[-1], most + 2)
    return sorted({0, *(int(np.searchsorted(way, mark - 1e-9)) for mark in marks[1:-1]), len(places) - 1})


def label_ghost(wall: Axes, step: int, x: float, y: float, noun: str = "step") -> None:
    """Write the number of a step, or what else is counted, beside a ghost's place, world frame [m]."""
    wall.annotate(
        f"{noun} {step}" if step else "start", (x, y), xytext=(7, -9), textcoords="offset points",
        fontsize=6.5, color=style.INK, zorder=9, path_effects=[halo()],
    )  # fmt: skip


def draw_way(wall: Axes, way: Floats) -> None:
    """Draw the way of the body, world frame [m], shape (n, 2), dark at the start."""
    segments = list(np.stack([way[:-1], way[1:]], axis=1))
    wall.add_collection(LineCollection(segments, linewidths=3.4, colors=style.PAPER, zorder=7, capstyle="round"))
    line = LineCollection(segments, linewidths=1.8, cmap="viridis", zorder=7.1, capstyle="round")
    line.set_array(np.linspace(0.0, 0.85, len(segments)))  # the palest yellow would not show
    line.set_clim(0.0, 1.0)
    wall.add_collection(line)


def whole_title(kind: str, replay: Replay) -> str:
    """Title of the picture of a whole plan, walk or climb."""
    count = len(replay.reasons)
    return f"The whole {kind}: {count} action{'' if count == 1 else 's'}"


def count_actions(task: Any, replay: Replay) -> str:
    """How many actions a plan has, whether they hold, and that they do not reach the goal, where they don't."""
    actions, violated = len(replay.reasons), int(np.sum(replay.reasons >= 0))
    goals, met = len(task.goals), plan_family(task).goals_met(replay.stances[-1])
    held = f"{actions}, all of them hold" if replay.ok else f"{actions}, {violated} of them violated"
    return held if met >= goals else f"{held}; goal not reached ({met} of {goals})"


def write_facts(panel: Axes, task: Any, replay: Replay, facts: Sequence[tuple[str, str]], height: float) -> None:
    """Write what is to be said of a whole plan, its nearest limit and its strip at the top of the panel."""
    limits = all_limiting(normalisation_of(task), replay)
    worst = min((limit for limit in limits if limit is not None), key=lambda limit: limit.share, default=None)
    nearest = "not judged" if worst is None else f"{worst} at step {limits.index(worst) + 1}"
    for k, (name, words) in enumerate((("Actions", count_actions(task, replay)), *facts, ("Nearest limit", nearest))):
        panel.text(0.0, height - 0.2 * k, name, fontsize=8, va="top", color=style.QUIET)
        panel.text(1.05, height - 0.2 * k, words, fontsize=8, va="top")
    strip = StepStrip(panel, [grade(limit) for limit in limits], Place(0.0, height - 1.0, PANEL_WIDTH - 0.1))
    strip.update(len(limits))
