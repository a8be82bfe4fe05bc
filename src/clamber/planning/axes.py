"""An axis of a sweep: one key of a task and the values that it takes."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from ..errors import OptionError
from ..json_form import Jsonable
from ..tasks.overrides import split_override
from ..units import split_quantity

POINTS: Final = 8
"""Points of a range that states no number."""
MOST_POINTS: Final = 100_000
"""Of one sweep."""


class SweepError(OptionError):
    """A sweep is asked for that can't be made."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Axis(Jsonable):
    """A key and its values, in order."""

    key: str
    """As in an override, such as "motor.torque_limit"."""
    unit: str = ""
    """As the user wrote it; empty for a count, a ratio or a name."""
    values: tuple[str, ...]
    """As in an override, such as "12 N m"; no two are the same."""
    numbers: tuple[float, ...] | None = None
    """The values in `unit`; None where they are names."""

    def overrides(self) -> tuple[str, ...]:
        """One override per value."""
        return tuple(f"{self.key}={value}" for value in self.values)


def range_axis(text: str) -> Axis:
    """The axis of "key=low..high" or "key=low..high:points", such as "motor.torque_limit=10Nm..21Nm:12".

    Both ends name the unit, if the key has one. Between whole numbers without a unit only whole ones are taken.

    Raises:
        SweepError: If it is no such text, or the range is empty.
    """
    option = f"--vary {text}"
    allowed = "write key=low..high:points, such as motor.torque_limit=10Nm..21Nm:12"
    key, _ = split_override(text)
    first, dots, rest = text.partition("=")[2].partition("..")
    second, colon, asked = rest.partition(":")
    words = first.strip(), second.strip()
    if not dots or not all(words):
        raise SweepError(option, "is no range", allowed)
    ends = [_finite(end) for end in words]
    for end, parts in zip(words, ends, strict=True):
        if parts is None:
            raise SweepError(option, f"'{end}' is no number", allowed)
    (low, unit), (high, other) = (parts for parts in ends if parts is not None)
    if unit != other:
        raise SweepError(option, f"one end is in '{unit}', the other in '{other}'", "state the same unit at both ends")
    points = _points(asked.strip() if colon else None, option)
    if not 0.0 < high - low < math.inf:
        raise SweepError(option, "the range is empty", "the first end must be less than the second")
    whole = not unit and all(re.fullmatch(r"[+-]?\d+", end) for end in words)
    steps = [low + (high - low) * k / (points - 1) for k in range(points - 1)] + [high]
    if whole and any(step != round(step) for step in steps):
        span = round(high - low)
        counts = [n + 1 for n in range(1, min(span, MOST_POINTS) + 1) if span % n == 0]
        if colon:
            fits = f"take {' or '.join(map(str, counts[:12]))} points, or write a decimal point"
            raise SweepError(option, f"{points} points between whole numbers are not all whole", fits)
        points = max(count for count in counts if count <= POINTS)
        steps = [low + (high - low) * k / (points - 1) for k in range(points)]
    texts = tuple(f"{step:.0f}" if whole else f"{step:.12g} {unit}".rstrip() for step in steps)
    return Axis(key=key, values=texts, numbers=tuple(steps), unit=unit)


def _finite(text: str) -> tuple[float, str] | None:
    """Number and unit of a text; None if it has no finite number."""
    parts = split_quantity(text)
    return parts if parts is not None and math.isfinite(parts[0]) else None


def _points(text: str | None, option: str) -> int:
    if text is None:
        return POINTS
    if not re.fullmatch(r"\d{1,9}", text) or int(text) < 2:
        raise SweepError(option, f"'{text}' is no number of points", "state a whole number, 2 or more")
    if int(text) > MOST_POINTS:
        raise SweepError(option, f"{text} points are too many", f"at most {MOST_POINTS} are planned")
    return int(text)


def values_axis(text: str) -> Axis:
    """The axis of "key=a,b,c", such as "rules.force_rule=thesis,min_torque".

    Raises:
        SweepError: If it is no such text, or a value is there twice.
    """
    option = f"--values {text}"
    key, _ = split_override(text)
    values = tuple(value.strip() for value in text.partition("=")[2].split(","))
    if not all(values):
        raise SweepError(option, "has an empty value", "write key=a,b,c, such as board=ladder,h")
    if len(set(values)) < len(values):
        raise SweepError(option, "names a value twice", "name each once")
    parts = [_finite(value) for value in values]
    known = [part for part in parts if part is not None]
    if len(known) == len(values) and len({unit for _, unit in known}) == 1:
        return Axis(key=key, values=values, numbers=tuple(number for number, _ in known), unit=known[0][1])
    return Axis(key=key, values=values)


@dataclass(frozen=True, slots=True, kw_only=True)
class Mark(Jsonable):
    """A reference on an axis, such as what a paper recommends: a value, or a range of them."""

    key: str
    """Of its axis."""
    low: float
    """In the unit of its axis."""
    high: float
    """The same as `low` for a single value."""
    text: str
    """As the user wrote it."""

    def holds(self, number: float) -> bool:
        """Whether a value of the axis is the mark, or lies in it, give or take rounding."""
        slack = 1e-9 * max(abs(self.low), abs(self.high))
        return self.low - slack <= number <= self.high + slack


def read_mark(text: str, axes: Sequence[Axis]) -> Mark:
    """The mark of "key=value" or "key=low..high", such as "board.spacing=18in..20in".

    Raises:
        SweepError: If it is no such text, its key does not vary, or its unit is not that of the axis.
    """
    option = f"--mark {text}"
    key, _ = split_override(text)
    written = text.partition("=")[2].strip()
    axis = next((axis for axis in axes if axis.key == key), None)
    if axis is None:
        raise SweepError(option, f"'{key}' does not vary", f"mark {' or '.join(axis.key for axis in axes)}")
    if axis.numbers is None:
        raise SweepError(option, f"the values of '{key}' are names", "mark numbers")
    ends = [_finite(end.strip()) for end in written.split("..")]
    known = [end for end in ends if end is not None]
    if len(known) < len(ends) or len(ends) > 2:
        raise SweepError(option, f"'{written}' is no number and no range", "write key=value or key=low..high")
    for _, unit in known:
        if unit != axis.unit:
            raise SweepError(option, f"is in '{unit}'", f"state the unit of the axis, '{axis.unit}'")
    low, high = known[0][0], known[-1][0]
    if low > high:
        raise SweepError(option, "the range is empty", "the first end must be less than the second")
    return Mark(key=key, low=low, high=high, text=written)


def check_axes(axes: Sequence[Axis]) -> None:
    """Makes sure that a sweep has one or two axes of different keys.

    Raises:
        SweepError: If it has not, or has too many points.
    """
    keys = [axis.key for axis in axes]
    if not 1 <= len(axes) <= 2:
        raise SweepError("--vary, --values", f"{len(axes)} keys are to vary", "name one or two")
    if len(set(keys)) < len(keys):
        raise SweepError("--vary, --values", f"'{keys[0]}' is to vary twice", "name two different keys")
    if (points := math.prod(len(axis.values) for axis in axes)) > MOST_POINTS:
        raise SweepError("--vary, --values", f"{points} points are too many", f"at most {MOST_POINTS} are planned")
