"""A plan or a run at any of its moments: as a figure with its world on one side and what the moment says on the other, and as frames."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, Generic, Protocol, TypeVar

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.text import Text

from . import style
from .panel import LINE, GaugeBars, Place, StepStrip
from .recording import Frame, Moment, View, make_frames
from .scene import Bounds, halo

Shown = TypeVar("Shown", contravariant=True)
"""The same where it is only taken."""

PANEL_WIDTH: Final = 3.7
EDGE: Final = 0.58
TITLE: Final = 0.80
TEXTS: Final = 2.75
"""Height of facts, strip and key [in]."""
SMALL: Final = 1.1
"""A robot that is smaller in its world is shown from near, too [in]."""
CUT_OUT: Final = 0.42
"""Side of that picture over the smaller side of the world's [-]."""
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
        panel.set(xlim=(0.0, self.panel[0]), ylim=(0.0, self.panel[1]))
        panel.axis("off")


@dataclass(frozen=True, slots=True)
class CloseUp:
    """A robot and what is about it."""

    bounds: Bounds
    """What is shown, world [m]."""
    draw: Callable[[Axes], None]
    """Draws it, and sets axes up."""


class Robot(Protocol[Shown]):
    """A robot as updatable artists."""

    @property
    def artists(self) -> list[Artist]:
        """All, from back to front."""
        ...

    def update(self, at: Shown) -> None:
        """Put every artist where a moment has it."""
        ...


class Picture(Generic[Moment]):
    """A figure that can be set to any moment of a view: the world with its robot, and a panel of facts, bars and strip."""

    def __init__(self, view: View[Moment]) -> None:
        self.view, gauges = view, view.gauges[0]
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
        self.strip = StepStrip(self.panel, view.grades[1:], strip_place, view.strip_title, view.words)
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
        steps = len(view.steps) - 1
        self.title_text.set_text(f"{view.noun} {step} of {steps}: {view.steps[step]}" if step else "Start")
        self.title_text.set_color(style.ALERT if view.failed(step) else style.INK)
        words = (*view.lines(step, at), view.verdict(step))
        for text, line in zip(self.texts, words, strict=True):
            text.set_text(_shortened(line, 64))
            text.set_fontsize(8.5 if len(line) <= 50 else 7.0)
        self.texts[-1].set_color((style.ALERT, "#B35900", style.INK, style.INK)[view.grades[step]])
        self.robot.update(at)
        self.bars.update(view.values(at)[0])
        self.strip.update(step)

    def draw_near(self, near: CloseUp) -> None:
        """Draw the robot once more over a part of the world, larger, with a frame about its place, where it is small.

        It stays as it is then: for still pictures.
        """
        x0, x1, y0, y1 = near.bounds
        layout, size = self.layout, CUT_OUT * min(self.layout.wall)
        if max(x1 - x0, y1 - y0) * layout.scale > SMALL or size < 1.5 * SMALL:
            return
        scale = size / max(x1 - x0, y1 - y0)
        wide, high = scale * (x1 - x0), scale * (y1 - y0)
        left = 0.5 * (x0 + x1) < 0.5 * sum(self.view.bounds[:2])
        across = layout.wall[0] - wide - 0.12 if left else 0.12  # away from the robot, half-way up
        place = layout.wall_at[0] + across, layout.wall_at[1] + 0.5 * (layout.wall[1] - high)
        inset = layout.axes(self.figure, place, (wide, high))
        near.draw(inset)
        inset.set(xlim=(x0, x1), ylim=(y0, y1), xticks=(), yticks=(), xlabel="", ylabel="")
        words = f"framed part, {scale / layout.scale:.0f} times as large"
        inset.set_title(words, fontsize=8, weight="normal", pad=3, path_effects=[halo(3.0)])
        self.wall.add_patch(Rectangle((x0, y0), x1 - x0, y1 - y0, fill=False, ec=style.ALERT, lw=0.9, zorder=20))
        inset.patch.set_path_effects([halo(6.0)])
        for spine in inset.spines.values():
            spine.set(color=style.ALERT, lw=0.9)


def _shortened(words: str, most: int) -> str:
    return words if len(words) <= most else words[: most - 1].rsplit(", ", 1)[0] + ", …"
