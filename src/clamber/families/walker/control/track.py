"""Where a robot is to go, seen from above: pieces of constant body twist, one after another.

Poses are x, y [m] and heading [rad], shape (3,).
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ....types import Floats
from ..robot.plane_poses import compose, seen_from


def along_twist(twist: Floats, share: float) -> Floats:
    """Pose after a share of a twist (vx, vy, omega, each times its time) that is constant in the moving frame, shape (3,)."""
    vx, vy, turn = share * twist
    if abs(turn) < 1e-9:
        return np.array((vx - 0.5 * turn * vy, vy + 0.5 * turn * vx, turn))
    sine, rest = math.sin(turn) / turn, (1.0 - math.cos(turn)) / turn
    return np.array((sine * vx - rest * vy, rest * vx + sine * vy, turn))


@dataclass(frozen=True, slots=True, eq=False)
class Track:
    """Where the robot is to go: pieces of constant body twist, one after another. Places on it are told by the way to them [m]."""

    start: Floats
    """Delta-frame's pose at way 0."""
    twists: Floats
    """Of each piece, times its time: x, y [m], turn [rad] in the moving frame, shape (pieces, 3)."""
    ways: Floats
    """Way at the start of each piece and at the end, shape (pieces + 1,) [m]."""

    @classmethod
    def of(cls, start: Floats, twists: Iterable[Floats], radius: float) -> "Track":
        """A track of these twists; a turn counts as the way of a foot at `radius` [m]."""
        pieces = np.array([np.asarray(twist, float) for twist in twists]).reshape(-1, 3)
        lengths = np.hypot(np.hypot(pieces[:, 0], pieces[:, 1]), radius * pieces[:, 2])
        kept = lengths > 0.0
        return cls(np.asarray(start, float), pieces[kept], np.concatenate(([0.0], np.cumsum(lengths[kept]))))

    @property
    def length(self) -> float:
        """The whole way [m]."""
        return float(self.ways[-1])

    def pose(self, way: float) -> Floats:
        """Where the Delta-frame is to be there, shape (3,)."""
        pose = self.start.copy()
        for k, twist in enumerate(self.twists):
            share = min(1.0, (way - self.ways[k]) / (self.ways[k + 1] - self.ways[k]))
            if share <= 0.0:
                break
            pose = compose(pose, along_twist(twist, share))
        return pose


def straight(start: Floats, direction: float, distance: float, radius: float) -> Track:
    """A straight way in a direction, from the heading at the start [rad], the heading kept."""
    return Track.of(start, [np.array((distance * math.cos(direction), distance * math.sin(direction), 0.0))], radius)


def twist_between(a: Floats, b: Floats) -> Floats:
    """Twist that takes a frame from pose `a` to pose `b` at a constant rate, the shorter way round: `along_twist` undone, shape (3,)."""
    x, y, turn = seen_from(a, b)
    turn = math.remainder(turn, math.tau)
    if abs(turn) < 1e-9:
        return np.array((x + 0.5 * turn * y, y - 0.5 * turn * x, turn))
    sine, rest = math.sin(turn) / turn, (1.0 - math.cos(turn)) / turn
    square = sine * sine + rest * rest
    return np.array(((sine * x + rest * y) / square, (sine * y - rest * x) / square, turn))


def through(start: Floats, poses: Floats, radius: float, *, within: float = 0.0) -> Track:
    """From pose to pose, each piece at a constant rate: straight where the heading is kept, else in an arc.

    Poses that a longer piece passes closely enough are left out (after Ramer, and Douglas and Peucker): the frames wait for each other at
    every corner of a track, so many short pieces would be many short steps.

    Args:
        start: Of the Delta-frame, shape (3,).
        poses: One after another, world frame, shape (n, 3).
        radius: A turn counts as the way of a foot so far from the frame's origin [m].
        within: How far the track may pass a pose, at the same share of the way, a turn counted likewise [m].
    """
    every = np.vstack([start[None], poses])
    ways = np.concatenate(([0.0], np.cumsum(_apart(every[:-1], every[1:], radius))))
    corners, open_pieces = [0], [(0, len(every) - 1)]
    while open_pieces:
        i, j = open_pieces.pop()
        off = _passed(every[i : j + 1], ways[i : j + 1], radius)[1:-1]
        if off.max(initial=0.0) <= within:
            corners.append(j)
        else:
            k = i + 1 + int(np.argmax(off))
            open_pieces += [(k, j), (i, k)]
    return Track.of(start, [twist_between(every[i], every[j]) for i, j in pairwise(corners)], radius)


def _apart(a: Floats, b: Floats, radius: float) -> Floats:
    """Between poses, shape (n,) [m]."""
    turns = np.remainder(b[:, 2] - a[:, 2] + math.pi, math.tau) - math.pi
    out: Floats = np.hypot(np.hypot(b[:, 0] - a[:, 0], b[:, 1] - a[:, 1]), radius * turns)
    return out


def _passed(poses: Floats, ways: Floats, radius: float) -> Floats:
    """How far one piece from the first pose to the last passes each, shape (n,) [m]."""
    twist, whole = twist_between(poses[0], poses[-1]), ways[-1] - ways[0]
    shares = (ways - ways[0]) / whole if whole > 0.0 else np.zeros(len(ways))
    return _apart(compose(poses[0], np.array([along_twist(twist, float(share)) for share in shares])), poses, radius)
