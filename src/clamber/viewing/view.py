"""One picture of a climber at one moment: wall on one side, what the moment says on the other."""

from typing import Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..actions.problem import Records, Replay
from ..tasks.limbed import LimbedTask
from . import style
from .climber import ClimberArtists, Snapshot
from .geometry import Posture, postures
from .margins import Limiting, all_limiting, grade
from .panel import LINE, Place, StepStrip, TorqueBars, draw_force_key
from .scene import Bounds, draw_scene, find_bounds
from .words import describe_action, describe_holds, describe_pose, length_unit

PANEL_WIDTH: Final = 3.7
EDGE: Final = 0.5
TITLE: Final = 0.80
WIDE: Final = 1.7
"""Walls that are wider than high by more than this have the panel below [-]."""


class Layout:
    """Sizes of a picture in inches: the wall in one scale both ways, the panel beside or below it."""

    def __init__(self, bounds: Bounds, panel_height: float, *, height: float = 6.0, width: float = 6.6) -> None:
        w, h = bounds[1] - bounds[0], bounds[3] - bounds[2]
        self.below = w > WIDE * h
        if self.below:
            width, height = 9.0, 4.0
        self.scale = min(width / w, height / h)
        self.wall = w * self.scale, h * self.scale
        if self.below:
            self.panel = max(self.wall[0], 2 * PANEL_WIDTH + 0.4), panel_height
            self.size = (
                EDGE + max(self.wall[0], self.panel[0]) + 0.3,
                TITLE + self.wall[1] + EDGE + panel_height + 0.3,
            )
            self.wall_at = EDGE, panel_height + 0.3 + EDGE
            self.panel_at = EDGE, 0.15
        else:
            self.panel = PANEL_WIDTH, max(panel_height, self.wall[1])
            tall = max(self.wall[1], panel_height)
            self.size = EDGE + self.wall[0] + 0.35 + PANEL_WIDTH + 0.15, TITLE + tall + EDGE
            self.wall_at = EDGE, EDGE + tall - self.wall[1]
            self.panel_at = EDGE + self.wall[0] + 0.35, EDGE + tall - self.panel[1]

    def axes(self, figure: Figure, at: tuple[float, float], size: tuple[float, float]) -> Axes:
        """Axes at a place of the figure, both in inches."""
        w, h = self.size
        return figure.add_axes((at[0] / w, at[1] / h, size[0] / w, size[1] / h))


class ClimbView:
    """A picture of a replay that can be set to any moment of it."""

    def __init__(self, task: LimbedTask, replay: Replay) -> None:
        self.task, self.replay = task, replay
        self.postures: list[Posture] = postures(task.robot, task.world, replay.stances)
        self.bounds = find_bounds(task, self.postures)
        self.limiting: list[Limiting | None] = all_limiting(task, replay.margins, replay.reasons)
        joints = 2 * len(task.robot.limbs)
        bars = min(LINE + 0.01, 2.2 / joints) * joints + 0.025 * joints + 0.5
        below = (self.bounds[1] - self.bounds[0]) > WIDE * (self.bounds[3] - self.bounds[2])
        self.layout = Layout(self.bounds, max(bars, 2.75) if below else bars + 2.75)
        self.figure = Figure(figsize=self.layout.size)
        self.figure.set_facecolor(style.PAPER)
        self.wall = self.layout.axes(self.figure, self.layout.wall_at, self.layout.wall)
        draw_scene(self.wall, task, self.bounds)
        self.climber = ClimberArtists(self.wall, task, self.bounds)
        panel = self.layout.axes(self.figure, self.layout.panel_at, self.layout.panel)
        self.strip: StepStrip
        self._make_panel(panel, bars)
        self._make_title()

    def _make_panel(self, panel: Axes, bars: float) -> None:
        width, height = self.layout.panel
        ounces = length_unit(self.task)[0] == "in"
        left = PANEL_WIDTH + 0.4 if self.layout.below else 0.0
        rows = ("Pose", "Holds", "Nearest limit")
        self.texts = []
        for k, row in enumerate(rows):
            y = height - (k * 2.2 * LINE)
            panel.text(0.0, y, row, fontsize=7.5, va="top", color=style.QUIET)
            self.texts.append(panel.text(0.0, y - 0.85 * LINE, "", fontsize=8.5, va="top"))
        text_end = height - len(rows) * 2.2 * LINE - 0.1
        bars_top = height if self.layout.below else text_end
        self.bars = TorqueBars(panel, self.task, Place(left, bars_top, PANEL_WIDTH), ounces=ounces)
        strip_top = text_end if self.layout.below else self.bars.bottom - 0.12
        self.strip = StepStrip(panel, [grade(step) for step in self.limiting], Place(0.0, strip_top, PANEL_WIDTH - 0.1))
        # last, for the strip's image sets limits of its own
        panel.set_xlim(0.0, width)
        panel.set_ylim(0.0, height)
        panel.axis("off")
        key_y = strip_top - 0.92
        draw_force_key(panel, self.task, Place(0.0, key_y, PANEL_WIDTH), self.layout.scale)

    def _make_title(self) -> None:
        w, h = self.layout.size
        self.title = self.figure.text(EDGE / w, 1 - 0.13 / h, "", fontsize=11, weight="bold", va="top")
        self.figure.text(EDGE / w, 1 - 0.35 / h, self.task.title, fontsize=8.5, va="top", color=style.QUIET)

    @property
    def artists(self) -> list[Artist]:
        """The artists that change, from back to front."""
        return [self.title, *self.climber.artists, *self.texts, *self.bars.artists, *self.strip.artists]

    def snapshot(self, step: int) -> Snapshot:
        """The settled stance after a step, as it is drawn."""
        n = len(self.task.robot.limbs)
        stance = self.replay.stances[step]
        return Snapshot(self.postures[step], np.array(stance["force"][:n]), np.array(stance["torques"][:n]))

    def show(self, step: int, at: Snapshot) -> None:
        """Set the picture to a moment of a step.

        Args:
            step: Number of the action, from 1; 0 is the start.
            at: What the climber looks like.
        """
        steps = len(self.replay.reasons)
        stances: Records = self.replay.stances
        if step == 0:
            self.title.set_text("Start")
        else:
            reason = int(self.replay.reasons[step - 1])
            action = describe_action(self.task, stances[step - 1], stances[step], reason)
            self.title.set_text(f"Step {step} of {steps}: {action}")
            self.title.set_color(style.ALERT if reason >= 0 else style.INK)
        limit = self.limiting[step - 1] if step else None
        self.texts[0].set_text(describe_pose(self.task, at.posture.x, at.posture.y, at.posture.angle))
        words = describe_holds(self.task, stances[step])
        self.texts[1].set_text(_shortened(words, 64))
        self.texts[1].set_fontsize(8.5 if len(words) <= 50 else 7.0)
        self.texts[2].set_text("not judged" if limit is None else str(limit))
        self.texts[2].set_color((style.ALERT, "#B35900", style.INK, style.INK)[grade(limit)])
        self.climber.update(at)
        self.bars.update(at.torques)
        self.strip.update(step)


def _shortened(words: str, most: int) -> str:
    return words if len(words) <= most else words[: most - 1].rsplit(", ", 1)[0] + ", …"
