"""The surfaces of a world in space as flat faces and grid lines, cut to the part that is shown; for pictures and for the viewer."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np

from ....types import Floats
from ..planning.surface import on_guide
from ..world.guide import GRAIN
from ..world.patterns import frame_at
from ..world.solids import BAR, BOX, CYLINDER, FIELD, PLANE, TUBE
from ..world.terrain import face_normals
from ..world.world import World

SIDES: Final = 28
"""Flat sides of what is round."""
CELLS: Final = 14.0
"""Cells of a grid over the larger side of what is shown, about."""
RIBBON: Final = 0.02
"""Distance of the frames that a ribbon along a guide is drawn by [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Face:
    """A flat convex polygon."""

    corners: Floats
    """World frame [m], shape (n, 3)."""
    normal: Floats
    """Out of the solid, shape (3,)."""
    solid: int
    """Index of the solid it belongs to; -1: of the surface that the guide runs over."""


@dataclass(frozen=True, slots=True, eq=False)
class Surfaces:
    """Faces, and lines on them."""

    faces: tuple[Face, ...]
    lines: Floats
    """Ends of the grid's lines, world frame [m], shape (n, 2, 3)."""
    line_normals: Floats
    """Of the faces that the lines are on, shape (n, 3)."""


def round_length(about: float) -> float:
    """The next larger one of 1, 2, 5, 10, ... in metres."""
    power = float(10.0 ** math.floor(math.log10(about)))
    return next(m * power for m in (1.0, 2.0, 5.0, 10.0) if m * power >= 0.999 * about)


def surfaces_of(world: World, shown: Floats) -> Surfaces:
    """Surfaces of a world's solids; where it has none, a ribbon over which its guide runs.

    Args:
        world: The world.
        shown: Places that must be seen, such as holds and the robot's way, world frame [m], shape (n, 3).
    """
    span = float(np.ptp(shown, axis=0).max())
    cell = round_length(span / CELLS)
    records = world.solid_records
    faces: list[Face] = []
    lines: list[Floats] = []
    normals: list[Floats] = []
    if not len(records):
        ribbon = guide_ribbon(world, cell)
        faces += [Face(corners, normal, -1) for corners, normal in ribbon.quads()]
        lines, normals = [ribbon.lines(cell)], [ribbon.line_normals(cell)]
    planes = [record for record in records if int(record["kind"]) == PLANE]
    for k, record in enumerate(records):
        if int(record["kind"]) == PLANE:
            others = [plane for plane in planes if plane is not record and not np.array_equal(plane, record)]
            face, grid = _plane(record, others, shown, cell)
            if len(face) >= 3:
                faces.append(Face(face, np.array(record["axes"][2]), k))
                lines.append(grid)
                normals.append(np.tile(record["axes"][2], (len(grid), 1)))
            continue
        made = _solid_faces(record, shown)
        if int(record["kind"]) == FIELD:
            drawn = world.fields[k - len(world.solids)].drawn
            made = zip(drawn[0][drawn[1]], face_normals(drawn)[0], strict=True)
        for corners, normal in made:
            faces.append(Face(corners, normal, k))
    return Surfaces(
        tuple(faces), np.concatenate([np.zeros((0, 2, 3)), *lines]), np.concatenate([np.zeros((0, 3)), *normals])
    )


def _plane(record: np.void, others: list[np.void], shown: Floats, cell: float) -> tuple[Floats, Floats]:
    """Corners of the part of a plane that is near what is shown and outside other planes' solids, and its grid."""
    x, y, _ = (np.array(axis) for axis in record["axes"])
    centre = np.array(record["centre"])
    own = np.stack(((shown - centre) @ x, (shown - centre) @ y), axis=1)
    low, high = np.floor(own.min(axis=0) / cell - 0.5) * cell, np.ceil(own.max(axis=0) / cell + 0.5) * cell
    corners = np.array([(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])])
    place = centre + corners[:, :1] * x + corners[:, 1:] * y
    lines = []
    for a, b, axis, other in ((0, 1, x, y), (1, 0, y, x)):
        for at in np.arange(low[a], high[a] + 0.5 * cell, cell):
            start = centre + at * axis
            lines.append(np.stack((start + low[b] * other, start + high[b] * other)))
    grid = np.array(lines)
    for plane in others:
        normal, origin = np.array(plane["axes"][2]), np.array(plane["centre"])
        place = clip_polygon(place, normal, origin)
        grid = clip_lines(grid, normal, origin)
    return place, grid


def clip_polygon(corners: Floats, normal: Floats, origin: Floats) -> Floats:
    """The part of a convex polygon, shape (n, 3), on the side of a plane that its normal points to."""
    if not len(corners):
        return corners
    height = (corners - origin) @ normal
    kept: list[Floats] = []
    for k in range(len(corners)):
        here, then = corners[k], corners[(k + 1) % len(corners)]
        a, b = float(height[k]), float(height[(k + 1) % len(corners)])
        if a >= -1e-9:
            kept.append(here)
        if (a > 1e-9 and b < -1e-9) or (a < -1e-9 and b > 1e-9):
            kept.append(here + a / (a - b) * (then - here))
    return np.array(kept).reshape(-1, 3)


def clip_lines(lines: Floats, normal: Floats, origin: Floats) -> Floats:
    """The parts of lines, shape (n, 2, 3), on the side of a plane that its normal points to."""
    if not len(lines):
        return lines
    height = (lines - origin) @ normal
    kept = (height > -1e-9).any(axis=1)
    lines, height = lines[kept].copy(), height[kept]
    for end in (0, 1):
        out = height[:, end] < -1e-9
        share = height[:, end] / np.where(out, height[:, end] - height[:, 1 - end], 1.0)
        cut = lines[:, end] + share[:, None] * (lines[:, 1 - end] - lines[:, end])
        lines[:, end] = np.where(out[:, None], cut, lines[:, end])
    return lines


def _solid_faces(record: np.void, shown: Floats) -> Iterator[tuple[Floats, Floats]]:
    """Corners and normal of each face of a box, cylinder, tube or bar."""
    kind, centre, axes, size = int(record["kind"]), record["centre"], np.array(record["axes"]), record["size"]
    if kind == BOX:
        for axis in range(3):
            a, b = (axis + 1) % 3, (axis + 2) % 3
            for sign in (1.0, -1.0):
                own = np.zeros((4, 3))
                own[:, axis] = sign * size[axis]
                own[:, a] = size[a] * np.array((1.0, 1.0, -1.0, -1.0))
                own[:, b] = size[b] * np.array((1.0, -1.0, -1.0, 1.0))
                yield centre + own @ axes, sign * axes[axis]
        return
    assert kind in (CYLINDER, TUBE, BAR)
    radius, low, high = float(size[0]), -float(size[1]), float(size[1])
    if kind == TUBE:
        along = (shown - centre) @ axes[2]
        low, high = float(along.min()) - 0.1 * radius, float(along.max()) + 0.1 * radius
    if kind == BAR:
        low, high = low - 0.5 * radius, high + 0.5 * radius
    angles = np.arange(SIDES + 1) * (math.tau / SIDES)
    around = np.cos(angles)[:, None] * axes[0] + np.sin(angles)[:, None] * axes[1]
    rings = max(1, round((high - low) / (2.0 * radius))) if kind == TUBE else 1
    edges = np.linspace(low, high, rings + 1)
    for bottom, top in pairwise(edges):
        ends = [centre + radius * around + height * axes[2] for height in (bottom, top)]
        for k in range(SIDES):
            out = around[k] + around[k + 1]
            out = out / np.linalg.norm(out)
            yield np.stack((ends[0][k], ends[0][k + 1], ends[1][k + 1], ends[1][k])), -out if kind == TUBE else out
    if kind != TUBE:
        for height, sign in ((low, -1.0), (high, 1.0)):
            yield centre + radius * around[:-1] + height * axes[2], sign * axes[2]


@dataclass(frozen=True, slots=True, eq=False)
class Ribbon:
    """A strip over a guide, between two places across it."""

    frames: Floats
    """Of the guide where it is cut, shape (n, 12)."""
    left: float
    right: float
    """Across the guide [m]."""
    height: float
    """Over the guide [m]."""

    def edges(self) -> tuple[Floats, Floats]:
        """Both edges, world frame [m], shape (n, 3) each."""
        return self.at(self.right), self.at(self.left)

    def at(self, across: float) -> Floats:
        """Places so far across the guide at each frame [m], shape (n, 3)."""
        made: Floats = self.frames[:, :3] + across * self.frames[:, 6:9] + self.height * self.frames[:, 9:]
        return made

    def quads(self) -> Iterator[tuple[Floats, Floats]]:
        """Corners and normal of each piece."""
        right, left = self.edges()
        for k in range(len(self.frames) - 1):
            yield np.stack((right[k], right[k + 1], left[k + 1], left[k])), self.frames[k, 9:] + self.frames[k + 1, 9:]

    def _sides(self, cell: float) -> Floats:
        first, last = math.ceil(self.right / cell - 1e-6), math.floor(self.left / cell + 1e-6)
        sides: Floats = cell * np.arange(first, last + 1, dtype=np.float64)
        return sides

    def _rows(self, cell: float) -> Floats:
        """Indices of the frames that lines across are drawn at."""
        way = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(self.frames[:, :3], axis=0), axis=1))))
        return np.unique(np.searchsorted(way, np.arange(0.0, way[-1] + 1e-9, cell)).clip(0, len(way) - 1))

    def lines(self, cell: float) -> Floats:
        """Grid lines along and across, shape (n, 2, 3)."""
        along = [self.at(side) for side in self._sides(cell)]
        pieces = [np.stack((line[:-1], line[1:]), axis=1) for line in along]
        right, left = self.edges()
        rows = self._rows(cell)
        return np.concatenate([*pieces, np.stack((right[rows], left[rows]), axis=1)])

    def line_normals(self, cell: float) -> Floats:
        """Normal of the ribbon at each of `lines`."""
        normals = self.frames[:, 9:]
        return np.concatenate([*([normals[:-1]] * len(self._sides(cell))), normals[self._rows(cell)]])


def guide_ribbon(world: World, pad: float, along: tuple[float, float] | None = None) -> Ribbon:
    """The strip over a guide that its holds lie on.

    Args:
        world: Guide and holds.
        pad: Room on both sides and, where `along` is not given, beyond its ends [m].
        along: From where to where along the guide [m].
    """
    on = on_guide(world.frames, world.places) if len(world.holds) else np.zeros((1, 3))
    length = GRAIN * (len(world.frames) - 1)
    if along is None:
        first, last = min(0.0, float(on[:, 0].min())) - pad, max(length, float(on[:, 0].max())) + pad
    else:
        first, last = along
    at = np.linspace(first, last, max(2, math.ceil((last - first) / RIBBON) + 1))
    frames = np.array([frame_at(world.frames, one) for one in at])
    right, left = float(on[:, 1].min()) - 0.5 * pad, float(on[:, 1].max()) + 0.5 * pad
    return Ribbon(frames, left, right, float(np.median(on[:, 2])))
