"""A walk as it truly was: from the side and from above, with the plate's tilt and the margin of balance over time; still or animated."""

import math
from collections.abc import Callable
from typing import Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Polygon

from ....types import Floats
from ....units import DEGREE
from ....viewing import style
from ....viewing.recording import Frame
from ....viewing.scene import draw_forbidden
from ....viewing.style import bare
from ..execution.true_walk import TrueWalk
from ..robot import FRAME_TITLES, WalkerRobot
from ..trials.run_walk import WalkRun
from ..world.ground import Ground, Surface
from .walker_motion import COLOURS, WalkShapes, shapes_at

ROOM: Final = 0.45
"""About the plate's way, that is shown [m] ..."""
EDGE: Final = 0.05
"""... and beyond the tool [m]."""
SIDE: Final = 3.1
"""Width of the side view over its height, at least [-]."""
WIDTH: Final = 9.0
"""Of a picture [inch]."""
CURVE: Final = (2.7, 0.85)
"""Least width and height of a curve over time [inch]."""
TALLEST: Final = 5.0
"""View from above, at most [inch]."""
WORDS: Final = 0.45
"""What a title and an axis's numbers take, of height and width [inch]."""
GHOSTS: Final = 5
FRAMES: Final = 300
"""Of an animation, at most."""
SECONDS: Final = 1.0
"""Of the walk between two frames, at least."""
FEW: Final = 100_000
"""Samples of a curve, at most: kicks are as short as a tenth of a second."""
RELIEF: Final = LinearSegmentedColormap.from_list("relief", ["#8FA3B5", "#F7F8FA", "#C9B28F"])
"""Ditches, the slope itself, steps."""


class WalkRunView:
    """A picture of a walk that can be set to any moment of it.

    Args:
        robot: The walker.
        ground: As it truly is.
        trace: What happened.
        title: Above the picture.
    """

    def __init__(self, robot: WalkerRobot, ground: Ground, trace: TrueWalk, title: str) -> None:
        self.robot, self.trace, self._surface = robot, trace, Surface(ground)
        way = trace.pose[-1, :2] - trace.pose[0, :2]
        self._along = way / np.hypot(*way) if np.hypot(*way) > 0.05 else np.array((1.0, 0.0))
        self.figure = Figure(layout="constrained")
        self.figure.set_facecolor(style.PAPER)
        style.entitle(self.figure, title)
        side, top = self._side_box(), self._top_box()
        places = _arrange(self.figure, _shape(side), _shape(top))
        self.side, self.top = places["side"], places["top"]
        self._set_side(side)
        self._set_top(ground, top)
        self.clocks = [
            _curve(places["tilt"], trace, trace.tilts / DEGREE, "tilt of the plate [deg]"),
            _curve(places["margin"], trace, 1e3 * trace.margins, "margin of balance [mm]"),
        ]
        self._tell_parts()
        self.walkers = [_Drawn(self.side, self.from_side), _Drawn(self.top, _from_above, support=True)]
        self.time_text = self.side.text(
            0.99, 0.97, "", transform=self.side.transAxes, ha="right", va="top", fontsize=8.5
        )
        self.show(0, len(trace.time) - 1)

    def _tell_parts(self) -> None:
        """Say below all of it what lines and marks are."""
        arm = [Line2D([], [], color=style.BODY, lw=3.0, label="arm")] if self.robot.arm is not None else []
        feet = [
            Line2D([], [], ls="", marker="o", ms=4.5, color=style.QUIET, mfc=face, label=words)
            for face, words in ((style.QUIET, "foot on the ground"), (style.PAPER, "foot in the air"))
        ]
        parts = [
            Line2D([], [], color=colour, lw=3.0, label=name) for colour, name in zip(COLOURS, FRAME_TITLES, strict=True)
        ]
        self.figure.legend(
            handles=[
                *parts, Line2D([], [], color=style.INK, lw=1.2, label="actuator"), *arm, *feet,
                Line2D([], [], ls="", marker=".", ms=4.0, color=COLOURS[0], alpha=0.7, label="footprint"),
                Line2D([], [], ls="", marker="+", ms=8.0, mew=1.4, color=style.INK, label="centre of mass"),
                Patch(fc="#8FA3B5", alpha=0.35, label="support"),
            ],
            loc="outside lower center", ncols=5, fontsize=7.5,
        )  # fmt: skip

    @property
    def artists(self) -> list[Artist]:
        """The artists that change, from back to front."""
        return [*(artist for walker in self.walkers for artist in walker.artists), *self.clocks, self.time_text]

    def show(self, _: int, k: int) -> None:
        """Set the picture to a row of the trace."""
        shapes = shapes_at(self.robot, self.trace, k)
        for walker in self.walkers:
            walker.update(shapes)
        time = float(self.trace.time[k])
        for clock in self.clocks:
            clock.set_xdata([time, time])
        self.time_text.set_text(f"{time:.0f} s")

    def frames(self, most: int) -> list[Frame[int]]:
        """What an animation shows: rows of the trace."""
        count = int(min(FRAMES, most, max(2.0, self.trace.time[-1] / SECONDS)))
        return [Frame(0, int(k), 1.0) for k in np.linspace(0, len(self.trace.time) - 1, count).astype(int)]

    def whole(self) -> Figure:
        """The end of the walk, and faintly where the robot was before."""
        for k in np.linspace(0, len(self.trace.time) - 1, GHOSTS).astype(int)[:-1]:
            shapes = shapes_at(self.robot, self.trace, int(k))
            for axes, project in ((self.side, self.from_side), (self.top, _from_above)):
                _Drawn(axes, project, alpha=0.22).update(shapes)
        return self.figure

    def from_side(self, points: Floats) -> Floats:
        """Points of the world as the side view has them: along the way, and height [m]."""
        return np.stack((points[..., :2] @ self._along, points[..., 2]), axis=-1)

    def _side_box(self) -> Floats:
        """What the side view shows: along the way and height, least and most, shape (2, 2) [m]."""
        trace = self.trace
        along = trace.pose[:, :2] @ self._along
        bottom = float(np.nanmin(trace.feet[..., 2])) - 0.12
        top = float(np.fmax(trace.pose[:, 2], trace.tool[:, 2]).max()) + 0.15
        low, high = float(along.min()) - ROOM, float(along.max()) + ROOM
        high = float(np.fmax(high, trace.tool[-1, :2] @ self._along + EDGE))
        middle, half = 0.5 * (low + high), max(0.5 * (high - low), 0.5 * SIDE * (top - bottom))
        return np.array(((middle - half, bottom), (middle + half, top)))

    def _top_box(self) -> Floats:
        """What the view from above shows: x and y, least and most, shape (2, 2) [m]."""
        way, tool = self.trace.pose[:, :2], self.trace.tool[-1, :2]  # on its way the arm may swing out of the picture
        low, high = np.fmin(way.min(axis=0) - ROOM, tool - EDGE), np.fmax(way.max(axis=0) + ROOM, tool + EDGE)
        return np.stack((low, high))

    def _set_side(self, box: Floats) -> None:
        trace, axes = self.trace, self.side
        (low, bottom), (high, top) = box.tolist()
        across = np.array((-self._along[1], self._along[0]))
        ways = np.linspace(low, high, 600)
        offsets = trace.pose[0, :2] @ across + np.linspace(-0.3, 0.3, 7)
        heights = self._surface.heights(ways[:, None, None] * self._along + offsets[None, :, None] * across)
        heights[np.isinf(heights)] = math.nan
        axes.fill_between(ways, np.nanmin(heights, axis=1), np.nanmax(heights, axis=1), color=style.FAINT, lw=0)
        axes.plot(ways, heights[:, 3], color=style.QUIET, lw=1.2)
        axes.set(xlim=(low, high), ylim=(bottom, top))
        axes.set_aspect("equal")
        axes.set_ylabel("height [m]")
        axes.set_title("from the side, along its way [m]", fontsize=9, weight="normal")
        bare(axes)

    def _set_top(self, ground: Ground, box: Floats) -> None:
        trace, axes = self.trace, self.top
        (x0, y0), (x1, y1) = box.tolist()
        xs, ys = np.linspace(x0, x1, 300), np.linspace(y0, y1, 300)
        places = np.stack(np.meshgrid(xs, ys), axis=-1)
        rise = math.tan(ground.slope) * np.array((math.cos(ground.uphill), math.sin(ground.uphill)))
        relief = self._surface.heights(places) - places @ rise
        size = max(0.03, float(np.abs(relief[np.isfinite(relief)]).max(initial=0.0)))
        axes.imshow(
            np.clip(relief, -size, size),
            extent=(x0, x1, y0, y1),
            origin="lower",
            cmap=RELIEF,
            vmin=-size,
            vmax=size,
            zorder=0,
        )
        seen = [
            (np.column_stack([patch, np.zeros(len(patch))]) @ ground.axes().T)[:, :2] for patch in ground.forbidden()
        ]
        draw_forbidden(axes, map(np.ndarray.tolist, seen))
        for f, colour in enumerate(COLOURS):
            for spots in footprints(trace, f):
                axes.plot(spots[:, 0], spots[:, 1], ls="", marker="o", ms=2.6, color=colour, alpha=0.6, zorder=3)
        axes.plot(trace.centre[:, 0], trace.centre[:, 1], color=style.INK, lw=0.8, zorder=4)
        if ground.slope > 0.0:
            x, y = x0 + 0.12, y1 - 0.12
            dx, dy = 0.09 * math.cos(ground.uphill), 0.09 * math.sin(ground.uphill)
            arrow = {"arrowstyle": "->", "color": style.QUIET}
            axes.annotate("", (x + dx, y + dy), (x - dx, y - dy), arrowprops=arrow)
            words = f"up {ground.slope / DEGREE:.0f}°"
            axes.text(x, y - 0.1, words, fontsize=7.5, ha="center", va="top", color=style.QUIET)
        axes.set(xlim=(x0, x1), ylim=(y0, y1))
        axes.set_aspect("equal")
        axes.set_title("from above [m]", fontsize=9, weight="normal")
        bare(axes)


def _shape(box: Floats) -> float:
    """Width over height [-]."""
    width, height = (box[1] - box[0]).tolist()
    return float(width / height)


def _arrange(figure: Figure, side: float, top: float) -> dict[str, Axes]:
    """Axes for the side view, the view from above and two curves, so that views of these shapes fill theirs.

    The curves are beside the view from above, or below it where it is so wide that they would be small there.
    """
    whole = WIDTH - WORDS
    height = min(TALLEST, (whole - WORDS - CURVE[0]) / top)
    rows, side_height = 2.0 * (CURVE[1] + WORDS), whole / side
    if height + WORDS >= rows:
        figure.set_size_inches(WIDTH, side_height + height + 3.6 * WORDS)
        places = figure.subplot_mosaic(
            [["side", "side"], ["top", "tilt"], ["top", "margin"]],
            height_ratios=(side_height + WORDS, 0.5 * (height + WORDS), 0.5 * (height + WORDS)),
            width_ratios=(height * top + WORDS, whole - height * top),
        )
    else:
        height = whole / top
        figure.set_size_inches(WIDTH, side_height + height + 1.5 * CURVE[1] + 6.0 * WORDS)
        places = figure.subplot_mosaic(
            [["side", "side"], ["top", "top"], ["tilt", "margin"]],
            height_ratios=(side_height + WORDS, height + WORDS, 1.5 * CURVE[1] + 2.0 * WORDS),
        )
        places["tilt"].set_xlabel("time [s]")
    places["margin"].set_xlabel("time [s]")
    return places


class _Drawn:
    """A walker on axes, through a projection of points of the world to them."""

    def __init__(
        self, axes: Axes, project: Callable[[Floats], Floats], *, support: bool = False, alpha: float = 1.0
    ) -> None:
        self._project = project

        def line(colour: str, width: float, order: float, **keys: object) -> Line2D:
            return axes.add_line(Line2D([], [], color=colour, lw=width, alpha=alpha, zorder=order, **keys))  # type: ignore[arg-type]

        self.support = Polygon(np.zeros((1, 2)), fc="#8FA3B5", ec="none", alpha=0.35, zorder=2.5, visible=support)
        axes.add_patch(self.support)
        self.legs = [[line(COLOURS[f], 1.4, 5.0) for _ in range(3)] for f in range(2)]
        self.soles = [
            [line(COLOURS[f], 0.0, 7.0, marker="o", ms=4.5, mec=COLOURS[f]) for _ in range(3)] for f in range(2)
        ]
        self.actuators = [line(style.INK, 1.2, 5.5) for _ in range(3)]
        self.frames = [line(COLOURS[f], 3.0, 6.0, solid_joinstyle="round") for f in range(2)]
        self.arm = line(style.BODY, 3.0, 6.5, solid_joinstyle="round")
        self.centre = line(style.INK, 0.0, 8.0, marker="+", ms=8.0, mew=1.4)

    @property
    def artists(self) -> list[Artist]:
        """See `Robot`."""
        legs, soles = ([one for three in six for one in three] for six in (self.legs, self.soles))
        return [self.support, *legs, *self.actuators, *self.frames, self.arm, *soles, self.centre]

    def update(self, at: WalkShapes) -> None:
        """Put every artist where a moment has it; a foot in the air is empty."""

        def put(artist: Line2D, points: Floats) -> None:
            flat = self._project(points).reshape(-1, 2)
            artist.set_data(flat[:, 0], flat[:, 1])

        for f in range(2):
            put(self.frames[f], at.frames[f])
            for i in range(3):
                put(self.legs[f][i], at.legs[f, i])
                put(self.soles[f][i], at.legs[f, i, 1:])
                self.soles[f][i].set_markerfacecolor(COLOURS[f] if at.touching[f, i] else style.PAPER)
        for artist, ends in zip(self.actuators, at.actuators, strict=True):
            put(artist, ends)
        put(self.arm, at.arm)
        put(self.centre, at.centre[None])
        if self.support.get_visible():
            feet = at.legs[:, :, 1, :2].reshape(6, 2)[at.touching.ravel() > 0]
            turned = np.arctan2(*(feet - feet.mean(axis=0)).T[::-1]) if len(feet) else np.zeros(0)
            self.support.set_xy(feet[np.argsort(turned)] if len(feet) else np.zeros((1, 2)))


def _from_above(points: Floats) -> Floats:
    return points[..., :2]


def _curve(axes: Axes, trace: TrueWalk, values: Floats, label: str) -> Line2D:
    some = np.unique(np.linspace(0, len(trace.time) - 1, FEW).astype(int))
    shown = np.where(np.isfinite(values), values, math.nan)[some]
    axes.plot(trace.time[some], shown, color=style.PARTS[0], lw=0.9)
    axes.axhline(0.0, color=style.QUIET, lw=0.6)
    axes.set_title(label, fontsize=9, weight="normal")
    axes.set_xlim(trace.time[0], max(trace.time[-1], 1e-3))
    bare(axes)
    return axes.axvline(0.0, color=style.ALERT, lw=0.9)


def footprints(trace: TrueWalk, f: int) -> list[Floats]:
    """Where each foot of a frame came down, seen from above, three arrays of shape (steps, 2) [m]."""
    found = []
    for i in range(3):
        touching = trace.touching[:, f, i]
        down = np.flatnonzero(np.diff(touching, prepend=0) > 0)
        found.append(trace.feet[down, f, i, :2])
    return found


def run_picture(run: WalkRun) -> WalkRunView:
    """A walk just carried out."""
    return WalkRunView(run.walk.robot, run.walk.ground, run.true, run.walk.title or run.walk.name)
