"""What commands print: JSON or tables on stdout, everything on the way on stderr."""

import json
import re
import sys
import time
from collections.abc import Collection, Iterator, Mapping
from dataclasses import fields
from pathlib import Path
from threading import Event, Thread
from typing import TYPE_CHECKING, Any, Final

import typer
from rich.console import Console, ConsoleOptions, RenderableType
from rich.padding import Padding
from rich.segment import Segment
from rich.text import Text

from ..errors import FileError, printable
from ..regular_files import check_target, is_there
from . import loaded

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


class PlainConsole(Console):
    """A console on which texts from files and names of files show what is in them, and steer nothing."""

    def render(self, renderable: RenderableType, options: ConsoleOptions | None = None) -> Iterator[Segment]:
        """What is printed, piece by piece; pieces that steer are the console's own."""
        for piece in super().render(renderable, options):
            yield piece if piece.control or piece.text.isprintable() else Segment(printable(piece.text), piece.style)


STATED: Final = (".toml", ".xml", ".urdf")
"""Files that people write: robots, worlds, tasks and models. What a command found out replaces none."""


def stdout() -> Console:
    """Where results go; 80 columns and no colour when piped."""
    loaded()
    return PlainConsole(highlight=False, markup=False, emoji=False)


_lent: list[Console] = []
"""The console of stderr on which a line is rewritten now, if there is one."""


def borrow_stderr(console: Console | None) -> None:
    """Have all that goes to stderr go to a console that rewrites its last line, so that neither breaks the other; None: no more."""
    loaded()
    _lent[:] = [] if console is None else [console]


def stderr() -> Console:
    """Where progress and notices go."""
    loaded()
    return _lent[0] if _lent else PlainConsole(stderr=True, highlight=False, markup=False, emoji=False)


def print_json(value: Any) -> None:
    """One JSON value on stdout, of plain values and dataclasses."""
    from ..json_form import plain

    loaded()
    sys.stdout.write(json.dumps(plain(value), indent=2, allow_nan=False) + "\n")
    sys.stdout.flush()  # so that a closed pipe shows here and not at exit


def print_indented(console: Console, words: str) -> None:
    """Print a paragraph whose lines all start further in."""
    console.print(Padding(Text(words), (0, 0, 0, 2), expand=False))


def announce_compilation() -> None:
    """Tells on stderr of kernels that are compiled while a command runs, here or in its workers, and how far that is."""
    _command_ended.clear()
    Thread(target=_await_kernels, daemon=True).start()


def _await_kernels() -> None:
    """Begin to tell once kernels are loaded: a command without any does not wait for their modules."""
    while not _command_ended.wait(0.1):
        cache = sys.modules.get("clamber.kernel_cache")
        if cache is not None and hasattr(cache, "KernelCache"):  # the last of its names
            _tell_compilation(cache.cache_folder())


_command_ended: Final = Event()
"""What tells on the way falls silent with its command, though the process may live on."""


def fall_silent() -> None:
    """Ends what is told on the way; a command that ends calls it."""
    _command_ended.set()


def _tell_compilation(folder: Path, every: float = 10.0, ended: Event = _command_ended) -> None:
    """Tells that kernels are compiled as soon as the first one comes into their folder, and how many there are while more come."""
    began = told = time.monotonic()
    seen, announced = _count_kernels(folder), False
    while not ended.wait(0.5):
        now, count = time.monotonic(), _count_kernels(folder)
        if not announced and count > seen and not ended.is_set():  # it may have ended while they were counted
            stderr().print("compiling the kernels, once: one or two minutes, more where the machine is busy")
            announced, told = True, now
        elif announced and now - told >= every:
            if count > seen:
                stderr().print(f"  {count} kernels compiled after {now - began:.0f} s", style="dim")
            seen, told = count, now


def _count_kernels(folder: Path) -> int:
    return sum(1 for _ in folder.glob("*.nbc"))


def tell_cuts(cuts: int) -> None:
    """Tells on stderr of searches for a plan that `--seconds` ended."""
    if cuts:
        searches = "a search" if cuts == 1 else f"{cuts} searches"
        stderr().print(
            f"--seconds ended {searches}: another machine, or this one under another load, may plan otherwise"
        )


def refuse_unused(options: "DataclassInstance", unused: Collection[str], why: str) -> None:
    """Make sure that no option is given that has no meaning.

    Args:
        options: As they came; a field that is as usual was not given.
        unused: Fields of options that have no meaning.
        why: For what, such as "'level-walk' is a walk".

    Raises:
        BadParameter: If one of these options is not as usual.
    """
    for field in fields(options):
        if field.name in unused and getattr(options, field.name) != field.default:
            flag = f"--{'no-' if field.default is True else ''}{field.name.replace('_', '-')}"
            raise typer.BadParameter(f"{why}: this has no meaning for it", param_hint=flag)


def check_writable(path: Path | None, *, force: bool = False) -> None:
    """Makes sure that a file can be written before hours are spent on what goes into it, and that nobody's work is lost by it.

    Raises:
        FileError: As `check_target`, or if it is of a kind that people write, is there already and `force` is not given.
    """
    if path is not None:
        check_target(path)
        if path.suffix.lower() in STATED and is_there(path) and not force:
            raise FileError(
                str(path), "is there already", f"files of {', '.join(STATED)} may be somebody's work: name another file"
            )


def check_output(path: Path | None, *suffixes: str) -> None:
    """Make sure that a picture, or a file with one of `suffixes`, can be written before anything runs."""
    check_writable(path)
    if path is not None:
        from ..viewing.output import CANVASES, check_suffix

        check_suffix(path, (*suffixes, *CANVASES))


def tell_written(console: Console, *paths: Path | None) -> None:
    """Print the names of files that were written."""
    for path in paths:
        if path is not None:
            console.print(f"written to {path}", soft_wrap=True)


def check_new(path: Path, force: bool) -> None:
    """Makes sure that a file can be written, and that there is none.

    Raises:
        FileError: As `check_target`, or if it is there already and `force` is not given.
    """
    check_target(path)
    if is_there(path) and not force:
        raise FileError(str(path), "is there already", "name another file, or write over it with --force")


def print_new(written: Mapping[str, str], told: str, following: str) -> None:
    """Print what `clamber new` made, the files by their kinds, and the command that comes next."""
    console = stdout()
    console.print(told)
    for kind, path in written.items():
        console.print(f"{kind} written to {path}", soft_wrap=True)
    console.print(f"next: {following}", soft_wrap=True)


def name_of(path: Path, kind: str = "wall") -> str:
    """A name for what a file describes, from the file's."""
    stem = re.sub(r"[^A-Za-z0-9_-]", "-", path.stem)[:56]
    return stem if stem[:1].isalpha() else f"{kind}-{stem}"
