"""A walker's plan at any moment: the ground with the walker on it as updatable artists, its frames and actuators."""

import math
from typing import Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Polygon, Rectangle

from ....planning.problem.problem import Replay
from ....types import Floats
from ....units import DEGREE
from ....viewing import style
from ....viewing.recording import Part, PlanView
from ....viewing.scene import (
    Bounds,
    describe_pose,
    draw_forbidden,
    draw_region,
    fit_bounds,
    goal_box,
    label_region,
    length_unit,
    name_goal,
    set_axes,
)
from ....viewing.view import CloseUp, Picture
from ..planning.task import WalkerTask
from ..robot import FRAME_TITLES
from ..statics.checks import WALKER_CHECKS
from ..world.ground import Block
from .walker_loads import actuator_gauges
from .walker_motion import COLOURS, WalkerMoment, settled_moment, walker_motion

RISE: Final = 0.25
"""By what share of its radius a lifted foot looks larger, for it is nearer to the eye [-]."""
SUPPORT: Final = "#8FA3B5"
HIGHER: Final = "#F3EAD7"
LOWER: Final = "#D9D4C8"
MOST_NAMED: Final = 12
"""Grounds of more blocks, such as rough ones, are drawn without their heights, which nobody could read."""


def walker_bounds(task: WalkerTask, moments: list[WalkerMoment]) -> Bounds:
    """The part of the ground that holds every moment, the goals' edges and the patches close by."""
    points = np.vstack([np.vstack([*at.outline.frames, at.outline.feet.reshape(-1, 2)]) for at in moments])
    x0, x1, y0, y1 = fit_bounds(points, task.goals)
    room = 0.5 * max(task.robot.legs.radius_delta, task.robot.legs.radius_y)
    corners = [np.array(patch) for patch in task.world.forbidden()]
    low, high = (x0 - room, y0 - room), (x1 + room, y1 + room)
    near = [patch for patch in corners if np.all((patch >= low) & (patch <= high))]
    return fit_bounds(np.vstack([points, *near]), task.goals)


def foot_radius(task: WalkerTask, bounds: Bounds) -> float:
    """Radius with which a foot is drawn, so that it can be seen [m]."""
    return max(task.robot.legs.pad_radius, 0.006 * max(bounds[1] - bounds[0], bounds[3] - bounds[2]))


def draw_ground(axes: Axes, task: WalkerTask, bounds: Bounds) -> None:
    """Draw patches and goals, and set up the axes."""
    set_axes(axes, task, bounds)
    raised = task.world.raised()
    for block in raised:
        draw_block(axes, block, bounds, named=len(raised) <= MOST_NAMED)
    draw_forbidden(axes, task.world.forbidden())
    for index, goal in enumerate(task.goals):
        corners = goal_box(goal, bounds)
        if corners is not None:
            draw_region(axes, corners, last=index == len(task.goals) - 1)
            label_region(axes, corners, name_goal(task.goals, index), bounds, 7.0)


def draw_block(axes: Axes, block: Block, bounds: Bounds, *, named: bool) -> None:
    """Draw a level part of the ground, with its height if it is `named`."""
    colour = HIGHER if block.height > 0.0 else LOWER
    axes.add_patch(Polygon(np.array(block.corners()), fc=colour, ec=style.QUIET, lw=1.0, zorder=0.6))
    x0, x1, y0, y1 = bounds
    xs, ys = (
        np.clip([corner[axis] for corner in block.corners()], low, high)
        for axis, low, high in ((0, x0, x1), (1, y0, y1))
    )
    if named and xs.max() > xs.min() and ys.max() > ys.min():
        edge = 0.015 * (x1 - x0)
        axes.text(
            xs.max() - edge,
            ys.min() + edge,
            f"{100 * block.height:+.3g} cm",
            ha="right",
            fontsize=7,
            color=style.QUIET,
            zorder=0.7,
        )


class WalkerArtists:
    """A two-frame walker on Matplotlib axes."""

    def __init__(self, axes: Axes, task: WalkerTask, bounds: Bounds, *, alpha: float = 1.0) -> None:
        """Make the artists; `update` puts them where they belong.

        Args:
            axes: Where to draw; data in world metres.
            task: The task; its robot is read.
            bounds: The picture's part of the ground, for the size of small things.
            alpha: Opacity of everything; ghosts have less.
        """
        self.radius = foot_radius(task, bounds)
        self.support = Polygon(np.zeros((1, 2)), fc=SUPPORT, ec=SUPPORT, lw=1.0, ls="--", alpha=0.35 * alpha, zorder=3)
        axes.add_patch(self.support)
        self.rods = [axes.add_line(Line2D([], [], color=colour, lw=3.2, alpha=alpha)) for colour in COLOURS]
        for rod in self.rods:
            rod.set_solid_capstyle("round")
            rod.set_solid_joinstyle("round")
        self.plate = Polygon(np.zeros((1, 2)), fc=COLOURS[0], ec="none", alpha=0.10 * alpha, zorder=4)
        axes.add_patch(self.plate)
        self.actuators: list[Line2D] = []
        for lw, colour in ((3.0, style.PAPER), (1.8, style.INK)):
            line = Line2D([], [], color=colour, lw=lw, alpha=alpha, zorder=5.5, marker="o", ms=lw + 1.2, mec="none")
            self.actuators.append(axes.add_line(line))
        self.feet: list[list[Circle]] = []
        for colour in COLOURS:
            circles = [Circle((0, 0), self.radius, fc=colour, ec=colour, lw=1.6, alpha=alpha) for _ in range(3)]
            for circle in circles:
                axes.add_patch(circle)
            self.feet.append(circles)
        self.mass = [
            axes.add_line(
                Line2D([], [], marker=marker, ms=size, mfc=face, mec=style.INK, mew=1.4, alpha=alpha, ls="", zorder=8)
            )
            for marker, size, face in (("o", 9.0, style.PAPER), ("+", 9.0, style.INK))
        ]

    @property
    def artists(self) -> list[Artist]:
        """See `Robot`."""
        feet = [circle for circles in self.feet for circle in circles]
        every = [self.support, self.plate, *self.rods, *self.actuators, *feet, *self.mass]
        return sorted(every, key=lambda artist: artist.get_zorder())

    def update(self, at: WalkerMoment) -> None:
        """Put every artist where a moment has it; a lifted frame is over a standing one."""
        delta, y = at.outline.frames
        self.support.set_xy(at.support)
        self.plate.set_xy(delta)
        shapes = (delta[[0, 1, 2, 0]], y[[1, 0, 2, 0, 3]])
        for f, rod in enumerate(self.rods):
            rod.set_data(shapes[f][:, 0], shapes[f][:, 1])
            rod.set_zorder(4.5 + 0.5 * at.lifts[f])
            for circle, foot in zip(self.feet[f], at.outline.feet[f], strict=True):
                circle.set_center((float(foot[0]), float(foot[1])))
                circle.set_radius(self.radius * (1.0 + RISE * at.lifts[f]))
                circle.set_facecolor(mixed(COLOURS[f], at.lifts[f]))
                circle.set_zorder(6.0 + 0.5 * at.lifts[f])
        lines = np.concatenate([at.outline.actuators, np.full((3, 1, 2), np.nan)], axis=1).reshape(-1, 2)
        for line in self.actuators:
            line.set_data(lines[:, 0], lines[:, 1])
        for mark in self.mass:
            mark.set_data(at.outline.centre_of_mass[:1], at.outline.centre_of_mass[1:])


def mixed(colour: str, lift: float) -> tuple[float, float, float]:
    """A foot's filling: its colour on the ground, paper when lifted."""
    channels = [(int(colour[k : k + 2], 16), int(style.PAPER[k : k + 2], 16)) for k in (1, 3, 5)]
    r, g, b = ((foot + (paper - foot) * lift) / 255 for foot, paper in channels)
    return r, g, b


def draw_key(panel: Axes, left: float, y: float) -> None:
    """Say in the panel, in inches, what marks, lines and hatching mean."""
    paper, ink, quiet = style.PAPER, style.INK, style.QUIET
    entries: tuple[tuple[str, str, str, float, str], ...] = (
        ("o", quiet, quiet, 0.0, "standing foot"),
        ("o", paper, quiet, 1.02, "lifted foot"),
        ("^", SUPPORT, SUPPORT, 1.88, "support"),
        ("o", paper, ink, 2.55, "centre of mass"),
        ("+", ink, ink, 2.55, ""),
    )
    for marker, face, edge, x, words in entries:
        panel.plot([left + x + 0.06], [y], marker=marker, ms=7, mfc=face, mec=edge, mew=1.3, ls="", clip_on=False)
        panel.text(left + x + 0.17, y, words, fontsize=7, va="center", color=quiet)
    lower = y - 0.2
    for x, colour, width, words in (
        (0.0, ink, 1.2, "actuator"),
        (1.02, COLOURS[0], 3.0, ""),
        (1.22, COLOURS[1], 3.0, "frames"),
    ):
        panel.plot([left + x, left + x + 0.14], [lower, lower], color=colour, lw=width, clip_on=False)
        panel.text(left + x + 0.2, lower, words, fontsize=7, va="center", color=quiet)
    patch = Rectangle((left + 1.88, lower - 0.05), 0.14, 0.1, fc="#ECEEF1", ec=quiet, hatch="//////", lw=0.6)
    panel.add_patch(patch)
    panel.text(left + 2.08, lower, "no foot may stand here", fontsize=7, va="center", color=quiet)


class WalkerView(PlanView[WalkerMoment]):
    """A picture of a walk that can be set to any moment of it."""

    rows = FRAME_TITLES

    def __init__(self, task: WalkerTask, replay: Replay) -> None:
        self.moments = [settled_moment(task, stance) for stance in replay.stances]
        bounds = walker_bounds(task, self.moments)
        super().__init__(task, replay, bounds, actuator_gauges(task.robot))

    def draw(self, picture: Picture[WalkerMoment]) -> WalkerArtists:
        """Ground and walker."""
        draw_ground(picture.wall, self.task, self.bounds)
        for head, colour in zip(picture.heads, COLOURS, strict=False):
            head.set(color=colour, weight="bold")
        draw_key(picture.panel, picture.key.left, picture.key.top)
        return WalkerArtists(picture.wall, self.task, self.bounds)

    def settled(self, step: int) -> WalkerMoment:
        """See `View`."""
        return self.moments[step]

    def motion(self, step: int) -> list[Part[WalkerMoment]]:
        """See `View`."""
        return walker_motion(self.task, self.replay.stances[step - 1], self.replay.stances[step])

    def values(self, at: WalkerMoment) -> tuple[Floats, ...]:
        """Lengths of the actuators [m], shape (3,)."""
        return (at.lengths,)

    def action(self, step: int) -> str:
        """A step in words."""
        return describe_walk(self.task, self.moments[step - 1], self.moments[step], self.reason(step))

    def lines(self, step: int, at: WalkerMoment) -> tuple[str, ...]:
        """Poses of the frames, and which of them stands."""
        return tuple(
            describe_pose(self.task, *pose) + f"  ({'lifted' if lift > 0.0 else 'stands'})"
            for pose, lift in zip(at.poses.tolist(), at.lifts, strict=True)
        )


def describe_walk(task: WalkerTask, before: WalkerMoment, after: WalkerMoment, reason: int) -> str:
    """The action that led from one settled stance to the next, in a few words."""
    words = "stays"
    stood = before.lifts.index(0.0)
    if before.lifts != after.lifts:
        words = f"{FRAME_TITLES[1 - stood]} lands, {FRAME_TITLES[stood]} lifts"
    else:
        dx, dy, turn = (after.poses - before.poses)[1 - stood]
        turn = math.remainder(turn, math.tau)
        unit, size = length_unit(task)
        lifted = FRAME_TITLES[1 - stood]
        if max(abs(dx), abs(dy)) > 1e-9:
            axis, way = ("x", dx) if abs(dx) > abs(dy) else ("y", dy)
            words = f"{lifted} slides {abs(way) / size:.3g} {unit} along {'+' if way > 0 else '−'}{axis}"
        elif abs(turn) > 1e-9:
            words = f"{lifted} turns {turn / DEGREE:+.3g}°"
    return words if reason < 0 else f"{words}, violates {WALKER_CHECKS[reason].name}"


def near_walk(task: WalkerTask, stance: np.void) -> CloseUp:
    """One stance with the part of the ground about it."""
    at = settled_moment(task, stance)
    bounds = fit_bounds(np.vstack([*at.outline.frames, at.outline.feet.reshape(-1, 2)]), ())

    def draw(axes: Axes) -> None:
        draw_ground(axes, task, bounds)
        WalkerArtists(axes, task, bounds).update(at)

    return CloseUp(bounds, draw)


def draw_walk(task: WalkerTask, stance: np.void, axes: Axes) -> None:
    """Draw one stance on given axes, which get the ground alone."""
    at = settled_moment(task, stance)
    bounds = walker_bounds(task, [at])
    draw_ground(axes, task, bounds)
    WalkerArtists(axes, task, bounds).update(at)
