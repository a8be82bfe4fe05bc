"""One still picture of a whole climb: the body's way, ghosts of the robot along it, and the order in which holds are used."""

from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ..actions.problem import Replay
from ..tasks.limbed import LimbedTask
from . import style
from .climber import ClimberArtists, Snapshot
from .geometry import postures
from .margins import all_limiting, grade
from .motion import Transition
from .output import CANVASES, check_suffix, save_figure
from .panel import Place, StepStrip, show_torque, torque_limits
from .scene import draw_scene, find_bounds, halo
from .style import styled
from .view import EDGE, PANEL_WIDTH, WIDE, Layout
from .words import length_unit

GHOSTS: Final = 6
"""Postures drawn between start and end, at most."""
ARC: Final = 12
"""Points of the body's way within one action."""


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
    uses = holds_used(task, replay)
    lines = [
        f"{name}:  " + " › ".join(str(number) for number in uses[i]) for i, name in enumerate(task.robot.limb_names)
    ]
    wrapped = [wrap_words(line) for line in lines]
    rows = sum(len(words) for words in wrapped)
    below = bounds[1] - bounds[0] > WIDE * (bounds[3] - bounds[2])
    words_height = 0.4 + 0.15 * rows + 0.05 * len(wrapped)
    layout = Layout(bounds, max(words_height, 1.7) if below else 1.85 + words_height, height=6.6)
    figure = Figure(figsize=layout.size)
    figure.set_facecolor(style.PAPER)
    wall = layout.axes(figure, layout.wall_at, layout.wall)
    draw_scene(wall, task, bounds)
    picked = _ghosts(replay, shown)
    for rank, k in enumerate(picked):
        last = rank == len(picked) - 1
        climber = ClimberArtists(wall, task, bounds, alpha=1.0 if last else 0.30, arrows=False)
        n = len(task.robot.limbs)
        climber.update(Snapshot(shown[k], np.zeros((n, 2)), np.zeros((n, 2))))
        if not last:
            wall.annotate(
                "start" if k == 0 else f"step {k}", (shown[k].x, shown[k].y), xytext=(7, -9), textcoords="offset points",
                fontsize=6.5, color=style.INK, zorder=9, path_effects=[halo()],
            )  # fmt: skip
    way, step_of = body_way(task, replay)
    segments = np.stack([way[:-1], way[1:]], axis=1)
    colours = np.arange(len(segments)) / max(len(segments), 1)
    wall.add_collection(LineCollection(list(segments), linewidths=3.4, colors=style.PAPER, zorder=7, capstyle="round"))
    line = LineCollection(list(segments), linewidths=1.8, cmap="viridis", zorder=7.1, capstyle="round")
    line.set_array(colours * 0.85)
    line.set_clim(0.0, 1.0)
    wall.add_collection(line)
    assert len(step_of) == len(way)
    panel = layout.axes(figure, layout.panel_at, layout.panel)
    limits = all_limiting(task, replay.margins, replay.reasons)
    width, height = layout.panel
    ounces = length_unit(task)[0] == "in"
    worst = min((limit for limit in limits if limit is not None), key=lambda limit: limit.share, default=None)
    torque = float(np.max(np.abs(replay.stances["torques"][:, : len(task.robot.limbs)])))
    facts = [
        ("Actions", f"{len(replay.reasons)}, {int(np.sum(replay.reasons >= 0))} of them violated"
         if not replay.ok else f"{len(replay.reasons)}, all of them hold"),
        ("Hangs", str(int(replay.stances["hangs"][-1]))),
        ("Largest torque", f"{show_torque(task, torque, ounces=ounces)} of {show_torque(task, float(torque_limits(task).max()), ounces=ounces)}"),
        ("Nearest limit", "not judged" if worst is None else f"{worst} at step {limits.index(worst) + 1}"),
    ]  # fmt: skip
    for k, (name, words) in enumerate(facts):
        panel.text(0.0, height - 0.2 * k, name, fontsize=8, va="top", color=style.QUIET)
        panel.text(1.05, height - 0.2 * k, words, fontsize=8, va="top")
    strip = StepStrip(panel, [grade(limit) for limit in limits], Place(0.0, height - 1.0, PANEL_WIDTH - 0.1))
    strip.update(len(replay.reasons))
    left, top = (PANEL_WIDTH + 0.4, height) if layout.below else (0.0, height - 1.85)
    panel.text(left, top, "Holds in the order of use", fontsize=9, weight="bold", va="top")
    y = top - 0.26
    for i, words in enumerate(wrapped):
        panel.add_line(
            Line2D([left + 0.04], [y - 0.06], marker="s", ms=6, color=style.PARTS[i % len(style.PARTS)], ls="")
        )
        for row in words:
            panel.text(left + 0.18, y, row, fontsize=7, va="top")
            y -= 0.15
        y -= 0.05
    panel.set_xlim(0.0, width)
    panel.set_ylim(0.0, height)
    panel.axis("off")
    w, h = layout.size
    words = f"The whole climb: {len(replay.reasons)} actions"
    figure.text(EDGE / w, 1 - 0.13 / h, words, fontsize=11, weight="bold", va="top")
    subtitle = f"{task.title}. Line: way of the body, dark at the start"
    figure.text(EDGE / w, 1 - 0.35 / h, subtitle, fontsize=8.5, va="top", color=style.QUIET)
    return figure


def holds_used(task: LimbedTask, replay: Replay) -> list[list[int]]:
    """Numbers of the holds that each limb takes, in order, the start's first."""
    uses: list[list[int]] = [[] for _ in task.robot.limbs]
    for stance in replay.stances:
        for i, numbers in enumerate(uses):
            held = int(stance["hold"][i])
            if held >= 0 and (not numbers or numbers[-1] != task.world.holds[held].number):
                numbers.append(task.world.holds[held].number)
    return uses


def body_way(task: LimbedTask, replay: Replay) -> tuple[np.ndarray, np.ndarray]:  # type: ignore[type-arg]
    """Way of the body's origin, swings as arcs, world frame [m], shape (n, 2), and the action of each point, shape (n,)."""
    points, steps = [(float(replay.stances["x"][0]), float(replay.stances["y"][0]))], [0]
    for k, (before, after) in enumerate(zip(replay.stances[:-1], replay.stances[1:], strict=True), start=1):
        for phase in Transition(task.robot, task.world, before, after).phases():
            shares = np.linspace(0, 1, ARC)[1:] if phase.kind == "swing" else (1.0,)
            for share in shares if phase.kind in ("move", "swing") else ():
                at = phase.at(float(share))
                points.append((at.x, at.y))
                steps.append(k)
    return np.array(points), np.array(steps)


def _ghosts(replay: Replay, shown: list) -> list[int]:  # type: ignore[type-arg]
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
