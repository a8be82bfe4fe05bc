"""Log files by their suffix: .csv and .mcap in, the same out, written whole."""

import csv
import io
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np

from ..errors import FileError
from ..files import read_text, write_atomically
from ..regular_files import read_bytes
from .log import Log, LogError, build_log
from .log_mcap import TOPIC, mcap_bytes, mcap_of, parse_mcap
from .log_scene import LoggedScene

_NOTE: Final = re.compile(r"[A-Za-z][\w -]*")
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


SUFFIXES: Final = (".csv", ".mcap")
MOST_BYTES: Final = 128 * 1024 * 1024
"""Largest log that is read [bytes], whole into memory: a quarter of an hour of ten columns at 1 kHz as CSV."""


def check_log_suffix(path: Path) -> str:
    """The suffix of a log file's name, in lower case.

    Raises:
        FileError: If it is none of `SUFFIXES`.
    """
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise FileError(str(path), f"no log has the suffix '{suffix}'", f"allowed are {', '.join(SUFFIXES)}")
    return suffix


def read_log(path: Path, topic: str | None = None) -> Log:
    """A log from a file.

    Args:
        path: A .csv or .mcap file.
        topic: Channel of an MCAP file; None: the only one, or "limb".

    Raises:
        FileError: If it cannot be read.
        LogError: If it is no log.
    """
    suffix, name = check_log_suffix(path), str(path)
    if suffix == ".mcap":
        return parse_mcap(read_bytes(path, MOST_BYTES), name, topic)
    return parse_csv(read_text(path, MOST_BYTES), name)


def write_log(log: Log, path: Path, topic: str = TOPIC, scene: LoggedScene | None = None) -> None:
    """Write a log as its file's suffix says, whole or not at all; an .mcap file has a scene in three dimensions, too, if there is one.

    Raises:
        FileError: If the suffix is none of `SUFFIXES`, or the file cannot be written.
    """
    suffix = check_log_suffix(path)
    write_atomically(path, mcap_bytes(log, topic, scene) if suffix == ".mcap" else csv_text(log))


def write_logs(logs: Mapping[str, Log], path: Path) -> tuple[Path, ...]:
    """Write several logs, each under a name: an MCAP file gets a channel each, a single CSV log the file, several a file each.

    Returns:
        The files, each written whole or not at all: `path`, or for several CSV logs "run-scct.csv" and so on of "run.csv".

    Raises:
        FileError: If the suffix is none of `SUFFIXES`, or a file cannot be written.
    """
    if check_log_suffix(path) == ".mcap":
        write_atomically(path, mcap_of(logs))
        return (path,)
    files = dict(zip(_files(tuple(logs), path), logs.values(), strict=True))
    for file, log in files.items():
        write_log(log, file)
    return tuple(files)


def _files(names: tuple[str, ...], path: Path) -> list[Path]:
    """A file for each name, its letters and numbers kept; a second one of the same letters gets a number."""
    if len(names) == 1:
        return [path]
    out: list[Path] = []
    for name in names:
        word = re.sub(r"[^A-Za-z0-9._=+-]+", "-", name).strip("-")
        while (file := path.with_name(f"{path.stem}-{word}{path.suffix}")) in out:
            word += "-2"
        out.append(file)
    return out
