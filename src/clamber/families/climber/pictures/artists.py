"""A climber's picture: the wall with its holds, keep-outs and goals, the climber as updatable artists, its loads."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import PatchCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, FancyArrowPatch, Polygon, Wedge
from matplotlib.text import Annotation

from ....shown_units import units_of
from ....types import Floats
from ....units import DEGREE
from ....viewing import style
from ....viewing.panel import Gauges, Place
from ....viewing.scene import (
    Bounds,
    draw_forbidden,
    draw_region,
    fit_bounds,
    goal_box,
    halo,
    label_region,
    name_goal,
    set_axes,
)
from ..planning.task import Goal, LimbedTask
from .geometry import Posture, capsule, end_effector

CROWDED: Final = 0.16
"""Holds are drawn no larger than this share of their spacing [-]."""
NUMBER_WIDTH: Final = 0.045
"""Width of a hold's number, as a share of the picture [-]: with less room none could be told apart, and none is drawn."""


def find_bounds(task: LimbedTask, postures: list[Posture], arrows: Floats | None = None) -> Bounds:
    """The part of the wall that holds the board, closed goals, every posture and the tips of arrows, shape (n, 2)."""
    parts: list[Floats] = [task.world.positions()]
    parts += [np.array(polygon) for polygon in task.world.keep_out]
    parts += [np.vstack([posture.outline, posture.chains.reshape(-1, 2)]) for posture in postures]
    parts += [np.array(goal.region) for goal in task.goals if goal.region is not None]
    parts += [] if arrows is None else [arrows]
    return fit_bounds(np.vstack(parts), task.goals)


def hold_radius(task: LimbedTask, bounds: Bounds) -> float:
    """Smallest radius with which a hold is drawn, so that it can be seen [m]."""
    return min(0.0045 * max(bounds[1] - bounds[0], bounds[3] - bounds[2]), CROWDED * spacing(task))


def spacing(task: LimbedTask) -> float:
    """About how far apart the holds are [m]: the root of the area that each has; infinite for fewer than two."""
    points = task.world.positions()
    if len(points) < 2:
        return math.inf
    width, height = np.maximum(points.max(axis=0) - points.min(axis=0), 1e-3)
    return math.sqrt(width * height / len(points))


def goal_outline(goal: Goal, bounds: Bounds) -> Floats | None:
    """Corners of a goal's region or box, open sides cut off at the picture's edge, shape (n, 2); None without either."""
    return goal_box(goal, bounds) if goal.region is None else np.array(goal.region, dtype=np.float64)


def goal_label(task: LimbedTask, index: int) -> str:
    """What a goal is called in pictures."""
    goal = task.goals[index]
    extra = [f"{limb} on {number}" for limb, number in goal.holds.items()]
    if goal.turns is not None:
        extra.insert(0, f"{goal.turns:+g} turn" + ("s" if abs(goal.turns) != 1 else ""))
    return name_goal(task.goals, index, extra)


def draw_scene(axes: Axes, task: LimbedTask, bounds: Bounds, *, font: float = 7.0) -> None:
    """Draw wall, keep-outs, goals and holds, numbered if there is room, and set up the axes."""
    set_axes(axes, task, bounds)
    draw_forbidden(axes, task.world.keep_out)
    _draw_goals(axes, task, bounds, font)
    least = hold_radius(task, bounds)
    discs, cones = [], []
    for hold in task.world.holds:
        radius = max(hold.radius, least)
        discs.append(Circle((hold.x, hold.y), radius))
        if hold.direction is not None:
            half = math.pi / 2 if hold.cone is None else hold.cone
            lower, upper = (hold.direction - half) / DEGREE, (hold.direction + half) / DEGREE
            cones.append(Wedge((hold.x, hold.y), 3.2 * radius, lower, upper))
    # One collection of all: ten thousand patches of their own take a quarter of a minute to draw.
    axes.add_collection(PatchCollection(cones, facecolor=style.HOLD, edgecolor="none", alpha=0.25, zorder=1.9))
    axes.add_collection(PatchCollection(discs, facecolor=style.HOLD, edgecolor="none", zorder=2))
    if spacing(task) > NUMBER_WIDTH * max(bounds[1] - bounds[0], bounds[3] - bounds[2]):
        _number_holds(axes, task, font - (1.5 if len(task.world.holds) > 80 else 0.0))


def _number_holds(axes: Axes, task: LimbedTask, font: float) -> None:
    for hold in task.world.holds:
        axes.annotate(
            str(hold.number),
            (hold.x, hold.y),
            xytext=(-3, 3),
            textcoords="offset points",
            ha="right",
            va="bottom",
            fontsize=font,
            color=style.QUIET,
            zorder=2.5,
            path_effects=[halo()],
        )


def _draw_goals(axes: Axes, task: LimbedTask, bounds: Bounds, font: float) -> None:
    least = hold_radius(task, bounds)
    for index, goal in enumerate(task.goals):
        corners = goal_outline(goal, bounds)
        places = []
        if corners is not None:
            draw_region(axes, corners, last=index == len(task.goals) - 1)
        if goal.turns is not None and goal.centre is not None:
            axes.plot(*goal.centre, marker="+", ms=9, mew=1.2, color=style.GOAL, zorder=0.7)
            places.append(goal.centre)
        for number in goal.holds.values():
            hold = task.world.by_number(number)
            ring = Circle((hold.x, hold.y), 2.2 * least + hold.radius, fill=False, ec=style.GOAL, lw=1.4, zorder=1.5)
            axes.add_patch(ring)
            places.append((hold.x, hold.y))
        if corners is not None or places:
            at = corners if corners is not None else np.array(places[:1])
            label_region(axes, at, goal_label(task, index), bounds, font)


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


def unloaded(posture: Posture) -> Snapshot:
    """A posture without loads."""
    nothing = np.zeros((len(posture.held), 2))
    return Snapshot(posture, nothing, nothing)


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
        """See `Robot`."""
        every = [self.body, self.up, *self.links, *self.grips, *self.rings, *self.joints, *self.arrows, *self.numbers]
        return sorted(every, key=lambda artist: artist.get_zorder())

    def update(self, at: Snapshot) -> None:
        """See `Robot`."""
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


NEAR_LIMIT: Final = 0.9
"""Share of a joint's limit beyond which its bar turns red [-]."""


def torque_limits(task: LimbedTask) -> Floats:
    """Torque limits of shoulders and elbows [N m], shape (n_limbs, 2)."""
    return np.array([task.robot.torque_limit_of(joint) for joint in task.robot.joints]).reshape(-1, 2)


def nice_force(weight: float) -> float:
    """A round force for the key, near half the weight [N]."""
    return next(f for f in (1000, 500, 200, 100, 50, 20, 10, 5, 2, 1, 0.5, 0.2, 0.1, 0.0) if f <= 0.6 * weight)


def torque_gauges(task: LimbedTask) -> Gauges:
    """One bar per shoulder and elbow: share of its torque limit, red beyond nine tenths."""
    limits = torque_limits(task).ravel()
    return Gauges(
        title="Joint torques",
        names=task.robot.joint_names,
        colours=tuple(style.PARTS[(k // 2) % len(style.PARTS)] for k in range(len(limits))),
        low=np.zeros(len(limits)),
        high=limits,
        limits=((1.0, "limit"),),
        calm=(0.0, NEAR_LIMIT),
        unit=units_of(task.document).torque,
        group=2,
    )


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
