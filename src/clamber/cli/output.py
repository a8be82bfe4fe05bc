"""What commands print: JSON or tables on stdout, everything on the way on stderr."""

import json
import os
import sys
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from ..errors import FileError


def stdout() -> Console:
    """Where results go; 80 columns and no colour when piped."""
    return Console(highlight=False, markup=False, emoji=False)


def stderr() -> Console:
    """Where progress and notices go."""
    return Console(stderr=True, highlight=False, markup=False, emoji=False)


def print_json(value: Any) -> None:
    """One JSON value on stdout."""
    sys.stdout.write(json.dumps(value, indent=2, allow_nan=False) + "\n")
    sys.stdout.flush()  # so that a closed pipe shows here and not at exit


def plain_table(*columns: str, right: tuple[str, ...] = ()) -> Table:
    """A table without lines; the columns in `right` hold numbers."""
    table = Table(box=None, pad_edge=False, header_style="bold")
    for column in columns:
        table.add_column(Text(column), justify="right" if column in right else "left", overflow="fold")
    return table


def announce_compilation(kernel: str = "replay", *, quiet: bool = False) -> None:
    """Tells on stderr that the first run compiles, if it does; `kernel` is the loop that the command runs."""
    from ..compiled import is_compiled

    if not quiet and not is_compiled(kernel):
        stderr().print("compiling the kernels (about half a minute, once)")


def tell_cuts(cuts: int) -> None:
    """Tells on stderr of searches for a plan that `--seconds` ended."""
    if cuts:
        searches = "a search" if cuts == 1 else f"{cuts} searches"
        stderr().print(
            f"--seconds ended {searches}: another machine, or this one under another load, may plan otherwise"
        )


def check_writable(path: Path | None) -> None:
    """Makes sure that a file can be written before hours are spent on what goes into it.

    Raises:
        FileError: If its folder is missing or not writable, or the path is a folder.
    """
    if path is None:
        return
    if path.is_dir():
        raise FileError(str(path), "is a folder", "name a file")
    if not path.absolute().parent.is_dir():
        raise FileError(str(path), f"the folder {path.absolute().parent} does not exist", "make it first")
    if not os.access(path.absolute().parent, os.W_OK):
        raise FileError(str(path), "cannot be written", "name a file in a writable folder")
