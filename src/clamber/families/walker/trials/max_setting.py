"""The most that a walk bears: the largest value of one of its settings with which it comes to its end in balance, by bisection."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from operator import attrgetter
from typing import Annotated, Final

from ....json_form import Jsonable, Key
from .run_walk import WalkRun


@dataclass(frozen=True, slots=True)
class Tried(Jsonable):
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


def _value(name: str, most: "Most") -> str | None:
    tried: Tried | None = getattr(most, name)
    return None if tried is None else tried.value


REFUSED: Final = "The next one, which is not; null where the largest asked for is borne."


@dataclass(frozen=True, slots=True)
class Most:
    """What a bisection found."""

    tried: tuple[Tried, ...]
    """In the order of their values; between them nothing is known."""
    borne: Tried | None
    """The largest value found to be borne; None: not even the least."""
    refused: Tried | None
    """The next of the values that were asked for, which is not borne; None: the largest asked for is."""


@dataclass(frozen=True, slots=True)
class MaxSetting:
    """The most that a walk bears; exit code 1 where it does not bear even the least."""

    walk: str
    key: str
    found: Annotated[
        Most,
        Key("tried", get=attrgetter("tried"), kind=list[Tried], meaning="In the order of their values."),
        Key("borne", get=partial(_value, "borne"), kind=str | None, meaning="The largest value found to be borne."),
        Key("refused", get=partial(_value, "refused"), kind=str | None, meaning=REFUSED),
    ]


def most_tries(values: int) -> int:
    """Most walks that `find_most` takes for so many values."""
    return 2 + max(0, values - 2).bit_length()


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
