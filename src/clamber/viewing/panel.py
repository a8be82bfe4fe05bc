"""The panel beside the wall: torques of joints against their limits, key of the force arrows, strip of steps."""

from dataclasses import dataclass

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.patches import FancyArrowPatch, Rectangle

from ..tasks.limbed import LimbedTask
from ..types import Floats
from ..units import OZ_IN
from . import style
from .climber import force_scale

NEAR_LIMIT = 0.9
"""Share of a joint's limit beyond which its bar turns red [-]."""
LINE = 0.19
"""Height of a line of text [in]."""


def torque_limits(task: LimbedTask) -> Floats:
    """Torque limits of shoulders and elbows [N m], shape (n_limbs, 2)."""
    motor = task.robot.motor.torque_limit
    return np.array(
        [
            [motor if joint.torque_limit is None else joint.torque_limit for joint in (limb.shoulder, limb.elbow)]
            for limb in task.robot.limbs
        ]
    )


def show_torque(torque: float, *, ounces: bool) -> str:
    """A torque for people: ounce-inches beside a task in inches, else newton metres."""
    return f"{torque / OZ_IN:.0f} oz-in" if ounces else f"{torque:.2f} N m"


def nice_force(weight: float) -> float:
    """A round force for the key, near half the weight [N]."""
    return next(f for f in (1000, 500, 200, 100, 50, 20, 10, 5, 2, 1, 0.5, 0.2, 0.1, 0.0) if f <= 0.6 * weight)


@dataclass(frozen=True, slots=True)
class Place:
    """Where a block of the panel is: left edge, top edge and width, in inches of the panel's axes."""

    left: float
    top: float
    width: float


class TorqueBars:
    """One bar per joint: share of its torque limit, red beyond nine tenths."""

    def __init__(self, axes: Axes, task: LimbedTask, place: Place, *, ounces: bool) -> None:
        self.task, self.ounces = task, ounces
        self.limits = torque_limits(task).ravel()
        self.start = place.left + 1.22
        self.length = place.width - 1.22 - 0.92
        axes.text(place.left, place.top, "Joint torques", fontsize=9, weight="bold", va="top")
        self.bars: list[Rectangle] = []
        self.values = []
        count = len(self.limits)
        pitch = min(LINE + 0.01, 2.2 / count)
        top = place.top - 0.42
        for k in range(count):
            limb, which = divmod(k, 2)
            y = top - pitch * (k + 0.9) - 0.05 * limb
            colour = style.PARTS[limb % len(style.PARTS)]
            name = f"{task.robot.limbs[limb].name} {('shoulder', 'elbow')[which]}"
            axes.text(self.start - 0.06, y, name, fontsize=7, ha="right", va="center", color=style.INK)
            axes.add_patch(Rectangle((self.start, y - 0.3 * pitch), self.length, 0.6 * pitch, fc=style.FAINT, lw=0))
            bar = Rectangle((self.start, y - 0.3 * pitch), 0.0, 0.6 * pitch, fc=colour, lw=0)
            axes.add_patch(bar)
            self.bars.append(bar)
            value = axes.text(self.start + self.length + 0.06, y, "", fontsize=7, va="center", color=style.INK)
            self.values.append(value)
        self.bottom = top - pitch * count - 0.05 * (count // 2) - 0.05
        for share, words in ((0.0, "0"), (NEAR_LIMIT, ""), (1.0, "limit")):
            x = self.start + share * self.length
            if share:
                axes.plot([x, x], [self.bottom + 0.03, top], color=style.ALERT, lw=0.8, ls="-" if share == 1 else ":")
            axes.text(x, top + 0.03, words, fontsize=6.5, ha="center", va="bottom", color=style.QUIET)

    @property
    def artists(self) -> list[Artist]:
        """The artists that change."""
        return [*self.bars, *self.values]

    def update(self, torques: Floats) -> None:
        """Show torques [N m], shape (n_limbs, 2)."""
        for k, (torque, limit) in enumerate(zip(torques.ravel().tolist(), self.limits.tolist(), strict=True)):
            share = abs(torque) / limit
            self.bars[k].set_width(self.length * min(share, 1.0))
            self.bars[k].set_facecolor(style.ALERT if share > NEAR_LIMIT else style.PARTS[(k // 2) % len(style.PARTS)])
            self.values[k].set_text(show_torque(torque if abs(torque) > 1e-9 else 0.0, ounces=self.ounces))


def draw_force_key(axes: Axes, task: LimbedTask, place: Place, inches_per_metre: float) -> None:
    """An arrow of a round force, in the scale of the picture."""
    force = nice_force(task.robot.weight)
    length = force * force_scale(task) * inches_per_metre
    axes.add_patch(
        FancyArrowPatch(
            (place.left, place.top), (place.left + length, place.top), arrowstyle="-|>", mutation_scale=9, lw=1.6,
            color=style.FORCE, shrinkA=0, shrinkB=0,
        )
    )  # fmt: skip
    words = f"{force:g} N, force of a hold on its limb"
    axes.text(place.left + length + 0.1, place.top, words, fontsize=7, va="center", color=style.QUIET)


class StepStrip:
    """A coloured cell per step, and a mark at the step that is shown."""

    def __init__(self, axes: Axes, grades: list[int], place: Place) -> None:
        self.place, self.count = place, max(len(grades), 1)
        axes.text(place.left, place.top, "Smallest margin of every step", fontsize=9, weight="bold", va="top")
        height, top = 0.15, place.top - 0.28
        cells = np.array([[int(style.STRIP[g][k : k + 2], 16) for k in (1, 3, 5)] for g in grades or [3]], np.uint8)
        axes.imshow(
            cells[None], extent=(place.left, place.left + place.width, top - height, top), aspect="auto",
            interpolation="nearest", zorder=1,
        )  # fmt: skip
        for k, (colour, words) in enumerate(zip(style.STRIP, style.STRIP_WORDS, strict=True)):
            x = place.left + k * place.width / 4
            axes.add_patch(Rectangle((x, top - height - 0.25), 0.11, 0.11, fc=colour, lw=0))
            axes.text(x + 0.15, top - height - 0.2, words, fontsize=6.5, va="center", color=style.QUIET)
        (self.mark,) = axes.plot([], [], marker="v", ms=6, color=style.INK, ls="")
        self.y = top + 0.05

    @property
    def artists(self) -> list[Artist]:
        """The artists that change."""
        return [self.mark]

    def update(self, step: int) -> None:
        """Point at a step, from 1; 0 is the start."""
        x = self.place.left + self.place.width * min(max(step - 0.5, 0.0) / self.count, 1.0)
        self.mark.set_data([x], [self.y])
