"""The gait of two frames that take turns: which way the lifted frame goes, how far it can, how long a cycle takes.

Poses are planar, x, y [m] and heading [rad] of a frame in the world, shape (3,). The frames follow one track; where both are at the same
point of it, the Y-frame is at its neutral angle in the Delta-frame. So on a track of constant twist the mechanism's posture depends only
on how far one is ahead of the other, and a step goes from as far behind as the mechanism allows to as far ahead.
"""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from ....types import Floats
from ..robot import WalkerRobot
from ..robot.plane_poses import compose, seen_from
from .track import Track
from .walker_balance import mass_moment

DELTA: Final = 0
Y: Final = 1
"""Frames, in the order of arrays."""
SAMPLES: Final = 24
"""Places where a slide is looked at."""
FINE: Final = 0.001
"""To which the end of a step is found, along the track [m]."""


@dataclass(frozen=True, slots=True)
class Limits:
    """How far a step may use what the robot can."""

    guard: float = 0.8
    """The origins stay closer than this share of the distance at which the mechanism is singular [-]: at 0.9 a load turns it by 2 deg."""
    reserve: float = 0.002
    """What is left of the actuators' stroke at either end [m]."""
    balance: float = 0.02
    """Least distance of the centre of mass from the edges of the standing feet [m]."""


def lengths_at(robot: WalkerRobot, places: Floats) -> Floats:
    """Lengths of the actuators with the Y-frame at places in the Delta-frame, shape (n, 3) [m], [rad]; shape (n, 3) [m]."""
    on_delta, on_y = robot.attachments()
    c, s = np.cos(places[:, 2, None]), np.sin(places[:, 2, None])
    across = places[:, 0, None] + c * on_y[:, 0] - s * on_y[:, 1] - on_delta[:, 0]
    up = places[:, 1, None] + s * on_y[:, 0] + c * on_y[:, 1] - on_delta[:, 1]
    lengths: Floats = np.hypot(across, up)
    return lengths


def room_at(robot: WalkerRobot, places: Floats, limits: Limits) -> Floats:
    """How far inside the actuators' strokes and the guard against singular postures places of the Y-frame are, shape (n,) [m]."""
    mechanism, lengths = robot.mechanism, lengths_at(robot, places)
    stroke = np.minimum(lengths - mechanism.shortest, mechanism.longest - lengths).min(axis=1) - limits.reserve
    rho = np.array([mechanism.singular_distance(float(theta)) for theta in places[:, 2]])
    room: Floats = np.minimum(stroke, min(limits.guard, mechanism.guard) * rho - np.hypot(places[:, 0], places[:, 1]))
    return room


def slide_places(stands: Floats, start: Floats, end: Floats, swing: int, shares: Floats) -> Floats:
    """Places of the Y-frame in the Delta-frame while one frame slides straight from pose to pose over the other, shape (n, 3)."""
    moving = start + shares[:, None] * (end - start)
    still = np.broadcast_to(stands, moving.shape)
    return seen_from(still, moving) if swing == Y else seen_from(moving, still)


def slide_balance(robot: WalkerRobot, places: Floats, swing: int, arm: Floats, payload: float = 0.0) -> Floats:
    """How far the centre of mass of a level robot lies inside the feet that stand, shape (n,) [m]; places as of `slide_places`."""
    feet = robot.feet()[1 - swing]
    centres = mass_moment(robot, places, arm, payload)[1]
    if swing == DELTA:
        centres[:, 2] = 0.0
        centres = seen_from(places, centres)
    margins: Floats = np.min([_inside(feet[i], feet[(i + 1) % 3], centres) for i in range(3)], axis=0)
    return margins


def _inside(a: Floats, b: Floats, points: Floats) -> Floats:
    """Of points, shape (n, 2 or more), left of the line from a to b, shape (n,) [m]."""
    x, y = b[:2] - a[:2]
    inside: Floats = (x * (points[:, 1] - a[1]) - y * (points[:, 0] - a[0])) / math.hypot(x, y)
    return inside


@dataclass(frozen=True, slots=True, eq=False)
class Step:
    """A frame's way through the air."""

    swing: int
    """The frame that is lifted."""
    way: float
    """Where on the track it comes down [m]."""
    end: Floats
    """The frame's pose, shape (3,)."""
    room: float
    """Least room of the mechanism on the way [m]."""
    balance: float
    """Least support margin on the way, level ground taken for granted [m]."""
    over: tuple[Floats, ...] = ()
    """Poses that it passes on the way, each of shape (3,); none: it goes straight."""


def target_of(track: Track, way: float, swing: int, neutral: float) -> Floats:
    """Pose of a frame at a place of the track, shape (3,); the Y-frame is turned by `neutral` [rad]."""
    pose = track.pose(way)
    return compose(pose, np.array((0.0, 0.0, neutral))) if swing == Y else pose


def look_at_step(
    robot: WalkerRobot, poses: Floats, swing: int, way: float, end: Floats, arm: Floats, payload: float, limits: Limits
) -> Step:
    """A frame's step to a pose, with its least room and balance.

    Args:
        robot: The walker.
        poses: Of both frames, shape (2, 3).
        swing: The frame that is lifted.
        way: Of the track where it comes down [m]; kept as it is.
        end: Its pose there, shape (3,).
        arm: Joint angles [rad].
        payload: At the tool point [kg].
        limits: What is left free.
    """
    end = end.copy()
    end[2] = poses[swing, 2] + math.remainder(end[2] - poses[swing, 2], math.tau)
    places = slide_places(poses[1 - swing], poses[swing], end, swing, np.linspace(0.0, 1.0, SAMPLES))
    room = float(room_at(robot, places, limits).min())
    some = [*range(0, SAMPLES, SAMPLES // 8), -1]
    balance = float(slide_balance(robot, places[some], swing, arm, payload).min())
    return Step(swing, way, end, room, balance)


def farthest_step(
    robot: WalkerRobot, track: Track, poses: Floats, ways: Floats, swing: int, *,
    neutral: float, arm: Floats, payload: float = 0.0, limits: Limits = Limits(), longest: float = math.inf,
) -> Step | None:  # fmt: skip
    """The longest step of a frame along the track that the mechanism and the balance allow; None where it cannot go on.

    Args:
        robot: The walker.
        track: Where it goes.
        poses: Of both frames as they are, shape (2, 3).
        ways: Where on the track they are, shape (2,) [m].
        swing: The frame to be lifted.
        neutral: Angle of the Y-frame in the Delta-frame where both are at one place of the track [rad].
        arm: Joint angles [rad].
        payload: At the tool point [kg].
        limits: What is left free.
        longest: A step goes no farther than this along the track [m].
    """
    # dead reckoning may put a robot that stands at the end of its room a little beyond: it can still come back
    start_place = slide_places(poses[1 - swing], poses[swing], poses[swing], swing, np.zeros(1))
    least = max(-limits.reserve, min(0.0, float(room_at(robot, start_place, limits)[0]) - 1e-9))

    def look(way: float) -> Step | None:
        step = look_at_step(robot, poses, swing, way, target_of(track, way, swing, neutral), arm, payload, limits)
        return step if step.room >= least and step.balance >= limits.balance else None

    start, last = float(ways[swing]), min(track.length, float(ways[swing]) + longest)
    best, coarse = None, 0.01
    low = start
    while low < last:
        high = min(last, low + coarse)
        step = look(high)
        if step is None:
            break
        best, low = step, high
    else:
        return best
    high = min(last, low + coarse)
    while high - low > FINE:
        middle = 0.5 * (low + high)
        step = look(middle)
        if step is None:
            high = middle
        else:
            best, low = step, middle
    return best if best is not None and best.way - start > FINE else None


def up_to_corner(track: Track, ways: Floats, swing: int) -> float:
    """How far a frame may go on before both are past the end of the piece that the other one is on [m].

    Beyond a corner the track is another twist: a frame that goes there alone may leave the other no way to follow.

    Args:
        track: Where the robot goes.
        ways: Where on the track the frames are, shape (2,) [m].
        swing: The frame to be lifted.
    """
    ahead = track.ways[track.ways > float(ways.min()) + FINE]
    corner = float(ahead[0]) if len(ahead) else track.length
    return corner - float(ways[swing])


def slide_seconds(robot: WalkerRobot, places: Floats, ramp: float) -> float:
    """Least time of a slide that begins and ends with a ramp, its fastest actuator at its speed at the worst place [s].

    Args:
        robot: The walker.
        places: Of the Y-frame at even shares of the slide, shape (n, 3).
        ramp: Time of each ramp [s].
    """
    if len(places) < 2:
        return 0.0
    steepest = float(np.abs(np.diff(lengths_at(robot, places), axis=0)).max()) * (len(places) - 1)
    return steepest / robot.mechanism.speed + ramp if steepest > 0.0 else 0.0


def eased_share(time: float, seconds: float, ramp: float) -> float:
    """Share of a way done at a time, from rest to rest, the speed growing and falling smoothly within `ramp` [s]."""
    ramp = min(ramp, 0.5 * seconds)
    if ramp <= 0.0:
        return min(1.0, max(0.0, time / seconds)) if seconds > 0.0 else 1.0
    left = seconds - time
    u = min(1.0, max(0.0, min(time, left) / ramp))
    way = ramp * u**3 * (1.0 - 0.5 * u) + max(0.0, min(time, left) - ramp)
    whole = seconds - ramp
    share = way / whole if time < left else 1.0 - way / whole
    return min(1.0, max(0.0, share))


@dataclass(frozen=True, slots=True)
class PhaseTimes:
    """Times of one frame's turn to be lifted [s]; a cycle is two of them."""

    lift: float
    slide: float
    lower: float
    settle: float

    @property
    def whole(self) -> float:
        """[s]."""
        return self.lift + self.slide + self.lower + self.settle

    @property
    def duty(self) -> float:
        """Share of the cycle for which a foot is on the ground [-]: 0.5 if nothing but the other frame's swing took time."""
        return 1.0 - (self.lift + self.slide + self.lower) / (2.0 * self.whole)
