"""A table of samples under titles, such as "body x true [m]": as a log, back from it, and taken apart into the fields of a trace."""

import json
from collections.abc import Mapping
from typing import Any, Final, TypeAlias, TypeVar

import numpy as np

from ..files import Document, parse_json
from ..specs import build_spec
from ..types import Floats, Ints, Json
from ..units import split_title
from .log import Log, LogError

T = TypeVar("T")
Titles: TypeAlias = Mapping[str, tuple[str, ...]]
"""Field of a trace -> titles of its columns, in the order of a sample's numbers."""
LARGEST: Final = 1e9
"""Of a run's samples, in SI units: thirty years, and a million kilometres."""
REPORT: Final = "report"
"""Note of a log that holds what came out, as JSON."""


def report_notes(notes: Json) -> dict[str, str]:
    """What a run's log says at its end: the report."""
    return {REPORT: json.dumps(notes)}


def report_of(log: Log) -> Json | None:
    """The report of a run's log; None where it was cut.

    Raises:
        LogError: If it is no table, no JSON, or has a number that is not finite.
    """
    if REPORT not in log.notes:
        return None
    report = note_of(log, REPORT)
    if not isinstance(report, dict):
        raise LogError(log.label, None, None, None, f"its note '{REPORT}' must be a table")
    return report


def note_of(log: Log, name: str) -> Any:
    """What a note holds as JSON.

    Raises:
        LogError: If it is none, or has a number that is not finite.
    """
    try:
        return parse_json(log.notes[name])
    except ValueError as error:
        raise LogError(
            log.label, None, None, None, f"its note '{name}' is not valid JSON: {str(error)[:200]}"
        ) from None


def told_of(report: Json | None, kind: type[T], label: str) -> T:
    """What is read back of a report: the keys that `kind` has, whatever others there are.

    Args:
        report: Of a log; None: it tells nothing.
        kind: A dataclass.
        label: What errors call the log.

    Raises:
        SpecError: If a key is missing, or its value is none that it may have.
    """
    return build_spec(kind, Document(f"{label}, note '{REPORT}'", report or {}))


def sample_log(trace: object, titles: Titles, notes: Mapping[str, str], label: str) -> Log:
    """The log of a trace.

    Args:
        trace: Its fields are arrays, shape (rows, ...), with as many numbers a row as there are titles.
        titles: Of its fields.
        notes: What the log says of itself.
        label: What errors call it.

    Raises:
        LogError: If a number is not finite.
    """
    columns: dict[str, Floats] = {}
    units: dict[str, str] = {}
    for field, names in titles.items():
        values = np.asarray(getattr(trace, field), dtype=np.float64)
        values = values.reshape(len(values), -1)
        for k, (name, unit) in enumerate(map(split_title, names)):
            columns[name] = values[:, k]
            if unit is not None:
                units[name] = unit
    return Log(columns, units, notes, label)


def table_of(log: Log, titles: Titles) -> Floats:
    """The samples of a log, shape (rows, columns).

    Raises:
        LogError: If it lacks a column, or has a number that is larger than any of a robot (`LARGEST`).
    """
    names = [split_title(title)[0] for of_field in titles.values() for title in of_field]
    table = np.stack([log.column(name) for name in names], axis=1)
    if (large := np.argwhere(np.abs(table) > LARGEST)).size:
        row, column = large[0].tolist()
        allowed = f"must lie between -{LARGEST:g} and {LARGEST:g}"
        raise LogError(log.label, names[column], row + 1, table[row, column], allowed)
    return table


def columns_of(titles: Titles) -> dict[str, slice]:
    """Field -> which of a sample's numbers are its."""
    ends = np.cumsum([0, *map(len, titles.values())]).tolist()
    return {field: slice(start, end) for field, start, end in zip(titles, ends, ends[1:], strict=False)}


def width(titles: Titles) -> int:
    """How many numbers a sample has."""
    return sum(map(len, titles.values()))


def fields_of(
    table: Floats, titles: Titles, *, whole: frozenset[str], shapes: Mapping[str, tuple[int, ...]]
) -> dict[str, Floats | Ints]:
    """The fields of a trace.

    Args:
        table: Samples, shape (rows, columns).
        titles: Of their numbers.
        whole: Fields of whole numbers.
        shapes: Of a sample's numbers in a field; one that is not named is a number, or a row of them.
    """
    parts: dict[str, Floats | Ints] = {}
    start = 0
    for field, names in titles.items():
        values = np.ascontiguousarray(table[:, start : start + len(names)])
        start += len(names)
        shape = shapes.get(field, () if len(names) == 1 else (len(names),))
        parts[field] = (values.astype(np.int32) if field in whole else values).reshape(-1, *shape)
    return parts
