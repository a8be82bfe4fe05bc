"""Footholds away from edges on unknown ground: a frame's feet touch the corners of a small triangle before they stand in its middle.

A leg has one freedom and feels only along itself, so an edge is found by its two sides: touches of one foot whose heights differ have one
between them. Where a triangle's three touches are even, no straight edge comes nearer to its middle than half its radius, but for edges
that it could not feel because both sides are as high. All three feet are probed at once; one that finds an edge moves them all, to where
what was touched so far says least against.
"""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from ...control.gait import look_at_step, room_at
from ...types import Floats
from . import motions
from .walker import Walker, leg_name

CORNERS: Final = np.radians((90.0, 210.0, 330.0))
"""Directions of the triangle's corners from its middle [rad]."""
SEARCHED: Final = 0.06
"""How far from where it was to stand a frame looks for a foothold [m]."""
GRID: Final = 0.006
"""Distance of the places that are looked at [m]."""
TOLD: Final = 0.6
"""A touch nearer to a corner than this share of the triangle's radius tells of it already [-]."""
HOLE: Final = -1e3
"""Height of what no foot reaches [m]."""
FAR: Final = 0.3
"""What a metre from where it was to stand costs, in metres from an edge [-]."""


@dataclass(frozen=True, slots=True)
class Footing:
    """What became of a search."""

    without: tuple[int, ...]
    """Legs that found no ground at the last."""
    touches: int
    """How often the frame was lowered."""
    moved: float
    """How far from where it was to stand the frame stands [m]."""
    even: bool
    """Whether all touches about each foot were even."""
    reason: str = ""
    """Why it moved, or is not even."""


class Touches:
    """Where feet of one frame touched the ground, foot by foot."""

    def __init__(self, even: float) -> None:
        self._even = even
        self._points: list[list[Floats]] = [[], [], []]

    def add(self, soles: Floats) -> None:
        """Take in a touch of all three feet, shape (3, 3) [m]."""
        for foot, sole in enumerate(soles):
            self.add_foot(foot, sole)

    def add_foot(self, foot: int, sole: Floats) -> None:
        """Take in a touch of one foot, shape (3,) [m]."""
        self._points[foot].append(sole.copy())

    def add_hole(self, foot: int, sole: Floats) -> None:
        """A foot that found no ground: deeper than anything."""
        self._points[foot].append(np.array((sole[0], sole[1], HOLE)))

    def edges(self, foot: int) -> list[tuple[Floats, Floats]]:
        """Pairs of touches with an edge between them, seen from above [m]: of each touch those with the nearest that is higher or lower."""
        points = self._points[foot]
        found = []
        for a in points:
            others = [b for b in points if abs(b[2] - a[2]) > self._even]
            if others:
                b = min(others, key=lambda b: math.dist(a[:2], b[:2]))
                found.append((a[:2], b[:2]))
        return found

    def clearance(self, foot: int, place: Floats) -> float:
        """How far a place is from where edges may be, by what is known [m]; infinite without any."""
        return min((_to_segment(place, a, b) for a, b in self.edges(foot)), default=math.inf)

    def known(self, foot: int, place: Floats, near: float) -> bool:
        """Whether the foot has touched within a distance of a place [m]."""
        return any(math.dist(point[:2], place) < near for point in self._points[foot])

    def even_about(self, foot: int, place: Floats, radius: float) -> bool:
        """Whether all touches within a distance of a place are as high as each other [m]."""
        heights = [point[2] for point in self._points[foot] if math.dist(point[:2], place) <= radius]
        return bool(heights) and max(heights) - min(heights) <= self._even


def choose_footing(walker: Walker, frame: int, wish: Floats) -> Footing:
    """Bring a lifted frame down where no edge is near its feet, at `wish` or as near as can be found; all its feet stand in the end.

    Args:
        walker: The robot; the other frame stands.
        frame: The lifted frame.
        wish: Pose at which it was to stand, seen from above, shape (3,) [m], [rad].

    Raises:
        RefusedError: If a motion is beyond what the robot can.
        FallenError: If the robot falls.
    """
    settings, radius = walker.settings, walker.settings.probe
    touches, count, reason = Touches(settings.even), 0, ""
    middle = wish.copy()
    tried: list[Floats] = []
    even = False
    while count < settings.most_probes:
        tried.append(middle)
        even = True
        for angle in CORNERS:
            corner = middle + radius * np.array((math.cos(angle), math.sin(angle), 0.0))
            feet = _feet_at(walker, frame, corner)
            if all(touches.known(i, feet[i], TOLD * radius) for i in range(3)) or not _can(walker, frame, corner):
                continue
            count += 1
            _touch(walker, frame, corner, touches)
            uneven = _uneven(walker, frame, middle, radius, touches)
            if uneven is not None:
                even, reason = False, f"an edge near {leg_name(3 * frame + uneven)}"
                break
        if even:
            break
        better = _elsewhere(walker, frame, wish, touches, tried)
        if better is None:
            break
        middle = better
    if not even:
        middle = _best(walker, frame, wish, touches, tried)
    without = _touch(walker, frame, middle, touches)
    count += 1
    if not without and even:
        uneven = _uneven(walker, frame, middle, 0.5 * radius, touches)
        even = uneven is None
    return Footing(tuple(without), count, float(np.hypot(*(middle[:2] - wish[:2]))), even, reason)


def _touch(walker: Walker, frame: int, pose: Floats, touches: Touches) -> list[int]:
    """Bring the frame to a pose through the air and lower it; legs that found no ground."""
    mine = walker.of_frame(frame)
    if walker.on_ground(frame):
        motions.lift(walker, frame, pose)
    motions.slide(walker, frame, pose)
    without = motions.lower(walker, mine)
    for foot, i in enumerate(mine):
        if i in without:
            touches.add_hole(foot, walker.soles[i])
        else:
            touches.add_foot(foot, walker.soles[i])
    return without


def _uneven(walker: Walker, frame: int, middle: Floats, radius: float, touches: Touches) -> int | None:
    """The first foot with an edge near where it would stand; None where there is none."""
    feet = _feet_at(walker, frame, middle)
    for i in range(3):
        if not touches.even_about(i, feet[i], 1.2 * radius):
            return i
    return None


def _feet_at(walker: Walker, frame: int, pose: Floats) -> Floats:
    """Feet of a frame at a pose, seen from above, shape (3, 2) [m]; level."""
    c, s = math.cos(pose[2]), math.sin(pose[2])
    feet: Floats = pose[:2] + walker.robot.feet()[frame] @ np.array(((c, s), (-s, c)))
    return feet


def _can(walker: Walker, frame: int, pose: Floats) -> bool:
    limits = walker.settings.limits
    place = motions.place_for(walker, frame, pose)
    if room_at(walker.robot, place[None], limits)[0] < 0.0:
        return False
    step = look_at_step(walker.robot, walker.frames(), frame, 0.0, pose, walker.arm, walker.payload, limits)
    return step.room >= 0.0 and step.balance >= limits.balance


def _elsewhere(walker: Walker, frame: int, wish: Floats, touches: Touches, tried: list[Floats]) -> Floats | None:
    """The most promising middle for another triangle."""
    radius = walker.settings.probe
    best, found = -math.inf, None
    for pose in _places(wish):
        if any(math.dist(pose[:2], other[:2]) < 0.7 * radius for other in tried):
            continue
        worth = _worth(walker, frame, wish, pose, touches, 2.0 * radius)
        if worth > best and _can(walker, frame, pose):
            best, found = worth, pose
    return found


def _best(walker: Walker, frame: int, wish: Floats, touches: Touches, tried: list[Floats]) -> Floats:
    """Of what was tried, the middle farthest from edges."""
    radius = walker.settings.probe
    return max(tried, key=lambda pose: _worth(walker, frame, wish, pose, touches, 2.0 * radius))


def _worth(walker: Walker, frame: int, wish: Floats, pose: Floats, touches: Touches, most: float) -> float:
    feet = _feet_at(walker, frame, pose)
    clearances = [min(most, touches.clearance(i, feet[i])) for i in range(3)]
    return min(clearances) + 0.1 * sum(clearances) - FAR * math.dist(pose[:2], wish[:2])


def _places(wish: Floats) -> list[Floats]:
    """Places about where the frame was to stand, near ones first."""
    steps = np.arange(-SEARCHED, SEARCHED + 1e-9, GRID)
    found = [wish + np.array((x, y, 0.0)) for x in steps for y in steps if math.hypot(x, y) <= SEARCHED]
    return sorted(found, key=lambda pose: math.dist(pose[:2], wish[:2]))


def _to_segment(point: Floats, a: Floats, b: Floats) -> float:
    way = b - a
    square = float(way @ way)
    share = 0.0 if square == 0.0 else min(1.0, max(0.0, float((point - a) @ way) / square))
    return math.dist(point, a + share * way)
