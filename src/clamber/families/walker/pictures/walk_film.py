"""Walks as films: before they begin, as planned, and as they truly were."""

import math
from typing import Any, Final

import numpy as np

from ....types import Floats, Json
from ....units import DEGREE, GRAVITY
from ....viewing.recording import MarginRow, Recording, StillFilm
from ..control.gait import lengths_at
from ..control.track import Track, straight
from ..control.walker_balance import mass_centre
from ..execution.true_walk import TrueWalk
from ..execution.walk_scene import plate_axes
from ..execution.walk_trace import WalkTrace
from ..planning import Walk
from ..robot import FRAME_TITLES, WalkerRobot
from ..robot.plane_poses import compose
from ..robot.weight import arm_places, weight_of
from ..trials.run_walk import lay_track
from ..world.ground import Ground, Surface
from .space import WalkMoment
from .walker_loads import WalkLoads, actuator_gauges, leg_force_gauges, leg_gauges, plate_normals
from .walker_motion import WalkerMoment, WalkShapes, shapes_at
from .walker_view import WalkerView

USUAL: Final = 16.0
"""A walk takes many minutes: it is played that much faster than it was [-]."""
SAMPLED: Final = 0.05
"""Between two moments of a plan among which the nearest is looked for [s]."""
ENDED_WELL: Final = ("ok", "moved")
"""Outcomes of steps after which the walk goes on."""
LIFTED: Final = 0.6
"""How high lifted feet are drawn in a plan, which knows no heights, over the clearance that the robot's legs lift to [-]."""


BALANCE: Final = (
    "how far the centre of mass lies inside the standing feet, least of the step; against half the feet's circle"
)


class PlannedWalkFilm(Recording[WalkMoment]):
    """A planned walk: the plan's moments, which know no heights, put onto the ground.

    Args:
        view: Of its replay.
    """

    def __init__(self, view: WalkerView) -> None:
        self._film, self._task = view, view.task
        self._surface = Surface(view.task.world)
        film = self._film
        self.title, self.gauges, self.seconds, self.steps = film.title, (), film.seconds, film.steps
        self.grades, self.starts, self.ends = film.grades, film.starts, film.ends
        robot = self._task.robot
        self._weight = weight_on_ground(robot, self._task.start.payload)
        self.gauges = (leg_force_gauges(robot, self._weight), *film.gauges)
        self._sampled: tuple[Floats, Floats] | None = None

    def at(self, time: float) -> WalkMoment:
        """See `Recording`."""
        return self.on_ground(self._film.at(time))

    def on_ground(self, at: WalkerMoment) -> WalkMoment:
        """A planned moment with heights: the plate is level, as high above the highest foot that stands as its legs usually are."""
        robot, feet = self._task.robot, at.outline.feet
        ground = self._surface.heights(feet)
        ground = np.where(np.isfinite(ground), ground, 0.0)
        lifts = np.array(at.lifts)
        stands = lifts == 0.0
        plate = float(ground[stands].max()) + robot.legs.nominal
        soles = np.concatenate((feet, (ground + LIFTED * robot.legs.lift * lifts[:, None])[..., None]), axis=-1)

        def level(points: Floats) -> Floats:
            return np.concatenate((points, np.full((*points.shape[:-1], 1), plate)), axis=-1)

        delta, star = (level(frame) for frame in at.outline.frames)
        legs = np.stack((level(feet), soles), axis=2)
        centre = np.array((*at.outline.centre_of_mass, plate))
        touching = np.repeat(stands.astype(np.int32)[:, None], 3, axis=1)
        shapes = WalkShapes(
            (delta[[0, 1, 2, 0]], star[[1, 0, 2, 0, 3]]), level(at.outline.actuators), legs, touching, np.full((3, 3), np.nan), centre
        )  # fmt: skip
        forces = np.zeros((2, 3, 3))
        if stands.sum() == 1:  # six feet share the weight in more ways than statics tells
            standing = int(np.argmax(stands))
            forces[standing, :, 2] = loads_at_rest(feet[standing], centre[:2], self._weight)
        told = np.where(stands.sum() == 1, forces[..., 2].ravel(), np.nan)
        return WalkMoment(shapes, forces, self._weight, at.poses, (told, at.lengths))

    def nearest(self, poses: Floats) -> float:
        """When the frames of the plan are nearest to some poses, shape (2, 3) [s]: the sum of squares tells, turns at the feet's circle."""
        if self._sampled is None:
            times = np.arange(0.0, self.seconds + SAMPLED, SAMPLED)
            self._sampled = times, np.array([self._film.at(float(time)).poses for time in times])
        times, there = self._sampled
        off = there - poses
        radius = max(self._task.robot.legs.radius_delta, self._task.robot.legs.radius_y)
        off[..., 2] = 2.0 * radius * np.sin(0.5 * off[..., 2])
        return float(times[np.argmin(np.square(off).sum(axis=(1, 2)))])

    def values(self, at: WalkMoment) -> tuple[Floats, ...]:
        """See `Recording`."""
        return at.loads

    def facts(self, step: int, at: WalkMoment) -> tuple[tuple[str, str], ...]:
        """See `Recording`."""
        words = []
        for name, (x, y, angle), touching in zip(FRAME_TITLES, at.poses.tolist(), at.shapes.touching, strict=True):
            turn = math.remainder(angle, math.tau) / DEGREE
            words.append(
                (
                    name,
                    f"x {100 * x:.1f} cm,  y {100 * y:.1f} cm,  {turn + 0.0:.0f}°  ({'stands' if touching.all() else 'lifted'})",
                )
            )
        return tuple(words)

    def margins(self, step: int) -> list[MarginRow]:
        """See `Recording`."""
        return self._film.margins(step)

    @property
    def worst(self) -> int | None:
        """See `Recording`."""
        return self._film.worst


class WalkFilm(Recording[WalkMoment]):
    """A walk as it truly was, in its own time.

    Args:
        robot: The walker.
        ground: As it truly is.
        trace: What happened.
        report: As the walk's log has it.
        title: Above all.
        payload: That the robot carries [kg].
        margins: How far the centre of mass is inside the standing feet at each row [m]; None: as the trace has it.
        exact: Whether the forces are those of the ground, and not only those along the legs.
    """

    speed = USUAL
    words = ("failed", "near tipping", "fair balance", "ample balance")

    def __init__(
        self,
        robot: WalkerRobot,
        ground: Ground,
        trace: TrueWalk,
        report: Json,
        title: str,
        payload: float = 0.0,
        margins: Floats | None = None,
        exact: bool = True,
    ) -> None:
        self._robot, self._trace, self.title = robot, trace, title
        self._weight = weight_on_ground(robot, payload)
        self._loads = WalkLoads(robot, ground, trace, self._weight, exact=exact)
        self.gauges = self._loads.gauges
        self.seconds = float(trace.time[-1])
        self._steps: list[dict[str, Any]] = list(report.get("steps", ()))
        self.steps = ("start", *(self._say(step) for step in self._steps))
        begins = [float(step["start"]) for step in self._steps]
        self.starts = np.array([0.0, *begins])
        self.ends = np.array([0.0, *begins[1:], self.seconds] if begins else [0.0])
        self._size = 0.5 * min(robot.legs.radius_delta, robot.legs.radius_y)
        self._tilts = trace.tilts
        self._margins = trace.margins if margins is None else margins
        self._least = [self._least_of(k) for k in range(1, len(self.steps))]
        self.grades = (3, *(self._grade(step, least) for step, least in zip(self._steps, self._least, strict=True)))

    @staticmethod
    def _say(step: Json) -> str:
        return f"{step['frame']}-frame to {float(step['way']):.2f} m: {step['outcome']}"

    def _rows_of(self, step: int) -> slice:
        return slice(*np.searchsorted(self._trace.time, (self.starts[step], self.ends[step])).tolist())

    def _least_of(self, step: int) -> float:
        margins = self._margins[self._rows_of(step)]
        known = margins[np.isfinite(margins)]
        return float(known.min()) if known.size else math.nan

    def _grade(self, step: Json, least: float) -> int:
        if step["outcome"] not in ENDED_WELL:
            return 0
        share = least / self._size
        return 3 if math.isnan(share) or share >= 0.3 else 2 if share >= 0.1 else 1

    def at(self, time: float) -> WalkMoment:
        """See `Recording`."""
        trace = self._trace
        k = min(int(np.searchsorted(trace.time, time)), len(trace.time) - 1)
        shapes = shapes_at(self._robot, trace, k)
        pose = trace.pose[k, [0, 1, 3]]
        poses = np.array((pose, compose(pose, trace.place[k])))
        return WalkMoment(
            shapes, trace.forces[k], self._weight, poses, self._loads.at(k), float(trace.time[k]), float(self._tilts[k]),
            float(self._margins[k]),
        )  # fmt: skip

    def planned_time(self, time: float, plan: Recording[WalkMoment]) -> float | None:
        """See `Recording`: where the plan's frames are nearest to those of the run."""
        return plan.nearest(self.at(time).poses) if isinstance(plan, PlannedWalkFilm) else None

    def values(self, at: WalkMoment) -> tuple[Floats, ...]:
        """See `Recording`."""
        return at.loads

    def facts(self, step: int, at: WalkMoment) -> tuple[tuple[str, str], ...]:
        """See `Recording`."""
        x, y, alpha = at.poses[0]
        balance = f"{1e3 * at.margin:.0f} mm inside the standing feet" if math.isfinite(at.margin) else "not told"
        told = [
            ("Time", f"{at.time:.0f} s"),
            (
                "Plate",
                f"x {_even(x, 3)} m,  y {_even(y, 3)} m,  {_even(alpha / DEGREE, 1)}°,  tilted {at.tilt / DEGREE:.2f}°",
            ),
            ("Balance", balance),
        ]
        if step:
            about = self._steps[step - 1]
            off = about.get("off")
            words = about["outcome"] + (
                f", {1e3 * off:.1f} mm off its aim" if isinstance(off, float) and math.isfinite(off) else ""
            )
            told.append(("Outcome", words))
            if about.get("reason"):
                told.append(("Why", str(about["reason"])))
        return tuple(told)

    def margins(self, step: int) -> list[MarginRow]:
        """See `Recording`: the least of a step."""
        if step == 0:
            return []
        rows, least = self._rows_of(step), self._least[step - 1]
        told = (
            []
            if math.isnan(least)
            else [MarginRow("balance", f"{1e3 * least:+.0f} mm", least / self._size, True, True, BALANCE)]
        )
        left = self._loads.left(rows)
        return [*told, *(MarginRow(one.name, one.value, one.share, False, False, one.meaning) for one in left)]

    @property
    def worst(self) -> int | None:
        """See `Recording`."""
        known = [k for k, least in enumerate(self._least) if not math.isnan(least)]
        return 1 + min(known, key=lambda k: self._least[k]) if known else None


def loads_at_rest(feet: Floats, centre: Floats, weight: float) -> Floats:
    """What the ground carries at each of three feet while a robot rests on them, upwards, shape (3,) [N].

    Force and moment balance of a weight over three points: barycentric coordinates. Zero where the centre is not between the feet.

    Args:
        feet: Seen from above, shape (3, 2) [m].
        centre: Of mass, likewise, shape (2,) [m].
        weight: Of the robot [N].
    """
    loads = weight * np.linalg.solve(np.vstack((np.ones(3), feet.T)), np.array((1.0, *centre)))
    return loads if loads.min() >= 0.0 else np.zeros(3)


def _even(value: float, decimals: int) -> str:
    """A number with so many decimals, and no minus before a zero."""
    return f"{round(value, decimals) + 0.0:.{decimals}f}"


def weight_on_ground(robot: WalkerRobot, payload: float) -> float:
    """Of a robot with its load [N]."""
    return GRAVITY * weight_of(robot, payload=payload).total


def logged_walk(trace: WalkTrace) -> TrueWalk:
    """What a walk's log tells of the truth; where it tells none, what the robot believed, and forces along the legs alone."""
    rows = len(trace.time)
    nothing = np.full((rows, 3), np.nan)

    def told(values: Floats | None, otherwise: Floats) -> Floats:
        return otherwise if values is None else values

    pose = told(trace.true_pose, trace.believed)
    along = (trace.forces * (trace.stands > 0))[..., None] * plate_normals(pose)[:, None]
    return TrueWalk(
        time=trace.time, pose=pose, place=told(trace.true_place, trace.place),
        feet=told(trace.true_feet, np.full((rows, 6, 3), np.nan)).reshape(rows, 2, 3, 3),
        forces=told(trace.true_forces, along).reshape(rows, 2, 3, 3), centre=told(trace.true_centre, nothing),
        tool=told(trace.true_tool, nothing), thrusts=told(trace.thrusts, nothing), inclines=trace.inclines,
    )  # fmt: skip


def standing_film(walk: Walk) -> StillFilm[WalkMoment]:
    """The start of a walk, which has no plan."""
    robot, start = walk.robot, walk.start
    legs, place = walk.start_legs().ravel(), walk.start_place()
    loads = legs, lengths_at(robot, place[None])[0]
    at = WalkMoment(
        shapes_at(robot, standing(walk), 0), np.zeros((2, 3, 3)), weight_on_ground(robot, walk.payload),
        np.array([(start.x, start.y, start.heading)] * 2), loads,
    )  # fmt: skip
    facts = (
        ("Plate", f"x {start.x + 0.0:.3f} m,  y {start.y + 0.0:.3f} m,  {start.heading / DEGREE + 0.0:.1f}°"),
        ("Plan", "none is needed: a walk goes its way step by step; press Run"),
    )
    bars = tuple(zip((leg_gauges(robot), actuator_gauges(robot)), loads, strict=True))
    return StillFilm(at, "start", facts, walk.title or walk.name, bars)


def standing(walk: Walk) -> TrueWalk:
    """A walk's robot on six feet where it starts, in one row; who carries what, statics does not tell: those forces are NaN."""
    robot, place, legs = walk.robot, walk.start_place(), walk.start_legs().ravel()
    pose = walk.start_pose()
    axes = plate_axes(*pose[3:])
    down = robot.feet_in_plate(place).reshape(6, 2) @ axes[:, :2].T - legs[:, None] * axes[:, 2]
    heights = walk.ground.heights(pose[:2] + down[:, :2])
    pose[2] = float((heights - down[:, 2]).max())
    arm: Any = np.array(walk.arm)
    tool = np.full(3, np.nan) if robot.arm is None else pose[:3] + axes @ arm_places(robot.arm, arm)[-1]
    nothing = np.full((1, 2, 3, 3), np.nan)
    return TrueWalk(
        time=np.zeros(1), pose=pose[None], place=place[None], feet=(pose[:3] + down).reshape(1, 2, 3, 3), forces=nothing,
        centre=mass_centre(robot, pose, place, arm, walk.payload)[None], tool=tool[None], thrusts=np.full((1, 3), np.nan),
        inclines=np.zeros((1, 2)),
    )  # fmt: skip


BEYOND: Final = 0.5
"""So far behind a ditch both frames have crossed it, for a picture [m]."""
PLACES: Final = 60
"""Along a way that is drawn."""


def way_poses(walk: Walk) -> Floats:
    """Poses of the Delta-frame along a walk's way: x, y [m], heading [rad], shape (n, 3).

    Raises:
        ClamberError: If there is no way to one of its places.
    """
    start = walk.start
    track = _track(walk, np.array((start.x, start.y, start.heading)))
    return np.array([track.pose(way) for way in np.linspace(0.0, track.length, PLACES)])


def _track(walk: Walk, pose: Floats) -> Track:
    first = walk.way[0]
    if first.ditch is None or first.ahead is None:
        return lay_track(walk, pose)
    whole = first.ahead + first.ditch + BEYOND
    return straight(pose, first.along or 0.0, whole, walk.robot.legs.radius_delta)
