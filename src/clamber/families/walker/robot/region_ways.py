"""Places and ways inside a region: across a line, and round what is in the way."""

import heapq
import math
from itertools import pairwise
from typing import Final

import numpy as np

from ....types import Floats
from .arcs import ray
from .curves import crossings
from .workspace import Workspace, half_plane

LINES: Final = 48
"""Lines across a region whose middles a way may go through."""
CLOSE: Final = 1e-9
"""Ends of a way may lie as much outside, by rounding [m]."""


def place_at(region: Workspace, direction: float, apart: float, aside: bool) -> Floats:
    """A place of the region that lies `apart` along a direction: on the line through the centre where that may be, else nearest to it.

    Args:
        region: Must have such a place.
        direction: [rad].
        apart: Component of the place along it [m].
        aside: Whether it may be off the line.
    """
    along = np.array([math.cos(direction), math.sin(direction)])
    across = np.array([-along[1], along[0]])
    straight: Floats = apart * along
    if not aside or _is_inside(region, np.zeros(2), straight):
        return straight
    pieces = slices(region, along, apart)
    assert pieces, "the region has places as far along"
    low, high = min(pieces, key=lambda piece: abs(0.5 * (piece[0] + piece[1])))
    place: Floats = straight + 0.5 * (low + high) * across
    return place


def slices(region: Workspace, along: Floats, apart: float) -> list[tuple[float, float]]:
    """Where the line of all p with p . along = apart is in the region: ranges of p . across, `across` to the left [m]."""
    across = np.array([-along[1], along[0]])
    curves = np.vstack([region.curves, half_plane((float(along[0]), float(along[1])), apart)])
    line, at = len(curves) - 1, np.empty(4)
    marks = [float(t) for j in range(line) for t in at[: crossings(curves, line, j, at)]]
    marks.sort()
    return [
        (low, high)
        for low, high in pairwise(marks)
        if region.depth(apart * along + 0.5 * (low + high) * across) >= -CLOSE
    ]


def way_inside(region: Workspace, start: Floats, end: Floats) -> Floats | None:
    """A way of straight lines inside the region, the shortest over the middles of its slices, shape (n, 2) [m]; None if none is found."""
    if _is_inside(region, start, end):
        return np.array([start, end])
    places = [start, end, np.zeros(2)]
    for direction in (0.0, 0.5 * math.pi):
        along = np.array([math.cos(direction), math.sin(direction)])
        across = np.array([-along[1], along[0]])
        low, high = region.extent(direction)
        for apart in np.linspace(low, high, LINES)[1:-1]:
            places += [apart * along + 0.5 * (a + b) * across for a, b in slices(region, along, float(apart))]
    far = [math.inf] * len(places)
    far[0], before, open_list, closed = 0.0, [0] * len(places), [(0.0, 0)], set()
    while open_list:
        _, here = heapq.heappop(open_list)
        if here in closed:
            continue
        closed.add(here)
        if here == 1:
            row = [1]
            while row[-1] != 0:
                row.append(before[row[-1]])
            return np.array([places[k] for k in row[::-1]])
        for there in range(1, len(places)):
            length = far[here] + float(np.hypot(*(places[there] - places[here])))
            if there not in closed and length < far[there] and _is_inside(region, places[here], places[there]):
                far[there], before[there] = length, here
                heapq.heappush(open_list, (length, there))
    return None


def _is_inside(region: Workspace, start: Floats, end: Floats) -> bool:
    """Whether a straight line lies in the region."""
    length = float(np.hypot(*(end - start)))
    if region.depth(start) < -CLOSE or region.depth(end) < -CLOSE:
        return False
    if length < CLOSE:
        return True
    dx, dy = (end - start) / length
    x, y = start + CLOSE * np.array([dx, dy]) if region.depth(start) < CLOSE else start
    return bool(ray(region.curves, len(region.curves), x, y, dx, dy) >= length - 3.0 * CLOSE)
