"""Logs as CSV: a first line of column names with units, then one line a sample; notes as "# key: value" above."""

import csv
import io
import re
from typing import Final

import numpy as np

from .log import Log, LogError, build_log

_NOTE: Final = re.compile(r"[A-Za-z][\w -]*+")
"""Name of a note."""
SEPARATORS: Final = ",;\t"
"""Of these, the one that occurs most in the first line separates the columns."""


def csv_text(log: Log) -> str:
    """The text of a CSV file of a log; every number is read back as the same float."""
    out = io.StringIO()
    for key, value in log.notes.items():
        out.write(f"# {key}: {' '.join(value.split())}\n")
    rows = csv.writer(out, lineterminator="\n")
    rows.writerow(log.titles())
    rows.writerows(np.column_stack([np.asarray(values) for values in log.columns.values()]).tolist())
    return out.getvalue()


def parse_csv(text: str, label: str) -> Log:
    """The log of a CSV file's text. Rows in errors count the samples from 1; lines above are not counted.

    Raises:
        LogError: If a row has more or fewer cells than the first line, or a cell is no finite number.
    """
    notes: dict[str, str] = {}
    lines = text.splitlines()
    start = 0
    for start, line in enumerate(lines):  # noqa: B007  the place is used below
        key, colon, value = line[1:].partition(":")
        if line.startswith("#") and colon and _NOTE.fullmatch(key.strip()):
            notes[key.strip()] = value.strip()
        if line.strip() and not line.startswith("#"):
            break
    else:
        raise LogError(label, None, None, None, "is empty; the first line names the columns, such as 'time [s]'")
    separator = max(SEPARATORS, key=lines[start].count)
    try:
        rows = [row for row in csv.reader(lines[start:], delimiter=separator, skipinitialspace=True) if any(row)]
    except csv.Error as error:
        raise LogError(label, None, None, None, f"is not valid CSV: {error}") from None
    if not rows:
        raise LogError(label, None, None, None, "is empty; the first line names the columns, such as 'time [s]'")
    titles = rows.pop(0)
    while titles and not titles[-1].strip():  # a separator at the end of the line names nothing
        titles.pop()
    if all(map(_is_number, titles)):
        raise LogError(label, None, None, None, "has no names; its first line names the columns, such as 'time [s]'")
    if not rows:
        raise LogError(label, None, None, "0 rows", "must have samples below the line of names")
    table = np.empty((len(rows), len(titles)))
    for k, row in enumerate(rows):
        while len(row) > len(titles) and not row[-1].strip():
            row.pop()
        if len(row) != len(titles):
            raise LogError(label, None, k + 1, f"{len(row)} cells", f"must have {len(titles)}, as the line of names")
        try:
            table[k] = row
        except ValueError:
            place = next(j for j, cell in enumerate(row) if not _is_number(cell))
            raise LogError(label, titles[place], k + 1, repr(row[place]), "must be a finite number") from None
    return build_log(titles, list(table.T.copy()), notes, label)


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True
