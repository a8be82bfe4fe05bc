"""A log: columns of numbers with names and units, one row a sample, whatever file they came from."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from ..errors import ClamberError, describe_choices
from ..types import Floats
from ..units import split_title


class LogError(ClamberError):
    """A log that cannot be used: names the file, the column, the row, the value and what is allowed."""

    def __init__(self, log: str, column: str | None, row: int | None, value: object, allowed: str) -> None:
        super().__init__(log, column, row, value, allowed)
        self.log, self.column, self.row, self.value, self.allowed = log, column, row, value, allowed

    def __str__(self) -> str:
        where = [self.log]
        if self.column is not None:
            where.append(f"column '{self.column}'")
        if self.row is not None:
            where.append(f"row {self.row}")
        shown = "" if self.value is None else f" = {self.value}"
        return f"{', '.join(where)}{shown}: {self.allowed}"


@dataclass(frozen=True, slots=True, eq=False)
class Log:
    """Columns of equal length, all finite. Numbers are as the file has them; `log_roles` brings them to SI units."""

    columns: Mapping[str, Floats]
    """Name, without its unit -> values, shape (rows,)."""
    units: Mapping[str, str] = field(default_factory=dict)
    """Name -> unit as written, such as "deg"; a column without one is not there."""
    notes: Mapping[str, str] = field(default_factory=dict)
    """What else the file says about itself, such as robot and limb."""
    label: str = "log"
    """What errors call it: the file's path."""
    cut: bool = False
    """Whether the file ends in the middle, as a killed process leaves it: samples and notes may be missing at the end."""

    def __post_init__(self) -> None:
        rows = {name: np.shape(values) for name, values in self.columns.items()}
        if not rows:
            raise LogError(self.label, None, None, None, "has no columns; name them in its first line")
        first, shape = next(iter(rows.items()))
        if len(shape) != 1 or shape[0] < 1:
            raise LogError(self.label, first, None, shape, "must be a list of one number or more")
        for name, values in self.columns.items():
            if rows[name] != shape:
                allowed = f"must have as many rows as '{first}', {shape[0]}"
                raise LogError(self.label, name, None, f"{rows[name][0] if rows[name] else 0} rows", allowed)
            bad = np.flatnonzero(~np.isfinite(values))
            if bad.size:
                raise LogError(self.label, name, int(bad[0]) + 1, values[bad[0]], "must be a finite number")

    @property
    def rows(self) -> int:
        """Number of samples."""
        return int(next(iter(self.columns.values())).size)

    def column(self, name: str) -> Floats:
        """The values of a column.

        Raises:
            LogError: If there is none of that name.
        """
        if name not in self.columns:
            raise LogError(
                self.label, name, None, None, f"no such column; there are {describe_choices(name, self.columns)}"
            )
        return self.columns[name]

    def titles(self) -> list[str]:
        """Names with units, as a file's first line has them."""
        return [f"{name} [{self.units[name]}]" if name in self.units else name for name in self.columns]


def build_log(titles: list[str], columns: list[Floats], notes: Mapping[str, str], label: str) -> Log:
    """A log from titles such as "time [s]".

    Raises:
        LogError: If a title is empty or there twice, or the columns do not fit together.
    """
    named: dict[str, Floats] = {}
    units: dict[str, str] = {}
    for place, (title, values) in enumerate(zip(titles, columns, strict=True), start=1):
        name, unit = split_title(title)
        if not name:
            raise LogError(label, f"number {place}", None, repr(title), "must have a name")
        if name in named:
            raise LogError(label, name, None, None, "is there twice; names must differ")
        named[name] = values
        if unit is not None:
            units[name] = unit
    return Log(named, units, dict(notes), label)
