"""How climbers are drawn."""

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ....planning.problem.problem import Replay
from ....planning.problem.problems import yardsticks_of
from ....types import Floats
from ....viewing import style
from ....viewing.pictures import Pictures
from ....viewing.route import FACTS, ROW, draw_way, label_ghost, pick_ghosts, write_facts
from ....viewing.scene import Bounds
from ....viewing.view import PANEL_WIDTH, Layout, is_wide
from ....viewing.words import length_unit
from ..planning.task import LimbedTask
from .climb_view import ClimbView, draw_climb
from .climber import ClimberArtists, Snapshot
from .geometry import Posture, postures
from .motion import Transition
from .torques import show_torque, torque_limits
from .wall import draw_scene, find_bounds

MOST_ROWS: Final = 9
"""Rows of holds that are listed for one limb."""
ARC: Final = 12
"""Points of the body's way within one swing."""


def climb_route(task: LimbedTask, replay: Replay) -> Figure:
    """A whole climb as one picture."""
    shown = postures(task.robot, task.world, replay.stances)
    bounds = find_bounds(task, shown)
    uses = [
        shorten(wrap_words(f"{name}:  " + " › ".join(map(str, numbers))))
        for name, numbers in zip(task.robot.limb_names, holds_used(task, replay), strict=True)
    ]
    words = 0.4 + sum(ROW * len(rows) + 0.05 for rows in uses)
    layout = Layout(bounds, max(words, FACTS) if is_wide(bounds) else FACTS + words, height=6.6)
    title = f"The whole climb: {len(replay.reasons)} actions"
    subtitle = f"{task.title}. Line: way of the body, dark at the start"
    figure, wall, panel, _ = layout.figure(title, subtitle)
    draw_scene(wall, task, bounds)
    _draw_ghosts(wall, task, shown, bounds)
    draw_way(wall, body_way(task, replay))
    height = layout.panel[1]
    write_facts(panel, replay, yardsticks_of(task), _facts(task, replay), height)
    _write_uses(panel, uses, *((PANEL_WIDTH + 0.4, height) if layout.below else (0.0, height - FACTS)))
    layout.fix_panel(panel)
    return figure


def _draw_ghosts(wall: Axes, task: LimbedTask, shown: list[Posture], bounds: Bounds) -> None:
    unloaded = np.zeros((len(task.robot.limbs), 2))
    last = len(shown) - 1
    for k in pick_ghosts(np.array([(posture.x, posture.y) for posture in shown])):
        climber = ClimberArtists(wall, task, bounds, alpha=1.0 if k == last else 0.3, arrows=False)
        climber.update(Snapshot(shown[k], unloaded, unloaded))
        if k < last:
            label_ghost(wall, k, shown[k].x, shown[k].y)


def _facts(task: LimbedTask, replay: Replay) -> tuple[tuple[str, str], ...]:
    ounces = length_unit(task)[0] == "in"
    torque = float(np.max(np.abs(replay.stances["torques"][:, : len(task.robot.limbs)])))
    most, limit = (show_torque(value, ounces=ounces) for value in (torque, float(torque_limits(task).max())))
    return ("Hangs", str(int(replay.stances["hangs"][-1]))), ("Largest torque", f"{most} of {limit}")


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


def shorten(rows: list[str], most: int = MOST_ROWS) -> list[str]:
    """The first rows and the last two, where there are more than `most`."""
    if len(rows) <= most:
        return rows
    return [*rows[: most - 3], f"   ... {len(rows) - most + 1} rows left out ...", *rows[-2:]]


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


def wall_points(task: LimbedTask) -> Floats:
    """Holds and corners of regions to keep out of, world frame [m], shape (n, 2)."""
    return np.vstack([task.world.positions(), *(np.array(polygon) for polygon in task.world.keep_out)])


PICTURES: Final = Pictures(ClimbView, draw_climb, climb_route, wall_points, draw_scene, torque_limits)
