"""What a benchmark prints: rows of a name, a value, its unit and what the project aims at."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from statistics import median

from ..json_form import Jsonable, OrNull

NOTHING = math.nan
"""The value of a row that could not be measured, or of a time until something that did not happen."""


@dataclass(frozen=True, slots=True)
class Row(Jsonable):
    """One measurement."""

    name: str
    value: OrNull
    """NaN where there is none."""
    unit: str
    aim: str | None = None
    """What it should be, in words."""


Say = Callable[[str], None]
"""Told, in a few words, what is being measured."""


def keep_quiet(_: str) -> None:
    """For those who want to hear nothing on the way."""


def median_or_nothing(values: Sequence[float | None]) -> float:
    """The median where None counts as larger than anything; `NOTHING` if the median itself is such a one."""
    middle = median([math.inf if value is None else value for value in values]) if values else math.inf
    return middle if math.isfinite(middle) else NOTHING
