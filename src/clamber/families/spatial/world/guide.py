"""A guide through space: the path that a body goes along, with a frame at each place, on which poses are a lattice.

Along straight pieces the frame stays; where the path bends it turns evenly, about an arc of the radius that the file states. A floor,
a wall or an overhang is a guide of one straight piece, on which places along and across reach to all sides.
"""

import math
from typing import Final

import numpy as np

from ....files import Document
from ....specs import spec
from ....types import Floats
from ....units import NonNegativeLength, Place
from .solids import Direction, check_direction, frame_about, unit

GRAIN: Final = 0.005
"""Distance of the frames of a table along a guide [m]; between them frames are interpolated."""
MOST_LENGTH: Final = 1000.0
"""Of a guide [m]: its table has 19 MB then, and all that is worked out along it grows with its length."""
NODE: Final = 12
"""Floats of a frame: its origin, then its axes along, across and out of the surface, world frame."""


@spec
class Waypoint:
    """A corner of a guide, or one of its ends."""

    at: Place
    normal: Direction | None = None
    """Out of the surface on the piece that begins here; None: as on the piece before."""
    bend: NonNegativeLength = 0.0
    """Radius of the arc that rounds the corner [m]."""


def guide_frames(points: tuple[Waypoint, ...], document: Document) -> Floats:
    """Frames of a guide every `GRAIN` of its length, shape (n, `NODE`).

    Args:
        points: Two or more.
        document: Of the world, for errors.

    Raises:
        SpecError: If it is longer than `MOST_LENGTH`, a piece is too short for the arcs at its ends, a normal lies along its piece, or the
            path turns right back.
    """
    places = np.array([point.at for point in points])
    pieces = np.diff(places, axis=0)
    lengths = np.linalg.norm(pieces, axis=1)
    if lengths.min() < GRAIN:
        raise document.problem(f"guide.{int(lengths.argmin())}.at", f"must be {1e3 * GRAIN:g} mm or more from the next")
    if not lengths.sum() <= MOST_LENGTH:
        raise document.problem("guide", f"is {lengths.sum():.0f} m long; at most {MOST_LENGTH:g} m")
    along = pieces / lengths[:, None]
    frames: list[Floats] = []
    normal = points[0].normal
    for k, tangent in enumerate(along):
        normal = points[k].normal or normal
        if normal is None:
            raise document.problem(f"guide.{k}", "must state the normal of the surface on the piece that begins here")
        check_direction(document, f"guide.{k}.normal", normal)
        square = np.asarray(normal) - float(np.dot(normal, tangent)) * tangent
        if np.linalg.norm(square) < 1e-3 * np.linalg.norm(normal):
            raise document.problem(f"guide.{k}.normal", "must not lie along the piece")
        frames.append(frame_about(unit(square), tangent))
    cuts = [0.0]
    for k, point in enumerate(points[1:-1], start=1):
        turn = math.acos(max(-1.0, min(1.0, float(along[k - 1] @ along[k]))))
        if turn > math.radians(170.0):
            raise document.problem(f"guide.{k}.at", "the path must not turn right back here")
        cuts.append(point.bend * math.tan(turn / 2.0))
    cuts.append(0.0)
    rows: list[Floats] = []
    for k, frame in enumerate(frames):
        free = float(lengths[k]) - cuts[k] - cuts[k + 1]
        if free < 0.0:
            raise document.problem(f"guide.{k}.bend", f"arcs leave {1e3 * free:.0f} mm of the piece that begins here")
        first = places[k] + cuts[k] * along[k]
        ways = free * np.linspace(0.0, 1.0, _number(free))
        rows.append(np.column_stack((first + ways[:, None] * along[k], np.tile(frame.ravel(), (len(ways), 1)))))
        if k + 1 < len(frames) and cuts[k + 1] > 0.0:
            rows += _arc(places[k + 1], cuts[k + 1], points[k + 1].bend, frame, frames[k + 1])
    return _even(np.vstack(rows))


def _number(length: float) -> int:
    return max(2, math.ceil(4.0 * length / GRAIN))


def _arc(corner: Floats, cut: float, radius: float, before: Floats, after: Floats) -> list[Floats]:
    """Frames along the arc that rounds a corner, from the frame before it to the frame after, turning evenly."""
    start, turn = corner - cut * before[0], math.acos(max(-1.0, min(1.0, float(before[0] @ after[0]))))
    inward = unit(after[0] - float(after[0] @ before[0]) * before[0])
    axis, angle = _turn_between(before, after)
    rows = []
    for share in np.linspace(0.0, 1.0, _number(radius * turn))[1:-1]:
        bent = share * turn
        place = start + radius * (math.sin(bent) * before[0] + (1.0 - math.cos(bent)) * inward)
        frame = before @ _rotation(axis, share * angle).T
        rows.append(np.concatenate((place, frame.ravel())))
    return rows


def _turn_between(before: Floats, after: Floats) -> tuple[Floats, float]:
    """Axis and angle of the rotation that takes one frame to another, their axes as rows."""
    turned = after.T @ before
    angle = math.acos(max(-1.0, min(1.0, (float(np.trace(turned)) - 1.0) / 2.0)))
    skew = np.array((turned[2, 1] - turned[1, 2], turned[0, 2] - turned[2, 0], turned[1, 0] - turned[0, 1]))
    return (unit(skew), angle) if np.linalg.norm(skew) > 1e-9 else (before[1], angle)


def _rotation(axis: Floats, angle: float) -> Floats:
    x, y, z = axis
    cross = np.array(((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0)))
    made: Floats = np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * (cross @ cross)
    return made


def _even(rows: Floats) -> Floats:
    """The same frames at even distances of the path."""
    way = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(rows[:, :3], axis=0), axis=1))))
    at = np.arange(0.0, way[-1] + GRAIN / 2.0, GRAIN)
    return np.column_stack([np.interp(at, way, column) for column in rows.T])
