"""The most that a walk bears: the largest value of one of its settings with which it comes to its end in balance, by bisection."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ...types import Json
from .run_walk import WalkRun


@dataclass(frozen=True, slots=True)
class Tried:
    """What became of a walk with one value."""

    value: str
    """As in an override, such as "12 kg"."""
    borne: bool
    """Whether it came to its end, with its centre of mass inside the feet on the ground throughout."""
    reason: str
    """Why not; empty where it did."""
    margin: float | None
    """Least margin of balance while it walked [m]; None where fewer than three feet were on the ground at a time, or it did not begin."""
    tilt: float
    """Largest angle of the plate from level while it walked [rad]."""

    @classmethod
    def of(cls, value: str, run: WalkRun) -> "Tried":
        """Judge a walk."""
        margin = run.margin if math.isfinite(run.margin) else None
        balanced = margin is not None and margin > 0.0
        reason = run.reason or ("" if balanced else "the centre of mass left the feet on the ground")
        return cls(value, not reason, reason, margin, run.tilt)

    @classmethod
    def refused(cls, value: str, reason: str) -> "Tried":
        """A value with which the walk cannot begin."""
        return cls(value, False, reason, None, 0.0)

    def to_json(self) -> Json:
        """Plain data."""
        return {name: getattr(self, name) for name in self.__slots__}


@dataclass(frozen=True, slots=True)
class Most:
    """What a bisection found."""

    tried: tuple[Tried, ...]
    """In the order of their values; between them nothing is known."""
    borne: Tried | None
    """The largest value found to be borne; None: not even the least."""
    refused: Tried | None
    """The next of the values that were asked for, which is not borne; None: the largest asked for is."""


def find_most(values: Sequence[str], walk: Callable[[str], Tried]) -> Most:
    """The largest of values that is borne, as far as a bisection can tell: one that is borne beside one that is not.

    Where a walk bears a value but not every smaller one, there are several such places, and any of them may be found.

    Args:
        values: In growing order, two or more.
        walk: Tries one.
    """
    tried = {0: walk(values[0])}
    low, high = 0, len(values) - 1
    if not tried[0].borne:
        return Most((tried[0],), None, tried[0])
    tried[high] = walk(values[high])
    if tried[high].borne:
        low = high
    while high - low > 1:
        middle = (low + high) // 2
        tried[middle] = walk(values[middle])
        low, high = (middle, high) if tried[middle].borne else (low, middle)
    return Most(tuple(tried[k] for k in sorted(tried)), tried[low], None if low == high else tried[high])
