"""The panel beside a picture: bars of values between limits, strip of steps."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from ..types import Floats
from . import style

LINE = 0.19
"""Height of a line of text [in]."""
TOLD = 0.14
"""Height of the line below bars that says what their dotted lines are [in]."""
GAP = 0.05
"""Between groups of bars [in]."""


@dataclass(frozen=True, slots=True)
class Place:
    """Where a block of the panel is: left edge, top edge and width, in inches of the panel's axes."""

    left: float
    top: float
    width: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Gauges:
    """What a block of bars shows: sizes of values between a lower and an upper end."""

    title: str
    names: tuple[str, ...]
    colours: tuple[str, ...]
    low: Floats
    """Value at which a bar is empty, in SI units, shape (n,)."""
    high: Floats
    """Value at which a bar is full."""
    limits: tuple[tuple[float, str], ...]
    """Shares of a bar at which a line marks a limit, each with its word."""
    calm: tuple[float, float]
    """Shares where a bar turns red."""
    unit: tuple[str, float, int]
    """Of values for people: its name, its size in SI units, decimals."""
    group: int
    """Bars close together."""
    note: str = ""
    """What is to be said of a full bar where it is no limit."""

    @property
    def height(self) -> float:
        """Height of the block [in]."""
        bars = self.pitch * len(self.names) + GAP * (len(self.names) // self.group) + 0.5
        return bars + (TOLD if self.warns else 0.0)

    @property
    def warns(self) -> tuple[float, ...]:
        """Shares of a bar beyond which it turns red though it is not at a limit."""
        return tuple(share for share in self.calm if 0.0 < share < 1.0)

    @property
    def pitch(self) -> float:
        """From bar to bar [in]."""
        return min(LINE + 0.01, 2.2 / len(self.names))

    def show(self, value: float) -> str:
        """A value in words; a dash where nothing is known."""
        if not math.isfinite(value):
            return "–"
        name, size, decimals = self.unit
        return f"{round(value / size, decimals) + 0.0:.{decimals}f} {name}"  # never "-0"

    def shares(self, values: Floats) -> Floats:
        """How full the bars are [-]; the sign of a value does not count."""
        full: Floats = (np.abs(values) - self.low) / (self.high - self.low)
        return full


class GaugeBars:
    """One bar per value, red where it is close to a limit."""

    def __init__(self, axes: Axes, gauges: Gauges, place: Place) -> None:
        self.gauges = gauges
        self.start = place.left + 1.22
        self.length = place.width - 1.22 - 0.92
        axes.text(place.left, place.top, gauges.title, fontsize=9, weight="bold", va="top")
        self.bars: list[Rectangle] = []
        self.values = []
        pitch, top = gauges.pitch, place.top - 0.42
        for k, (name, colour) in enumerate(zip(gauges.names, gauges.colours, strict=True)):
            y = top - pitch * (k + 0.9) - GAP * (k // gauges.group)
            axes.text(self.start - 0.06, y, name, fontsize=7, ha="right", va="center", color=style.INK)
            axes.add_patch(Rectangle((self.start, y - 0.3 * pitch), self.length, 0.6 * pitch, fc=style.FAINT, lw=0))
            bar = Rectangle((self.start, y - 0.3 * pitch), 0.0, 0.6 * pitch, fc=colour, lw=0)
            axes.add_patch(bar)
            self.bars.append(bar)
            value = axes.text(self.start + self.length + 0.06, y, "", fontsize=7, va="center", color=style.INK)
            self.values.append(value)
        self.bottom = place.top - gauges.height + 0.03
        marks = {share: ("", ":") for share in gauges.warns}
        marks |= {share: (words, "-") for share, words in gauges.limits}
        for share, (words, line) in marks.items():
            x = self.start + share * self.length
            foot = self.bottom + 0.03 + (TOLD if gauges.warns else 0.0)
            axes.plot([x, x], [foot, top], color=style.ALERT, lw=0.8, ls=line)
            axes.text(x, top + 0.03, words, fontsize=6.5, ha="center", va="bottom", color=style.QUIET)
        if gauges.warns:
            y = self.bottom + 0.02
            axes.plot([self.start, self.start + 0.18], [y, y], color=style.ALERT, lw=0.8, ls=":")
            axes.text(self.start + 0.24, y, "where bars turn red", fontsize=6.5, va="center", color=style.QUIET)
        if 0.0 not in marks:
            axes.text(self.start, top + 0.03, "0", fontsize=6.5, ha="center", va="bottom", color=style.QUIET)

    @property
    def artists(self) -> list[Artist]:
        """The artists that change."""
        return [*self.bars, *self.values]

    def update(self, values: Floats) -> None:
        """Show values in SI units, shape (n,)."""
        low, high = self.gauges.calm
        for k, (value, share) in enumerate(zip(values.tolist(), self.gauges.shares(values).tolist(), strict=True)):
            self.bars[k].set_width(self.length * min(max(0.0, share), 1.0))  # in this order, NaN is 0
            self.bars[k].set_facecolor(self.gauges.colours[k] if low <= share <= high else style.ALERT)
            self.values[k].set_text(self.gauges.show(value))


class StepStrip:
    """A coloured cell per step, and a mark at the step that is shown."""

    def __init__(
        self,
        axes: Axes,
        grades: Sequence[int],
        place: Place,
        title: str = "Smallest margin of every step",
        words: tuple[str, str, str, str] = style.STRIP_WORDS,
    ) -> None:
        """Draw the strip.

        Args:
            axes: Of the panel, in inches.
            grades: Index into `style.STRIP` of every step.
            place: Where.
            title: What the colours tell.
            words: What each of them means.
        """
        self.place, self.count = place, max(len(grades), 1)
        axes.text(place.left, place.top, title, fontsize=9, weight="bold", va="top")
        height, top = 0.15, place.top - 0.28
        cells = np.array([[int(style.STRIP[g][k : k + 2], 16) for k in (1, 3, 5)] for g in grades or [3]], np.uint8)
        axes.imshow(
            cells[None],
            extent=(place.left, place.left + place.width, top - height, top),
            aspect="auto",
            interpolation="nearest",
            zorder=1,
        )
        for k, (colour, word) in enumerate(zip(style.STRIP, words, strict=True)):
            x = place.left + k * place.width / 4
            axes.add_patch(Rectangle((x, top - height - 0.25), 0.11, 0.11, fc=colour, lw=0))
            axes.text(x + 0.15, top - height - 0.2, word, fontsize=6.5, va="center", color=style.QUIET)
        (self.mark,) = axes.plot([], [], marker="v", ms=6, color=style.INK, ls="", clip_on=False)
        self.y = top + 0.05

    @property
    def artists(self) -> list[Artist]:
        """The artists that change."""
        return [self.mark]

    def update(self, step: int) -> None:
        """Point at a step, from 1; 0 is the start."""
        x = self.place.left + self.place.width * min(max(step - 0.5, 0.0) / self.count, 1.0)
        self.mark.set_data([x], [self.y])
