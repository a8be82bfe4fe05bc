"""The quickest way of a walker to a place: straight, in whatever direction that is, or after a pivot to where its steps are long."""

import math
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from ....types import Floats
from ..control.gait import SAMPLES, slide_places, slide_seconds, target_of
from ..control.track import Track
from ..robot.plane_poses import seen_from
from .footstep_plan import ImaginedWalker, TrackCourse

PIVOTS: Final = tuple(math.radians(angle) for angle in range(-30, 31, 5))
"""Pivots before the walk that are looked at [rad]: the lengths of steps repeat every 60 deg."""


@dataclass(frozen=True, slots=True, eq=False)
class FastestRoute:
    """A way to a place."""

    pivot: float
    """First turn on the spot [rad]."""
    twists: tuple[Floats, ...]
    """Its pieces, as of `Track.of`."""
    seconds: float
    """That it takes by the robot's speeds; infinite where it cannot be walked [s]."""


def quickest_way(walker: ImaginedWalker, place: Floats, heading: float | None) -> tuple[FastestRoute, ...]:
    """Ways to a place, the quickest first: straight with the heading kept, and after each of `PIVOTS`.

    Args:
        walker: Where it begins, both frames at one place of the way.
        place: To which it goes, shape (2,) [m].
        heading: At the end [rad]; None: any.
    """
    ways, pose, radius = [], walker.placed[0], walker.robot.legs.radius_delta
    for pivot in PIVOTS:
        turned = np.array((pose[0], pose[1], pose[2] + pivot))
        ahead = seen_from(turned, np.array((place[0], place[1], 0.0)))
        twists = [np.array((0.0, 0.0, pivot)), np.array((ahead[0], ahead[1], 0.0))]
        if heading is not None:
            twists.append(np.array((0.0, 0.0, math.remainder(heading - turned[2], math.tau))))
        pieces = tuple(twist for twist in twists if np.any(np.abs(twist) > 1e-12))
        ways.append(
            FastestRoute(pivot, pieces, walk_seconds(walker, Track.of(pose, pieces, radius)) if pieces else 0.0)
        )
    return tuple(sorted(ways, key=lambda way: (way.seconds, abs(way.pivot))))


def walk_seconds(walker: ImaginedWalker, track: Track) -> float:
    """Time of a walk along a track by the robot's speeds, both frames at its start; infinite where it gets stuck [s]."""
    if track.length <= 0.0:
        return 0.0
    legs, settings, neutral = walker.robot.legs, walker.settings, float(walker.placed[1, 2] - walker.placed[0, 2])
    swap = 2.0 * legs.lift / legs.speed + settings.settling  # feet up, down, and the robot at rest on all of them
    walker = replace(walker, placed=np.stack([target_of(track, 0.0, swing, neutral) for swing in (0, 1)]))
    course, total = TrackCourse(track, neutral=neutral), 0.0
    for step in walker.steps(course):
        stands, lifted = walker.placed[1 - step.swing], walker.placed[step.swing]
        places = slide_places(stands, lifted, step.end, step.swing, np.linspace(0.0, 1.0, SAMPLES))
        total += swap + slide_seconds(walker.robot, places, settings.ramp)
    return total if course.done else math.inf
