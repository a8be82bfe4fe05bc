"""Sets of numbers as sorted, disjoint, closed intervals."""

from collections.abc import Iterable
from typing import TypeAlias

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
