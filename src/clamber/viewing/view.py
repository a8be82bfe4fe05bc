"""A plan or a run at any of its moments: as a figure with its world on one side and what the moment says on the other, and as frames."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar, Final, Generic, Protocol, TypeVar

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text

from ..planning.problem.problem import Replay
from ..planning.problem.problems import yardsticks_of
from ..types import Floats
from . import style
from .margins import Limiting, all_limiting, grade
from .panel import LINE, GaugeBars, Gauges, Place, StepStrip
from .scene import Bounds

Moment = TypeVar("Moment")
"""What a family's robot looks like at one moment."""
Shown = TypeVar("Shown", contravariant=True)
"""The same where it is only taken."""

PANEL_WIDTH: Final = 3.7
EDGE: Final = 0.5
TITLE: Final = 0.80
TEXTS: Final = 2.75
"""Height of facts, strip and key [in]."""
WIDE: Final = 1.7
"""Worlds that are wider than high by more than this have the panel below [-]."""


def is_wide(bounds: Bounds) -> bool:
    """Whether the panel is below the world rather than beside it."""
    return bounds[1] - bounds[0] > WIDE * (bounds[3] - bounds[2])


class Layout:
    """Sizes of a picture in inches: the world in one scale both ways, the panel beside or below it."""

    def __init__(self, bounds: Bounds, panel_height: float, *, height: float = 6.0, width: float = 6.6) -> None:
        w, h = bounds[1] - bounds[0], bounds[3] - bounds[2]
        self.below = is_wide(bounds)
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

    def figure(self, title: str, subtitle: str) -> tuple[Figure, Axes, Axes, Text]:
        """An empty picture: the figure, the world's axes, the panel's, in inches, and the title's artist."""
        figure = Figure(figsize=self.size)
        figure.set_facecolor(style.PAPER)
        wall = self.axes(figure, self.wall_at, self.wall)
        panel = self.axes(figure, self.panel_at, self.panel)
        w, h = self.size
        shown = figure.text(EDGE / w, 1 - 0.13 / h, title, fontsize=11, weight="bold", va="top")
        figure.text(EDGE / w, 1 - 0.35 / h, subtitle, fontsize=8.5, va="top", color=style.QUIET)
        return figure, wall, panel, shown

    def fix_panel(self, panel: Axes) -> None:
        """Set the panel's limits, in inches; last, for the strip's image sets limits of its own."""
        panel.set_xlim(0.0, self.panel[0])
        panel.set_ylim(0.0, self.panel[1])
        panel.axis("off")


FRAMES: Final = {
    "move": 5, "swing": 10, "reach": 8, "release": 2, "still": 1, "slide": 3, "land": 4, "both": 3, "lift": 4,
}  # fmt: skip
"""Frames of a phase where there is room for all."""
EVEN: Final = frozenset({"move", "slide"})
"""Phases that often follow each other: they neither speed up nor slow down, and are not paused after."""
PAUSE: Final = 2.5
"""Frames' worth of time that a settled stance is shown."""


@dataclass(frozen=True, slots=True)
class Part(Generic[Moment]):
    """One part of an action's motion."""

    kind: str
    """One of `FRAMES`."""
    at: Callable[[float, float], Moment]
    """The moment at a share of the part and at a share of the whole action, both in [0, 1], ends included."""


class Robot(Protocol[Shown]):
    """A robot as updatable artists."""

    @property
    def artists(self) -> list[Artist]:
        """All artists, from back to front."""
        ...

    def update(self, at: Shown) -> None:
        """Put every artist where a moment has it."""
        ...


class View(ABC, Generic[Moment]):
    """A replay at any moment of it, and what is to be said of that; each family draws its own world and robot."""

    rows: ClassVar[tuple[str, ...]]
    """Names of the facts in the panel; the verdict comes after them."""
    verdict_row: ClassVar[str] = "Nearest limit"
    noun: ClassVar[str] = "Step"
    """What is counted."""
    strip_title: ClassVar[str] = "Smallest margin of every step"
    strip_words: ClassVar[tuple[str, str, str, str]] = style.STRIP_WORDS
    """What the grades mean."""

    def __init__(self, task: Any, replay: Replay, bounds: Bounds, gauges: Gauges) -> None:
        self.task, self.replay, self.bounds, self.gauges = task, replay, bounds, gauges
        self.title, self.yardsticks = task.title or task.name, yardsticks_of(task)
        self.limiting: list[Limiting | None] = all_limiting(self.yardsticks, replay)

    @abstractmethod
    def draw(self, picture: "Picture[Moment]") -> Robot[Moment]:
        """Draw the world on a picture's `wall`, what marks mean at the `key` of its `panel`, and make the robot's artists."""

    @abstractmethod
    def settled(self, step: int) -> Moment:
        """The stance after a step; 0 is the start."""

    @abstractmethod
    def motion(self, step: int) -> list[Part[Moment]]:
        """The parts of a step's motion, in order; at least one."""

    @abstractmethod
    def values(self, at: Moment) -> Floats:
        """What the bars show, SI units, shape (n,)."""

    @abstractmethod
    def action(self, step: int) -> str:
        """A step in words."""

    @abstractmethod
    def facts(self, step: int, at: Moment) -> tuple[str, ...]:
        """A moment in words, one for each of `rows`."""

    def reason(self, step: int) -> int:
        """Number of the check that a step violates; -1: none."""
        return int(self.replay.reasons[step - 1]) if step else -1

    @property
    def grades(self) -> list[int]:
        """What is to be thought of every step, as indices into `style.STRIP`."""
        return [grade(limit) for limit in self.limiting]

    def verdict(self, step: int) -> str:
        """The same of one step in words; 0 is the start."""
        limit = self.limit(step)
        return "not judged" if limit is None else str(limit)

    def failed(self, step: int) -> bool:
        """Whether a step went wrong."""
        return self.reason(step) >= 0

    def limit(self, step: int) -> Limiting | None:
        """What limits the stance after a step; None if nothing has judged it."""
        return self.limiting[step - 1] if step else None


@dataclass(frozen=True, slots=True)
class Frame(Generic[Moment]):
    """One frame of an animation."""

    step: int
    """Number of the action it belongs to, from 1; 0 is the start."""
    moment: Moment
    length: float
    """How long it is shown, in frame times [-]."""


def make_frames(view: View[Moment], most: int) -> list[Frame[Moment]]:
    """The frames of a plan, at most `most` of them: long plans get fewer per action, then not every action."""
    steps = len(view.replay.reasons)
    motions = [view.motion(step) for step in range(1, steps + 1)]
    wanted = sum(FRAMES[part.kind] for parts in motions for part in parts)
    thin = min(1.0, most / max(wanted + 1, 1))
    frames = [Frame(0, view.settled(0), 3 * PAUSE)]
    for step, parts in enumerate(motions, start=1):
        frames += _step_frames(step, parts, thin)
    frames[-1] = Frame(frames[-1].step, frames[-1].moment, 6 * PAUSE)
    if len(frames) > most:
        frames = [frames[k] for k in np.linspace(0, len(frames) - 1, most).round().astype(int)]
    return frames


def _step_frames(step: int, parts: list[Part[Moment]], thin: float) -> list[Frame[Moment]]:
    counts = [max(1 if k == len(parts) - 1 else 0, round(thin * FRAMES[p.kind])) for k, p in enumerate(parts)]
    total, done = sum(counts), 0
    frames = []
    for part, count in zip(parts, counts, strict=True):
        for k in range(1, count + 1):
            done += 1
            share = k / count
            ease = share if part.kind in EVEN else share * share * (3.0 - 2.0 * share)
            pause = 1.0 if done < total or part.kind in EVEN else PAUSE
            frames.append(Frame(step, part.at(ease, done / total), pause))
    return frames


class Picture(Generic[Moment]):
    """A figure that can be set to any moment of a view: the world with its robot, and a panel of facts, bars and strip."""

    def __init__(self, view: View[Moment]) -> None:
        self.view, gauges = view, view.gauges
        height = max(gauges.height, TEXTS) if is_wide(view.bounds) else gauges.height + TEXTS
        self.layout = Layout(view.bounds, height)
        self.figure, self.wall, self.panel, self.title_text = self.layout.figure("", view.title)
        height = self.layout.panel[1]
        left = PANEL_WIDTH + 0.4 if self.layout.below else 0.0
        rows = (*view.rows, view.verdict_row)
        self.heads, self.texts = [], []
        for k, row in enumerate(rows):
            y = height - (k * 2.2 * LINE)
            self.heads.append(self.panel.text(0.0, y, row, fontsize=7.5, va="top", color=style.QUIET))
            self.texts.append(self.panel.text(0.0, y - 0.85 * LINE, "", fontsize=8.5, va="top"))
        text_end = height - len(rows) * 2.2 * LINE - 0.1
        self.bars = GaugeBars(self.panel, gauges, Place(left, height if self.layout.below else text_end, PANEL_WIDTH))
        top = text_end if self.layout.below else self.bars.bottom - 0.12
        strip_place = Place(0.0, top, PANEL_WIDTH - 0.1)
        self.strip = StepStrip(self.panel, view.grades, strip_place, view.strip_title, view.strip_words)
        self.layout.fix_panel(self.panel)
        self.key = Place(0.0, top - 0.92, PANEL_WIDTH)
        self.robot = view.draw(self)

    @property
    def artists(self) -> list[Artist]:
        """The artists that change, from back to front."""
        return [self.title_text, *self.robot.artists, *self.texts, *self.bars.artists, *self.strip.artists]

    def frames(self, most: int) -> list[Frame[Moment]]:
        """What an animation of at most so many frames shows."""
        return make_frames(self.view, most)

    def show(self, step: int, at: Moment) -> None:
        """Set the picture to a moment of a step.

        Args:
            step: Number of the action, from 1; 0 is the start.
            at: What the robot looks like.
        """
        view = self.view
        steps = len(view.replay.reasons)
        self.title_text.set_text(f"{view.noun} {step} of {steps}: {view.action(step)}" if step else "Start")
        self.title_text.set_color(style.ALERT if view.failed(step) else style.INK)
        words = (*view.facts(step, at), view.verdict(step))
        for text, line in zip(self.texts, words, strict=True):
            text.set_text(_shortened(line, 64))
            text.set_fontsize(8.5 if len(line) <= 50 else 7.0)
        self.texts[-1].set_color((style.ALERT, "#B35900", style.INK, style.INK)[view.grades[step - 1] if step else 3])
        self.robot.update(at)
        self.bars.update(view.values(at))
        self.strip.update(step)


def _shortened(words: str, most: int) -> str:
    return words if len(words) <= most else words[: most - 1].rsplit(", ", 1)[0] + ", …"
