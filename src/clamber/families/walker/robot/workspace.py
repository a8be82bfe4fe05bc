"""Where the Y-frame can be at one angle to the Delta-frame: regions bounded by exact arcs, their areas, and chords through them."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from ....types import Floats
from .arcs import COLUMNS, MOST_ARCS, ROOM, extent, outline, owner_of, ray
from .curves import BELOW, CURVE_NUMBERS, MOST_CURVES, depth, point, reach_curves
from .geometry import TwoFrames


@dataclass(frozen=True, slots=True)
class Arc:
    """A piece of a region's boundary, which lies to its left."""

    start: tuple[float, float]
    """Its first point [m]."""
    end: tuple[float, float]
    """Its last point [m]."""
    curve: tuple[float, ...]
    """What it is a piece of: a row of `arcs`."""
    first: float
    """Parameter of its first point on the curve."""
    last: float
    """Parameter of its last point on the curve."""

    def points(self, step: float = math.radians(2.0)) -> Floats:
        """Points along it, both ends included, for pictures [m], shape (n, 2)."""
        if self.curve[0] == BELOW:
            return np.array([self.start, self.end])
        row = np.array([self.curve])
        count = 2 + int(abs(self.last - self.first) / step)
        return np.array([point(row, 0, t) for t in np.linspace(self.first, self.last, count)])


@dataclass(frozen=True, slots=True)
class Part:
    """A connected part of a region."""

    area: float
    """Holes taken off [m^2]."""
    loops: tuple[tuple[Arc, ...], ...]
    """Its boundary: the outer loop first, then those of its holes, each in order."""
    holds_centre: bool
    """Whether the frames' origins may lie on each other in it."""


@dataclass(frozen=True, slots=True, eq=False)
class Workspace:
    """All places of the Y-frame's origin in the Delta-frame at one angle."""

    theta: float
    """Angle of the Y-frame in the Delta-frame [rad]."""
    curves: Floats
    """What bounds it: rows of `arcs`, shape (n, CURVE_NUMBERS)."""
    parts: tuple[Part, ...]
    """Its connected parts, the largest first."""

    @property
    def area(self) -> float:
        """Of all parts [m^2]."""
        return sum(part.area for part in self.parts)

    @property
    def central(self) -> Part | None:
        """The part in which the frames' origins may lie on each other; None if they may not."""
        return next((part for part in self.parts if part.holds_centre), None)

    def depth(self, place: npt.ArrayLike) -> float:
        """Signed distance of a place from the nearest curve, positive inside the region [m]."""
        x, y = np.asarray(place, np.float64)
        return float(depth(self.curves, len(self.curves), x, y))

    def chord(self, direction: float) -> tuple[float, float]:
        """Range of s for which s along a direction is reached straight from the centre [m]; both 0 if the centre is outside."""
        dx, dy = math.cos(direction), math.sin(direction)
        n = len(self.curves)
        return -float(ray(self.curves, n, 0.0, 0.0, -dx, -dy)), float(ray(self.curves, n, 0.0, 0.0, dx, dy))

    def extent(self, direction: float) -> tuple[float, float]:
        """Range of p . d over the part around the centre, for the unit vector d of a direction [m]; both 0 without such a part."""
        if self.central is None:
            return 0.0, 0.0
        curves = np.array([arc.curve for arc in self.central.loops[0]])
        rows = [(k, arc.first, arc.last, 0.0, *arc.start, *arc.end) for k, arc in enumerate(self.central.loops[0])]
        arcs, owners = np.array(rows), np.zeros(1, np.int64)
        d = math.cos(direction), math.sin(direction)
        least = -float(extent(curves, arcs, len(arcs), owners, 0, -d[0], -d[1]))
        return least, float(extent(curves, arcs, len(arcs), owners, 0, *d))


@dataclass(frozen=True, slots=True)
class Stride:
    """How far the Y-frame goes along a line, both ways from where it starts; both 0 if it may not be there."""

    back: float
    """Against the direction [m]."""
    ahead: float
    """Along it [m]."""

    @property
    def length(self) -> float:
        """The whole chord [m]."""
        return self.back + self.ahead


def workspace(
    frames: TwoFrames, theta: float, *, guard: float | None = None, besides: Floats | None = None
) -> Workspace:
    """The region at one angle, exact but for rounding.

    Args:
        frames: The mechanism.
        theta: Angle of the Y-frame in the Delta-frame [rad].
        guard: Largest nearness of a singular pose [-]; 1 for all that is not beyond one; None for strokes alone.
        besides: More curves that bound it, rows of `arcs`, shape (m, CURVE_NUMBERS).

    """
    curves, n = region_curves(frames, theta, guard, besides)
    arcs, areas, owners = np.empty((MOST_ARCS, COLUMNS)), np.empty(MOST_ARCS), np.empty(MOST_ARCS, np.int64)
    count, loops = outline(curves, n, arcs, areas, owners, np.empty(ROOM))
    centre = owner_of(curves, n, arcs, count, loops, areas, 0.0, 0.0)
    told = [_loop(curves, arcs[:count], loop) for loop in range(loops)]
    parts = []
    for loop in range(loops):
        if areas[loop] > 0.0:
            holes = [k for k in range(loops) if k != loop and owners[k] == loop]
            area = float(areas[loop] + sum(areas[hole] for hole in holes))
            parts.append(Part(area, (told[loop], *(told[hole] for hole in holes)), loop == centre))
    parts.sort(key=lambda part: -part.area)
    return Workspace(theta, curves[:n].copy(), tuple(parts))


def region_curves(
    frames: TwoFrames, theta: float, guard: float | None = None, besides: Floats | None = None
) -> tuple[Floats, int]:
    """The curves of a region as the kernels take them, shape (MOST_CURVES, CURVE_NUMBERS), and how many are in use; see `workspace`."""
    curves = np.zeros((MOST_CURVES, CURVE_NUMBERS))
    n = reach_curves(frames.delta, frames.y, theta, frames.shortest, frames.longest, guard or 0.0, curves)
    if besides is not None:
        curves[n : n + len(besides)] = besides
        n += len(besides)
    return curves, n


def stride(
    frames: TwoFrames,
    theta: float,
    direction: float,
    *,
    start: tuple[float, float] = (0.0, 0.0),
    guard: float | None = None,
) -> Stride:
    """The longest step in a direction: the whole chord of the region through a place, exact.

    Args:
        frames: The mechanism.
        theta: Angle of the Y-frame in the Delta-frame [rad].
        direction: In the Delta-frame [rad].
        start: The place that the chord goes through, the frames' origins on each other unless given [m].
        guard: As of `workspace`.

    """
    curves, n = region_curves(frames, theta, guard)
    dx, dy = math.cos(direction), math.sin(direction)
    ahead = ray(curves, n, start[0], start[1], dx, dy)
    return Stride(float(ray(curves, n, start[0], start[1], -dx, -dy)), float(ahead))


SAMPLES: Final = 720
GOLDEN: Final = 0.5 * (math.sqrt(5.0) - 1.0)


def best_directions(frames: TwoFrames, theta: float, *, guard: float | None = None) -> tuple[tuple[float, ...], float]:
    """Directions of the longest step through the centre, and its length.

    Args:
        frames: The mechanism.
        theta: Angle of the Y-frame in the Delta-frame [rad].
        guard: As of `workspace`.

    Returns:
        Directions in [0, 2 pi), within 1e-9 m of the best [rad], and the length [m].
    """
    curves, n = region_curves(frames, theta, guard)

    def chord(angle: float) -> float:
        dx, dy = math.cos(angle), math.sin(angle)
        return float(ray(curves, n, 0.0, 0.0, dx, dy) + ray(curves, n, 0.0, 0.0, -dx, -dy))

    width = math.pi / SAMPLES
    chords = [chord(k * width) for k in range(SAMPLES)]
    peaks = []
    for k in range(SAMPLES):
        if chords[k] >= chords[k - 1] and chords[k] >= chords[(k + 1) % SAMPLES]:
            low, high = (k - 1) * width, (k + 1) * width
            while high - low > 1e-10:
                a, b = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
                low, high = (low, b) if chord(a) >= chord(b) else (a, high)
            peaks.append((chord(0.5 * (low + high)), 0.5 * (low + high)))
    best = max(peak for peak, _ in peaks)
    angles = [angle % math.pi for peak, angle in peaks if peak >= best - 1e-9]
    return tuple(sorted({round(a, 9) for angle in angles for a in (angle, angle + math.pi)})), best


def half_plane(normal: tuple[float, float], most: float) -> Floats:
    """The row of all p with normal . p <= most, for a unit normal, shape (CURVE_NUMBERS,)."""
    return np.array([BELOW, normal[0], normal[1], most, 0.0, 0.0, 0.0, 0.0])


def _loop(curves: Floats, arcs: Floats, loop: int) -> tuple[Arc, ...]:
    """Arcs of one loop in order."""
    left = [row for row in arcs if row[3] == loop]
    order = [left.pop(0)]
    while left:
        apart = [math.hypot(row[4] - order[-1][6], row[5] - order[-1][7]) for row in left]
        order.append(left.pop(int(np.argmin(apart))))
    return tuple(
        Arc(
            (float(row[4]), float(row[5])), (float(row[6]), float(row[7])),
            tuple(map(float, curves[int(row[0])])), float(row[1]), float(row[2]),
        )
        for row in order
    )  # fmt: skip
