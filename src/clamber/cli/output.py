"""What commands print: JSON or tables on stdout, everything on the way on stderr."""

import json
import os
import sys
import time
from pathlib import Path
from threading import Event, Thread
from typing import Any, Final

from rich.console import Console
from rich.padding import Padding
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


def print_indented(console: Console, words: str, indent: int = 2) -> None:
    """Print a paragraph whose lines all start further in."""
    console.print(Padding(Text(words), (0, 0, 0, indent), expand=False))


def announce_compilation(kernel: str = "replay", *, quiet: bool = False) -> None:
    """Tells on stderr that the first run compiles, if it does, and how far it is; `kernel` is the loop that the command runs."""
    from .. import compiled

    if not quiet and not compiled.is_compiled(kernel):
        stderr().print("compiling the kernels (about half a minute, once)")
        _command_ended.clear()
        Thread(target=_tell_compilation, args=(kernel, stderr()), daemon=True).start()


_command_ended: Final = Event()
"""What tells on the way falls silent with its command, though the process may live on."""


def fall_silent() -> None:
    """Ends what is told on the way; a command that ends calls it."""
    _command_ended.set()


def _tell_compilation(kernel: str, console: Console, every: float = 10.0, ended: Event = _command_ended) -> None:
    """Tells now and then how many kernels there are, until `kernel` is among them or the command has ended."""
    from .. import compiled

    began, folder, told = time.monotonic(), compiled.cache_folder(), time.monotonic()
    while not compiled.is_compiled(kernel):
        if ended.wait(0.5):
            return
        if time.monotonic() - told >= every:
            told = time.monotonic()
            count = sum(1 for _ in folder.glob("*.nbc"))
            console.print(f"  {count} kernels compiled after {told - began:.0f} s", style="dim")
    console.print(f"compiled in {time.monotonic() - began:.0f} s; from now on they are there", style="dim")


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
