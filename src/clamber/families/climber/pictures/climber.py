"""What moves in a picture: body, limbs, end effectors, held holds and forces of a posture, as updatable artists."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, FancyArrowPatch, Polygon
from matplotlib.text import Annotation

from ....types import Floats
from ....viewing import style
from ....viewing.scene import Bounds, halo
from ..planning.task import LimbedTask
from .geometry import Posture, capsule, end_effector
from .wall import hold_radius

WEIGHT_ARROW: Final = 0.4
"""Length of an arrow as large as the robot's weight, over the longest limb [-]."""
SMALLEST_FORCE: Final = 0.02
"""Smaller forces, over the weight, are not drawn [-]."""


@dataclass(frozen=True, slots=True)
class Snapshot:
    """A posture with the loads that belong to it."""

    posture: Posture
    forces: Floats
    """Force of each limb's hold on it, world frame [N], shape (n_limbs, 2)."""
    torques: Floats
    """Torques of shoulders and elbows [N m], shape (n_limbs, 2)."""


def force_scale(task: LimbedTask) -> float:
    """Length of force arrows [m/N]."""
    return WEIGHT_ARROW * max(limb.length for limb in task.robot.limbs) / task.robot.weight


def arrow_ends(task: LimbedTask, at: Snapshot) -> Floats:
    """Both ends of the arrows of all limbs' forces, world frame [m], shape (2 n_limbs, 2)."""
    tips = at.posture.chains[:, 3]
    holding = np.array([held >= 0 for held in at.posture.held])[:, None]
    ends: Floats = np.concatenate([tips, tips + force_scale(task) * np.where(holding, at.forces, 0.0)])
    return ends


class ClimberArtists:
    """A limbed climber on Matplotlib axes."""

    def __init__(
        self, axes: Axes, task: LimbedTask, bounds: Bounds, *, alpha: float = 1.0, arrows: bool = True
    ) -> None:
        """Make the artists; `update` puts them where they belong.

        Args:
            axes: Where to draw; data in world metres.
            task: The task; robot and board are read.
            bounds: The picture's part of the wall, for the size of small things.
            alpha: Opacity of everything; ghosts have less.
            arrows: Whether forces are drawn.
        """
        self.axes, self.task = axes, task
        robot = task.robot
        self.least = hold_radius(task, bounds)
        self.radius = max(robot.link_radius, 0.004)
        n = len(robot.limbs)
        self.body = Polygon(
            np.zeros((1, 2)), fc=style.BODY, ec=style.INK, lw=1.2, alpha=alpha, zorder=4, joinstyle="round"
        )
        axes.add_patch(self.body)
        self.up = axes.add_line(
            Line2D([], [], color=style.INK, lw=1.2, alpha=alpha, zorder=4.2, solid_capstyle="round")
        )
        self.links: list[Polygon] = []
        self.grips: list[Line2D] = []
        self.rings: list[Circle] = []
        self.joints: list[Line2D] = []
        for i in range(n):
            colour = style.PARTS[i % len(style.PARTS)]
            for _ in range(2):
                link = Polygon(
                    np.zeros((1, 2)), fc=colour, ec=style.PAPER, lw=0.7, alpha=0.88 * alpha, zorder=5 + 0.1 * i
                )
                axes.add_patch(link)
                self.links.append(link)
            line = Line2D([], [], color=colour, lw=1.8, alpha=alpha, zorder=6.5, solid_capstyle="round")
            self.grips.append(axes.add_line(line))
            ring = Circle((0, 0), 2.2 * self.least, fc=colour, ec=style.PAPER, lw=0.6, alpha=0.9 * alpha, zorder=6)
            axes.add_patch(ring)
            self.rings.append(ring)
            dots = Line2D([], [], ls="", marker="o", ms=2.6, mfc=style.PAPER, mec="none", alpha=alpha, zorder=6)
            self.joints.append(axes.add_line(dots))
        self.numbers: list[Annotation] = []
        for _ in range(n if arrows else 0):
            number = axes.annotate(
                "", (0.0, 0.0), xytext=(-4, 4), textcoords="offset points", ha="right", va="bottom", fontsize=7.5,
                weight="bold", color=style.INK, zorder=8, path_effects=[halo(2.5)],
            )  # fmt: skip
            self.numbers.append(number)
        self.arrows: list[FancyArrowPatch] = []
        for _ in range(n if arrows else 0):
            arrow = FancyArrowPatch(
                (0, 0),
                (0, 0),
                arrowstyle="-|>",
                mutation_scale=9,
                lw=1.6,
                color=style.FORCE,
                zorder=7,
                shrinkA=0,
                shrinkB=0,
                clip_on=False,
            )
            axes.add_patch(arrow)
            self.arrows.append(arrow)

    @property
    def artists(self) -> list[Artist]:
        """All artists, from back to front."""
        every = [self.body, self.up, *self.links, *self.grips, *self.rings, *self.joints, *self.arrows, *self.numbers]
        return sorted(every, key=lambda artist: artist.get_zorder())

    def update(self, at: Snapshot) -> None:
        """Put every artist where a snapshot has it."""
        posture = at.posture
        self.body.set_xy(posture.outline)
        size = 0.5 * float(np.ptp(posture.outline, axis=0).min())
        top = posture.x - 0.5 * size * math.sin(posture.angle), posture.y + 0.5 * size * math.cos(posture.angle)
        self.up.set_data([posture.x, top[0]], [posture.y, top[1]])
        for i, limb in enumerate(self.task.robot.limbs):
            port, elbow, wrist, tip = posture.chains[i]
            self.links[2 * i].set_xy(capsule(port, elbow, self.radius))
            self.links[2 * i + 1].set_xy(capsule(elbow, wrist, 0.8 * self.radius))
            held = posture.held[i]
            least = max(2.2 * self.least, self.radius * 0.9)
            line = end_effector(limb.end.kind, tip, float(posture.grips[i]), 1.35 * least, closed=held >= 0)
            if limb.end.offset > 0.0:
                line = np.vstack([line, line[-1:] * np.nan, [wrist, tip]])
            self.grips[i].set_data(line[:, 0], line[:, 1])
            self.joints[i].set_data([port[0], elbow[0]], [port[1], elbow[1]])
            self.rings[i].set_visible(held >= 0)
            if held >= 0:
                hold = self.task.world.holds[held]
                self.rings[i].set_center((hold.x, hold.y))
                self.rings[i].set_radius(max(hold.radius, self.least) * 1.25)
        for number, held in zip(self.numbers, posture.held, strict=False):
            number.set_visible(held >= 0)
            if held >= 0:
                hold = self.task.world.holds[held]
                number.xy = (hold.x, hold.y)
                number.set_text(str(hold.number))
        scale = force_scale(self.task)
        for i, arrow in enumerate(self.arrows):
            force = at.forces[i]
            seen = float(np.hypot(*force)) > SMALLEST_FORCE * self.task.robot.weight and posture.held[i] >= 0
            arrow.set_visible(seen)
            if seen:
                start = posture.chains[i, 3]
                end = start + scale * force
                arrow.set_positions((float(start[0]), float(start[1])), (float(end[0]), float(end[1])))
