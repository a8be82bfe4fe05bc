"""A plan of a robot in space as a picture that can be set to any of its moments."""

import math
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon

from ....planning.problem.problem import Replay
from ....planning.problem.problems import NOTHING_LIMITS, normalisation_of
from ....types import Floats
from ....units import DEGREE
from ....viewing import style
from ....viewing.panel import Gauges
from ....viewing.recording import Part, PlanView
from ....viewing.scene import Bounds, length_unit
from ....viewing.view import Picture
from ..planning.swing_loads import SwingLoads
from ..planning.task import SpatialTask
from ..world.patterns import frame_at
from .camera import Camera, stretch
from .moments import SWINGING, Between, Moment, settled_moments
from .robot_artists import RobotArtists, arrows, force_scale, limb_colour
from .surfaces import round_length
from .world_artists import HOLDS, draw_world, picture_bounds

ROOM: Final = 1.3
"""Holds that are farther from the robot's way than this many lengths of its longest limb are outside the picture [-]."""
WAY_POINTS: Final = 40
"""Places of the guide that are looked at for that."""
MOST_TORQUES: Final = 30
"""Robots with more joints show the most loaded one of each limb alone."""
NEAR_LIMIT: Final = 0.9
"""Share of a torque limit beyond which a bar turns red [-]."""


class SpatialView(PlanView[Moment]):
    """A plan of a robot in space.

    Args:
        task: What it is a plan for.
        replay: Of the plan.
        camera: From where it is seen.
    """

    rows = ("Pose on the guide", "Holds")

    def __init__(self, task: SpatialTask, replay: Replay, camera: Camera) -> None:
        self.camera, self.names = camera, task.robot.chains.limb_names
        sticks = normalisation_of(task)
        limited = (
            np.abs(np.nan_to_num(replay.margins, nan=NOTHING_LIMITS)).min(axis=0, initial=NOTHING_LIMITS)
            < NOTHING_LIMITS
        )
        known = limited | (len(replay.margins) == 0)
        checks = [k for k, check in enumerate(sticks.checks) if sticks.sizes.get(check.name, 0.0) > 0.0 and known[k]]
        sizes = np.array([sticks.sizes[sticks.checks[k].name] for k in checks])
        left = replay.margins[:, checks] / sizes
        shares = np.vstack([np.full((1, len(sizes)), math.nan), np.minimum(left, 1.0)])
        self.moments = settled_moments(task, replay.stances, shares)
        self.shown = shown_places(task, self.moments)
        names = tuple(sticks.checks[k].name.replace("_", "-") for k in checks)
        self._loads = SwingLoads(task)
        super().__init__(task, replay, picture_bounds(camera, self.shown), share_gauges(names))
        self.gauges = (*self.gauges, force_gauges(task), torque_gauges(task))

    def settled(self, step: int) -> Moment:
        """See `View`."""
        return self.moments[step]

    def motion(self, step: int) -> list[Part[Moment]]:
        """See `View`."""
        stance = self.replay.stances[step - 1]
        before, after = self.moments[step - 1], self.moments[step]
        return Between(self.task, before, after, lambda limb: self._loads.wrenches(stance, limb)).parts()

    def values(self, at: Moment) -> tuple[Floats, ...]:
        """Shares of limits, sizes of contact forces [N], torques as shares of their limits."""
        forces = np.linalg.norm(at.wrenches[:, :3], axis=1)
        forces[[limb for limb, hold in enumerate(at.holds) if hold == SWINGING]] = 0.0
        return at.shares, forces, used_torques(self.task, at.torques)

    def action(self, step: int) -> str:
        """What changes in a step."""
        before, after = self.moments[step - 1], self.moments[step]
        words = describe_change(self.task, before, after)
        reason = int(self.replay.reasons[step - 1])
        return words if reason < 0 else f"{words}, violates {self.normalisation.checks[reason].name.replace('_', '-')}"

    def lines(self, step: int, at: Moment) -> tuple[str, ...]:
        """Pose and holds."""
        return describe_pose(self.task, at.pose), describe_holds(self.names, at.holds)

    def draw(self, picture: Picture[Moment]) -> RobotArtists:
        """World and robot."""
        return draw_film(picture, self.task, self.camera, self.shown)


def draw_film(picture: Picture[Moment], task: SpatialTask, camera: Camera, shown: Floats) -> RobotArtists:
    """The world of a film on its picture, what marks mean, and the robot's artists."""
    bounds = picture.view.bounds
    draw_world(picture.wall, task, camera, shown, bounds)
    draw_key(picture.panel, picture.key.left, picture.key.top, task, 1.0 / picture.layout.scale)
    return RobotArtists(picture.wall, task, camera, bounds)


def shown_places(task: SpatialTask, moments: list[Moment]) -> Floats:
    """Places that are to be seen: the robot in all stances, and what `way_places` gives [m], shape (n, 3)."""
    return np.vstack([way_places(task, *(float(at.pose[0]) for at in moments)), robot_corners(task, moments)])


def robot_corners(task: SpatialTask, moments: list[Moment]) -> Floats:
    """Joints and tips of a robot, and its base's corners, at some moments [m], shape (n, 3)."""
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * task.robot.chains.base_half
    return np.vstack(
        [np.vstack((at.origins.reshape(-1, 3), at.body.place + corners @ at.body.turn.T)) for at in moments]
    )


def way_places(task: SpatialTask, *alongs: float) -> Floats:
    """The guide from the start on to the goals and to other places along it [m], and the holds near that, shape (n, 3) [m]."""
    first, last = stretch(task)
    ends = min((first, *alongs)), max((last, *alongs))
    way = np.array([frame_at(task.world.frames, along) for along in np.linspace(*ends, WAY_POINTS)])
    body = way[:, :3] + task.start.height * way[:, 9:]
    places = task.world.places
    near = (
        np.array([np.linalg.norm(way[:, :3] - place, axis=1).min() for place in places])
        < ROOM * task.robot.chains.longest_limb
    )
    return np.vstack([places[near], way[:, :3], body])


def share_gauges(names: tuple[str, ...]) -> Gauges:
    """One bar per check: how much of its limit is left."""
    return Gauges(
        title="Share of each limit that is left",
        names=names,
        colours=(style.STRIP[3],) * len(names),
        low=np.zeros(len(names)),
        high=np.ones(len(names)),
        limits=(),
        calm=(0.0, math.inf),
        unit=("%", 0.01, 0),
        group=1,
    )


def force_gauges(task: SpatialTask) -> Gauges:
    """One bar per limb: size of its contact force, up to the robot's weight [N]."""
    names = task.robot.chains.limb_names
    weight = task.robot.chains.total_mass * float(np.linalg.norm(task.world.gravity)) or 1.0
    return Gauges(
        title="Contact forces",
        names=names,
        colours=tuple(map(limb_colour, range(len(names)))),
        low=np.zeros(len(names)),
        high=np.full(len(names), weight),
        limits=(),
        calm=(0.0, math.inf),
        unit=("N", 1.0, 1 if weight < 100.0 else 0),
        group=1,
        note="full bar: the robot's weight",
    )


def torque_gauges(task: SpatialTask) -> Gauges:
    """One bar per joint, or per limb where there are too many: torque as a share of the motor's limit."""
    chains = task.robot.chains
    most = int(chains.n_joints.sum()) > MOST_TORQUES
    names, colours = [], []
    for limb, (name, joints) in enumerate(zip(chains.limb_names, chains.joint_names, strict=True)):
        words = [name] if most else [f"{name} {k + 1}" for k in range(len(joints))]
        names += words
        colours += [limb_colour(limb)] * len(words)
    return Gauges(
        title="Joint torques, of their limits",
        names=tuple(names),
        colours=tuple(colours),
        low=np.zeros(len(names)),
        high=np.ones(len(names)),
        limits=((1.0, "limit"),),
        calm=(0.0, NEAR_LIMIT),
        unit=("%", 0.01, 0),
        group=1 if most else int(chains.n_joints.max()),
        note="the largest of each limb" if most else "",
    )


def used_torques(task: SpatialTask, torques: Floats) -> Floats:
    """Torques as shares of their limits, a value for each bar of `torque_gauges`."""
    chains = task.robot.chains
    used = chains.used
    shares = np.where(used, np.abs(torques) / np.where(used, chains.torque, 1.0), 0.0)
    if int(chains.n_joints.sum()) > MOST_TORQUES:
        largest: Floats = shares.max(axis=1)
        return largest
    return shares[used]


def describe_pose(task: SpatialTask, pose: Floats) -> str:
    """A pose on the guide in words."""
    unit, size = length_unit(task)
    along, across, height = (round(part / size, 1) + 0.0 for part in pose[:3].tolist())
    yaw, pitch, roll = (round(math.remainder(part, math.tau) / DEGREE) for part in pose[3:].tolist())
    words = f"along {along:.1f}, across {across:.1f}, height {height:.1f} {unit}, yaw {yaw}"
    return words + (f", pitch {pitch}, roll {roll}°" if task.step.tilt else "°")


def describe_holds(names: tuple[str, ...], holds: tuple[int, ...]) -> str:
    """Limbs and the numbers of their holds."""
    words = (f"{name} {'swings' if hold == SWINGING else hold + 1}" for name, hold in zip(names, holds, strict=True))
    return ", ".join(words)


def describe_change(task: SpatialTask, before: Moment, after: Moment) -> str:
    """The action between two stances, in a few words."""
    for name, old, new in zip(task.robot.chains.limb_names, before.holds, after.holds, strict=True):
        if old != new:
            return f"{name} to hold {new + 1}"
    unit, size = length_unit(task)
    change = after.pose - before.pose
    words = [
        f"{part / size:+.1f} {unit} {axis}"
        for axis, part in zip(("along", "across", "in height"), change[:3], strict=True)
        if abs(part) > 1e-9
    ]
    angles = [math.remainder(float(part), math.tau) / DEGREE for part in change[3:]]
    words += [
        f"{part:+.0f}° of {axis}"
        for axis, part in zip(("yaw", "pitch", "roll"), angles, strict=True)
        if abs(part) > 1e-6
    ]
    return f"body {', '.join(words)}".replace("-", "−") if words else "stays"


def draw_key(panel: Axes, left: float, y: float, task: SpatialTask, metres: float) -> None:
    """Say in the panel, in inches, what the marks mean, with an arrow as long as a round force is drawn.

    Args:
        panel: Its axes.
        left, y: Where [in].
        task: Says the scale of forces.
        metres: Length of an inch of the picture [m].
    """
    quiet = style.QUIET
    for x, marker, face, edge, words in (
        (0.0, "o", HOLDS, style.HOLD, "hold"),
        (0.62, "o", "#CFE0EE", style.PARTS[0], "held"),
        (1.24, "o", style.PAPER, style.INK, "centre of mass"),
    ):
        panel.plot([left + x + 0.06], [y], marker=marker, ms=6.5, mfc=face, mec=edge, mew=1.2, ls="", clip_on=False)
        panel.text(left + x + 0.17, y, words, fontsize=7, va="center", color=quiet)
    per_newton = force_scale(task) / metres
    force = round_length(0.3 / per_newton)
    length = force * per_newton
    outline = arrows(np.array([(left + 2.42, y)]), np.array([(length, 0.0)]), 0.018)[0]
    panel.add_patch(Polygon(outline, fc=style.FORCE, lw=0, clip_on=False))
    panel.text(left + 2.42 + length + 0.08, y, f"{force:g} N", fontsize=7, va="center", color=quiet)


def stance_bounds(task: SpatialTask, camera: Camera, moments: list[Moment]) -> tuple[Floats, Bounds]:
    """Places that a picture shows, and its bounds."""
    shown = shown_places(task, moments)
    return shown, picture_bounds(camera, shown)
