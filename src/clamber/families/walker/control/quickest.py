"""The quickest way of a walker to a place: straight, in whatever direction that is, or after a pivot to where its steps are long."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from ....types import Floats
from ..robot import WalkerRobot
from ..robot.plane_poses import seen_from
from .gait import FINE, SAMPLES, Limits, farthest_step, slide_places, slide_seconds, target_of, up_to_corner
from .track import Track

PIVOTS: Final = tuple(math.radians(angle) for angle in range(-30, 31, 5))
"""Pivots before the walk that are looked at [rad]: the lengths of steps repeat every 60 deg."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Gait:
    """What the time of a walk depends on, beside the robot and its way."""

    neutral: float
    """Angle of the Y-frame in the Delta-frame where both are at one place of the track [rad]."""
    arm: Floats
    """Joint angles [rad]."""
    payload: float
    """At the tool point [kg]."""
    limits: Limits
    """What steps leave free."""
    ramp: float
    """In which a slide comes to its speed [s]."""
    swap: float
    """Time that a step takes beside its slide: feet up, down, and the robot at rest on all of them [s]."""


@dataclass(frozen=True, slots=True, eq=False)
class FastestRoute:
    """A way to a place."""

    pivot: float
    """First turn on the spot [rad]."""
    twists: tuple[Floats, ...]
    """Its pieces, as of `Track.of`."""
    seconds: float
    """That it takes by the robot's speeds; infinite where it cannot be walked [s]."""


def quickest_way(
    robot: WalkerRobot, pose: Floats, place: Floats, heading: float | None, gait: Gait
) -> tuple[FastestRoute, ...]:
    """Ways to a place, the quickest first: straight with the heading kept, and after each of `PIVOTS`.

    Args:
        robot: The walker.
        pose: Of the Delta-frame: x, y [m], heading [rad], shape (3,).
        place: To which it goes, shape (2,) [m].
        heading: At the end [rad]; None: any.
        gait: How it walks.
    """
    ways = []
    for pivot in PIVOTS:
        turned = np.array((pose[0], pose[1], pose[2] + pivot))
        ahead = seen_from(turned, np.array((place[0], place[1], 0.0)))
        twists = [np.array((0.0, 0.0, pivot)), np.array((ahead[0], ahead[1], 0.0))]
        if heading is not None:
            twists.append(np.array((0.0, 0.0, math.remainder(heading - turned[2], math.tau))))
        pieces = tuple(twist for twist in twists if np.any(np.abs(twist) > 1e-12))
        radius = robot.legs.radius_delta
        ways.append(
            FastestRoute(pivot, pieces, walk_seconds(robot, Track.of(pose, pieces, radius), gait) if pieces else 0.0)
        )
    return tuple(sorted(ways, key=lambda way: (way.seconds, abs(way.pivot))))


def walk_seconds(robot: WalkerRobot, track: Track, gait: Gait) -> float:
    """Time of a walk along a track by the robot's speeds, both frames at its start; infinite where it gets stuck [s].

    The frames take turns, the one that gets farther first, each as far as mechanism and balance allow.
    """
    if track.length <= 0.0:
        return 0.0
    ways, total = np.zeros(2), 0.0
    poses = np.stack([target_of(track, 0.0, swing, gait.neutral) for swing in (0, 1)])

    def farthest(swing: int) -> float:
        room = up_to_corner(track, ways, swing)
        if room < FINE:
            return 0.0
        step = farthest_step(
            robot, track, poses, ways, swing, neutral=gait.neutral, arm=gait.arm, payload=gait.payload,
            limits=gait.limits, longest=room,
        )  # fmt: skip
        return 0.0 if step is None else step.way

    swing = int(np.argmax([farthest(0), farthest(1)]))
    while ways.min() < track.length - FINE:
        way = farthest(swing)
        if way == 0.0:
            swing = 1 - swing
            way = farthest(swing)
        if way - ways[swing] < FINE:
            return math.inf
        end = target_of(track, way, swing, gait.neutral)
        places = slide_places(poses[1 - swing], poses[swing], end, swing, np.linspace(0.0, 1.0, SAMPLES))
        total += gait.swap + slide_seconds(robot, places, gait.ramp)
        poses[swing], ways[swing] = end, way
        swing = 1 - swing
    return total
