"""One still picture of a whole climb: way of the body, ghosts of the robot along it, holds in the order of use."""

from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ..actions.problem import Replay
from ..tasks.limbed import LimbedTask
from ..types import Floats
from . import style
from .climber import ClimberArtists, Snapshot
from .geometry import Posture, postures
from .margins import all_limiting, grade
from .motion import Transition
from .output import CANVASES, check_suffix, save_figure
from .panel import Place, StepStrip, show_torque, torque_limits
from .scene import Bounds, draw_scene, find_bounds, halo
from .style import styled
from .view import EDGE, PANEL_WIDTH, WIDE, Layout
from .words import length_unit

GHOSTS: Final = 6
"""Postures drawn between start and end, at most."""
ARC: Final = 12
"""Points of the body's way within one swing."""
FACTS: Final = 1.85
"""Height of the panel's facts and strip [in]."""
ROW: Final = 0.15
"""Height of a row of small print [in]."""


def draw_limbed_route(task: LimbedTask, replay: Replay, path: str | Path) -> None:
    """Draw a whole climb as one picture (.png, .svg, .pdf).

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    check_suffix(path, CANVASES)
    with styled():
        save_figure(_route_figure(task, replay), path)


def _route_figure(task: LimbedTask, replay: Replay) -> Figure:
    shown = postures(task.robot, task.world, replay.stances)
    bounds = find_bounds(task, shown)
    uses = [
        wrap_words(f"{name}:  " + " › ".join(map(str, numbers)))
        for name, numbers in zip(task.robot.limb_names, holds_used(task, replay), strict=True)
    ]
    words = 0.4 + sum(ROW * len(rows) + 0.05 for rows in uses)
    below = bounds[1] - bounds[0] > WIDE * (bounds[3] - bounds[2])
    layout = Layout(bounds, max(words, FACTS) if below else FACTS + words, height=6.6)
    figure = Figure(figsize=layout.size)
    figure.set_facecolor(style.PAPER)
    wall = layout.axes(figure, layout.wall_at, layout.wall)
    draw_scene(wall, task, bounds)
    _draw_ghosts(wall, task, shown, bounds)
    _draw_way(wall, body_way(task, replay))
    panel = layout.axes(figure, layout.panel_at, layout.panel)
    width, height = layout.panel
    _write_facts(panel, task, replay, height)
    _write_uses(panel, uses, *((PANEL_WIDTH + 0.4, height) if layout.below else (0.0, height - FACTS)))
    panel.set_xlim(0.0, width)
    panel.set_ylim(0.0, height)
    panel.axis("off")
    w, h = layout.size
    title = f"The whole climb: {len(replay.reasons)} actions"
    figure.text(EDGE / w, 1 - 0.13 / h, title, fontsize=11, weight="bold", va="top")
    subtitle = f"{task.title}. Line: way of the body, dark at the start"
    figure.text(EDGE / w, 1 - 0.35 / h, subtitle, fontsize=8.5, va="top", color=style.QUIET)
    return figure


def _draw_ghosts(wall: Axes, task: LimbedTask, shown: list[Posture], bounds: Bounds) -> None:
    unloaded = np.zeros((len(task.robot.limbs), 2))
    last = len(shown) - 1
    for k in _ghosts(shown):
        climber = ClimberArtists(wall, task, bounds, alpha=1.0 if k == last else 0.3, arrows=False)
        climber.update(Snapshot(shown[k], unloaded, unloaded))
        if k < last:
            wall.annotate(
                f"step {k}" if k else "start", (shown[k].x, shown[k].y), xytext=(7, -9), textcoords="offset points",
                fontsize=6.5, color=style.INK, zorder=9, path_effects=[halo()],
            )  # fmt: skip


def _draw_way(wall: Axes, way: Floats) -> None:
    segments = list(np.stack([way[:-1], way[1:]], axis=1))
    wall.add_collection(LineCollection(segments, linewidths=3.4, colors=style.PAPER, zorder=7, capstyle="round"))
    line = LineCollection(segments, linewidths=1.8, cmap="viridis", zorder=7.1, capstyle="round")
    line.set_array(np.linspace(0.0, 0.85, len(segments)))  # the palest yellow would not show
    line.set_clim(0.0, 1.0)
    wall.add_collection(line)


def _write_facts(panel: Axes, task: LimbedTask, replay: Replay, height: float) -> None:
    limits = all_limiting(task, replay.margins, replay.reasons)
    worst = min((limit for limit in limits if limit is not None), key=lambda limit: limit.share, default=None)
    ounces = length_unit(task)[0] == "in"
    torque = float(np.max(np.abs(replay.stances["torques"][:, : len(task.robot.limbs)])))
    most = show_torque(torque, ounces=ounces)
    actions, violated = len(replay.reasons), int(np.sum(replay.reasons >= 0))
    facts = (
        ("Actions", f"{actions}, all of them hold" if replay.ok else f"{actions}, {violated} of them violated"),
        ("Hangs", str(int(replay.stances["hangs"][-1]))),
        ("Largest torque", f"{most} of {show_torque(float(torque_limits(task).max()), ounces=ounces)}"),
        ("Nearest limit", "not judged" if worst is None else f"{worst} at step {limits.index(worst) + 1}"),
    )
    for k, (name, words) in enumerate(facts):
        panel.text(0.0, height - 0.2 * k, name, fontsize=8, va="top", color=style.QUIET)
        panel.text(1.05, height - 0.2 * k, words, fontsize=8, va="top")
    strip = StepStrip(panel, [grade(limit) for limit in limits], Place(0.0, height - 1.0, PANEL_WIDTH - 0.1))
    strip.update(actions)


def _write_uses(panel: Axes, uses: list[list[str]], left: float, top: float) -> None:
    panel.text(left, top, "Holds in the order of use", fontsize=9, weight="bold", va="top")
    y = top - 0.26
    for i, rows in enumerate(uses):
        colour = style.PARTS[i % len(style.PARTS)]
        panel.add_line(Line2D([left + 0.04], [y - 0.06], marker="s", ms=6, color=colour, ls=""))
        for row in rows:
            panel.text(left + 0.18, y, row, fontsize=7, va="top")
            y -= ROW
        y -= 0.05


def holds_used(task: LimbedTask, replay: Replay) -> list[list[int]]:
    """Numbers of the holds that each limb takes, in order, the start's first."""
    uses: list[list[int]] = [[] for _ in task.robot.limbs]
    for stance in replay.stances:
        for i, numbers in enumerate(uses):
            held = int(stance["hold"][i])
            if held >= 0 and (not numbers or numbers[-1] != task.world.holds[held].number):
                numbers.append(task.world.holds[held].number)
    return uses


def body_way(task: LimbedTask, replay: Replay) -> Floats:
    """Way of the body's origin, swings as arcs, world frame [m], shape (n, 2)."""
    points = [(float(replay.stances["x"][0]), float(replay.stances["y"][0]))]
    for before, after in zip(replay.stances[:-1], replay.stances[1:], strict=True):
        for phase in Transition(task.robot, task.world, before, after).phases():
            shares = np.linspace(0, 1, ARC)[1:] if phase.kind == "swing" else (1.0,)
            for share in shares if phase.kind in ("move", "swing") else ():
                at = phase.at(float(share))
                points.append((at.x, at.y))
    return np.array(points)


def _ghosts(shown: list[Posture]) -> list[int]:
    """Stances to draw: the start, the end, and between them some that are equally far apart along the body's way."""
    places = np.array([(posture.x, posture.y) for posture in shown])
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(places, axis=0).T))])
    marks = np.linspace(0.0, way[-1], GHOSTS + 2)
    return sorted({0, *(int(np.searchsorted(way, mark - 1e-9)) for mark in marks[1:-1]), len(shown) - 1})


def wrap_words(line: str, most: int = 60) -> list[str]:
    """A line broken between words."""
    rows, row = [], ""
    for word in line.split(" › "):
        if row and len(row) + len(word) + 3 > most:
            rows.append(row + " ›")
            row = "   " + word
        else:
            row = f"{row} › {word}" if row else word
    return [*rows, row]
