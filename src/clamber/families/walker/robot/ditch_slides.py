"""The fewest slides that bring both frames over a ditch, by their places across it alone."""

import math
from collections.abc import Iterable, Sequence
from typing import Final, TypeAlias

from ....types import Floats

Interval: TypeAlias = tuple[float, float]
Intervals: TypeAlias = tuple[Interval, ...]


def union(pieces: Iterable[Interval]) -> Intervals:
    """The pieces put together; empty ones (low above high) fall away."""
    out: list[Interval] = []
    for low, high in sorted(piece for piece in pieces if piece[0] <= piece[1]):
        if out and low <= out[-1][1]:
            out[-1] = (out[-1][0], max(high, out[-1][1]))
        else:
            out.append((low, high))
    return tuple(out)


def meet(some: Intervals, others: Intervals) -> Intervals:
    """What is in both."""
    return union((max(a, c), min(b, d)) for a, b in some for c, d in others)


def spread(some: Intervals, low: float, high: float) -> Intervals:
    """Every sum of a number of `some` and one from low to high."""
    return union((a + low, b + high) for a, b in some)


def middle(some: Intervals) -> float:
    """The middle of the widest piece; of an unbounded one its end."""
    low, high = max(some, key=lambda piece: piece[1] - piece[0])
    if abs(low) == float("inf"):
        return high
    return low if abs(high) == float("inf") else 0.5 * (low + high)


MOST: Final = 400
"""Slides at most."""
BACKWARDS: Final = 0.5
"""How far a frame may go back behind where it starts [m]."""


def fewest_slides(
    feet: Floats, width: float, pad_radius: float, start: Floats, limits: tuple[float, float]
) -> list[tuple[int, float]] | None:
    """Frame and place across the ditch of every slide until both frames are behind it; None if no row of slides leads there.

    Where a frame can be put down depends on where the other stands, and on nothing before: so the places that k slides can lead to are a
    set of numbers, made from that of k - 1.

    Args:
        feet: Places of the frames' feet across the ditch, from their origins, shape (2, 3) [m].
        width: Of the ditch, 0 < x < width [m].
        pad_radius: Of a foot [m].
        start: Places of the frames' origins, shape (2,) [m].
        limits: Range of the Y-frame's place less the Delta-frame's [m].
    """
    room = (float(start.min()) - BACKWARDS, math.inf)
    allowed = [meet(_standing(row, width, pad_radius), (room,)) for row in feet]
    far: list[Intervals] = [((width + pad_radius - float(row.min()), math.inf),) for row in feet]
    rows = [row for first in (0, 1) if (row := _row(first, start, allowed, far, limits)) is not None]
    return min(rows, key=len) if rows else None


def _standing(places: Floats, width: float, pad_radius: float) -> Intervals:
    """Where a frame can stand: the intervals by how many of its feet are across."""
    falling = sorted(places, reverse=True)
    ends = [-float(place) - pad_radius for place in falling] + [math.inf]
    starts = [-math.inf] + [width + pad_radius - float(place) for place in falling]
    return union(zip(starts, ends, strict=True))


def _within(standing: int, places: Intervals, limits: tuple[float, float]) -> Intervals:
    """Where the other frame may be while this one stands in these places."""
    low, high = limits
    return spread(places, low, high) if standing == 0 else spread(places, -high, -low)


def _row(
    first: int, start: Floats, allowed: Sequence[Intervals], far: Sequence[Intervals], limits: tuple[float, float]
) -> list[tuple[int, float]] | None:
    reached: list[Intervals] = [
        ((float(start[1 - first]),) * 2,)
    ]  # [k] of the frame that the k-th slide moved; 0: of that which stands
    for k in range(1, MOST):
        lifted = (first + k - 1) % 2
        behind = meet(reached[-1], far[1 - lifted])
        if k > 1 and meet(far[lifted], _within(1 - lifted, behind, limits)):
            reached[-1] = behind
            reached.append(meet(far[lifted], _within(1 - lifted, behind, limits)))
            return _choose(first, reached, limits)
        reached.append(meet(allowed[lifted], _within(1 - lifted, reached[-1], limits)))
        if not reached[-1] or (k > 3 and reached[-1] == reached[-3] and reached[-2] == reached[-4]):
            return None
    return None


def _choose(first: int, reached: list[Intervals], limits: tuple[float, float]) -> list[tuple[int, float]]:
    """A place of each slide, from the last one back, each in the middle of what the next one leaves."""
    out: list[tuple[int, float]] = []
    for k in range(len(reached) - 1, 0, -1):
        frame = (first + k - 1) % 2
        places = reached[k]
        if out:
            after = out[-1][1]
            places = meet(places, _within(1 - frame, ((after, after),), limits))
        out.append((frame, middle(places)))
    return out[::-1]
