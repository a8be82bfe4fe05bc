"""Pictures and scenes of a family that brings none: its body, the holds of its world, and which limb is on which."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..family import family_of
from ..planning.problem.body_pose import describe_body_pose
from ..planning.problem.problem import Replay
from ..shown_units import units_of
from ..types import Floats
from . import style
from .browser.solids import FOV, Camera, Scenery, World, colour
from .browser.solids import Figure as Solid
from .browser.viewer_content import Scenes
from .panel import Gauges
from .pictures import Pictures
from .recording import Part, PlanView
from .route import count_actions, whole_title
from .scene import Bounds, draw_region, fit_bounds, goal_box, set_axes
from .view import Layout, Picture

if TYPE_CHECKING:
    import viser

BODY: Final = 0.02
"""Radius of the body's ball, of the larger side of what is shown [-]."""
MOST_NUMBERED: Final = 200
"""Worlds with more holds show them without their numbers."""
FACTS_HEIGHT: Final = 0.6
"""Of a whole plan's panel [in]."""


@dataclass(frozen=True, slots=True)
class Moment:
    """A robot at one moment."""

    pose: Floats
    """Of the body, a number [m] or [rad] for each of the family's `pose_axes`, at least two: it is drawn at the first two."""
    tips: Floats
    """Place of each limb's hold, shape (limbs, 2) [m]; NaN for limbs that are free."""
    holds: tuple[int, ...]
    """Number of each limb's hold; 0: it is free."""
    shares: Floats
    """Margin of each check of the step, as a share of what is limited, shape (n,) [-]; NaN where it has none."""


def holds_of(task: Any) -> dict[int, tuple[float, float]]:
    """Number -> place of the holds that a task's world has [m]; empty where it names none."""
    return {hold.number: (hold.x, hold.y) for hold in getattr(task.world, "holds", ())}


def moment_of(task: Any, stance: np.void, shares: Floats, places: dict[int, tuple[float, float]]) -> Moment:
    """The moment of a stance; `places` are the world's `holds_of`."""
    plans = family_of(task).plans
    held = tuple(plans.holds(task, stance).values())
    tips = np.array([places.get(number, (math.nan, math.nan)) for number in held]).reshape(-1, 2)
    return Moment(np.array(plans.pose(task, stance)), tips, held, shares)


def pose_words(task: Any, at: Moment) -> str:
    """The body's pose in words."""
    return describe_body_pose(family_of(task).plans.pose_axes, tuple(at.pose.tolist()), units_of(task.document))


class PlainView(PlanView[Moment]):
    """A plan whose robot is a body with lines to its holds."""

    rows = ("Pose", "Holds")

    def __init__(self, task: Any, replay: Replay) -> None:
        plans = family_of(task).plans
        self.limbs = tuple(plans.holds(task, replay.stances[0]))
        sizes = plans.sizes(task)
        self.checks = [k for k, check in enumerate(plans.checks) if sizes.get(check.name, 0.0) > 0.0]
        widths = np.array([sizes[plans.checks[k].name] for k in self.checks])
        nothing = np.full((1, len(self.checks)), math.nan)
        shares = np.vstack([nothing, replay.margins[:, self.checks] / widths])
        places, rows = holds_of(task), zip(replay.stances, shares, strict=True)
        self.moments = [moment_of(task, stance, row, places) for stance, row in rows]
        names = tuple(plans.checks[k].name for k in self.checks)
        colours = tuple(style.PARTS[k % len(style.PARTS)] for k in range(len(names)))
        gauges = Gauges(
            title="Share of each limit that is left",
            names=names,
            colours=colours,
            low=np.zeros(len(names)),
            high=np.ones(len(names)),
            limits=(),
            calm=(0.0, math.inf),
            unit=("%", 0.01, 0),
            group=1,
        )
        super().__init__(task, replay, bounds_of(task, self.moments), gauges)

    def settled(self, step: int) -> Moment:
        """The stance after a step."""
        return self.moments[step]

    def motion(self, step: int) -> list[Part[Moment]]:
        """The body on a straight line; limbs change their holds at its end."""
        before, after = self.moments[step - 1], self.moments[step]

        def at(share: float, way: float) -> Moment:
            pose = before.pose + share * (after.pose - before.pose)
            return after if share >= 1.0 else Moment(pose, before.tips, before.holds, after.shares)

        return [Part("move", at)]

    def action(self, step: int) -> str:
        """What changed in a step."""
        before, after = self.moments[step - 1], self.moments[step]
        for limb, old, new in zip(self.limbs, before.holds, after.holds, strict=True):
            if old != new:
                return f"{limb} to {new}" if new else f"{limb} released"
        return f"body to {pose_words(self.task, after)}"

    def values(self, at: Moment) -> tuple[Floats, ...]:
        """Margins."""
        return (at.shares,)

    def lines(self, step: int, at: Moment) -> tuple[str, ...]:
        """Pose and holds."""
        held = ", ".join(f"{limb} {hold or 'free'}" for limb, hold in zip(self.limbs, at.holds, strict=True))
        return pose_words(self.task, at), held or "none"

    def draw(self, picture: Picture[Moment]) -> "PlainArtists":
        """World and robot."""
        draw_world(picture.wall, self.task, self.bounds)
        return PlainArtists(picture.wall, len(self.limbs))


class PlainArtists:
    """A body as a dot, limbs as lines to their holds."""

    def __init__(self, axes: Axes, limbs: int) -> None:
        self._lines = [
            axes.plot([], [], color=style.PARTS[k % len(style.PARTS)], lw=2.5, zorder=4)[0] for k in range(limbs)
        ]
        self._body = axes.plot([], [], marker="o", ms=9, color=style.INK, ls="", zorder=5)[0]

    @property
    def artists(self) -> list[Artist]:
        """See `Robot`."""
        return [*self._lines, self._body]

    def update(self, at: Moment) -> None:
        """See `Robot`."""
        x, y = at.pose[:2]
        self._body.set_data([x], [y])
        for line, tip in zip(self._lines, at.tips, strict=True):
            line.set_data([x, tip[0]], [y, tip[1]])


def bounds_of(task: Any, moments: list[Moment]) -> Bounds:
    """The part of the world that a plan needs."""
    points = np.array([*(at.pose[:2] for at in moments), *holds_of(task).values()])
    return fit_bounds(points, task.goals)


def draw_world(axes: Axes, task: Any, bounds: Bounds) -> None:
    """Holds by number, and goals."""
    set_axes(axes, task, bounds)
    for k, goal in enumerate(task.goals):
        corners = goal_box(goal, bounds)
        if corners is not None:
            draw_region(axes, corners, last=k == len(task.goals) - 1)
    holds = holds_of(task)
    if holds:
        axes.plot(*zip(*holds.values(), strict=True), marker="o", ms=5, color=style.HOLD, ls="", zorder=2)
    if len(holds) > MOST_NUMBERED:
        return
    for number, place in holds.items():
        axes.annotate(
            str(number),
            place,
            (0, -9),
            textcoords="offset points",
            ha="center",
            fontsize=6.5,
            color=style.QUIET,
        )


def draw_stance(task: Any, stance: np.void, axes: Axes) -> None:
    """One stance in its world."""
    at = moment_of(task, stance, np.zeros(0), holds_of(task))
    draw_world(axes, task, bounds_of(task, [at]))
    PlainArtists(axes, len(at.holds)).update(at)


def draw_route(task: Any, replay: Replay) -> Figure:
    """A whole plan: the way of the body, first and last stance."""
    places = holds_of(task)
    moments = [moment_of(task, stance, np.zeros(0), places) for stance in replay.stances]
    bounds = bounds_of(task, moments)
    layout = Layout(bounds, FACTS_HEIGHT)
    figure, wall, panel, _ = layout.figure(
        whole_title("plan", replay), f"{task.title or task.name}. Line: way of the body"
    )
    draw_world(wall, task, bounds)
    way = np.array([at.pose[:2] for at in moments])
    wall.plot(way[:, 0], way[:, 1], color=style.INK, lw=1.2, zorder=3)
    for at in (moments[0], moments[-1]):
        PlainArtists(wall, len(at.holds)).update(at)
    told = f"{count_actions(task, replay)}\nto {pose_words(task, moments[-1])}"
    panel.text(0.0, layout.panel[1], told, fontsize=8.5, va="top")
    layout.fix_panel(panel)
    return figure


def world_points(task: Any) -> Floats:
    """Holds and the start."""
    plans = family_of(task).plans
    return np.array([plans.pose(task, plans.problem(task).start[0])[:2], *holds_of(task).values()])


class PlainSolid(Solid):
    """A ball for the body, sticks to the holds of its limbs."""

    def __init__(self, server: "viser.ViserServer", name: str, opacity: float, size: float, limbs: int) -> None:
        super().__init__(server, name, opacity)
        self._ball = self.balls("body", [colour(style.INK)], [BODY * size])
        paint = [colour(style.PARTS[k % len(style.PARTS)]) for k in range(limbs)]
        self._sticks = self.sticks("limbs", paint, [0.3 * BODY * size] * limbs) if limbs else None

    def show(self, at: Moment, grade: int = 3) -> None:
        """A moment's body and limbs."""
        centre = np.array((at.pose[0], 0.0, at.pose[1]))
        self.middle = centre
        self._ball.put(centre[None])
        if self._sticks is not None:
            tips = np.column_stack((at.tips[:, 0], np.zeros(len(at.tips)), at.tips[:, 1]))
            self._sticks.put(np.stack((np.broadcast_to(centre, tips.shape), tips), axis=1))


class PlainWorld:
    """Holds as balls."""

    def __init__(self, server: "viser.ViserServer", holds: Floats, radius: float) -> None:
        from .browser.solids import Balls

        paint = np.array([colour(style.HOLD)] * len(holds), np.uint8)
        self._balls = Balls(server, "/holds", paint, np.full(len(holds), radius)) if len(holds) else None
        if self._balls is not None:
            self._balls.put(np.column_stack((holds[:, 0], np.zeros(len(holds)), holds[:, 1])))

    def remove(self) -> None:
        """Take them away."""
        if self._balls is not None:
            self._balls.node.remove()


@dataclass(frozen=True, slots=True)
class PlainScenery(Scenery):
    """World and robot of a task, in the plane y = 0 of the viewer's space."""

    task: Any

    @property
    def size(self) -> float:
        """Larger side of what is shown [m]."""
        return max(self.bounds[1] - self.bounds[0], self.bounds[3] - self.bounds[2])

    def world(self, server: "viser.ViserServer") -> World:
        """Its holds."""
        return PlainWorld(server, np.array(list(holds_of(self.task).values())).reshape(-1, 2), 0.6 * BODY * self.size)

    def figure(self, server: "viser.ViserServer", name: str, opacity: float = 1.0) -> Solid:
        """Its robot."""
        limbs = len(getattr(self.task.robot, "limb_names", ()))
        return PlainSolid(server, name, opacity, self.size, limbs)

    def camera(self) -> Camera:
        """In front of the middle."""
        middle = np.array((self.bounds[0] + self.bounds[1], 0.0, self.bounds[2] + self.bounds[3])) / 2.0
        away = 0.6 * self.size / math.tan(FOV / 2.0)
        return Camera(middle + np.array((0.0, -away, 0.0)), middle)


class PlainScenes(Scenes):
    """The viewer of such a family."""

    def scenery(self, task: Any, bounds: Bounds) -> Scenery:
        """World and robot."""
        return PlainScenery(bounds, task)


PICTURES: Final = Pictures(PlainView, draw_stance, draw_route, world_points, draw_world)
SCENES: Final = PlainScenes()
