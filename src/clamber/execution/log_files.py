"""Log files by their suffix: .csv and .mcap in, the same out, written whole."""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from ..errors import FileError
from ..files import read_text, write_atomically
from ..regular_files import read_bytes
from .log import Log
from .log_csv import csv_text, parse_csv
from .log_mcap import TOPIC, mcap_bytes, mcap_of, parse_mcap

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


def write_log(log: Log, path: Path, topic: str = TOPIC) -> None:
    """Write a log as its file's suffix says, whole or not at all.

    Raises:
        FileError: If the suffix is none of `SUFFIXES`, or the file cannot be written.
    """
    suffix = check_log_suffix(path)
    write_atomically(path, mcap_bytes(log, topic) if suffix == ".mcap" else csv_text(log))


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
