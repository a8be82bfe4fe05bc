"""Who runs the items of a command, local processes or a Ray cluster, and the options of commands that have many."""

import os
import time
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import typer
from rich.console import Console

from ..interrupts import answer
from .live_line import LiveLine
from .options import AsJson, Output, Quiet, Ray, Resume, Store, Workers
from .output import check_writable, stderr

if TYPE_CHECKING:  # loads NumPy, which `--help` does without
    from ..jobs import Executor, Outcome


def executor_of(ray: str | None, workers: int | None) -> "Executor":
    """The cluster if one is named, else local processes: as many as asked, or one a core."""
    from ..jobs import LocalProcesses, RayCluster

    if ray is not None:
        return RayCluster(ray, workers)
    return LocalProcesses(workers or os.cpu_count() or 1)


def check_resume(resume: bool, store: Path | None) -> None:
    """Makes sure that there is something to go on with.

    Raises:
        BadParameter: If `--resume` names no store.
    """
    if resume and store is None:
        raise typer.BadParameter("needs --store, the file to go on with", param_hint="--resume")


@dataclass(frozen=True, slots=True)
class WorkerOptions:
    """Options of every command that works through many items, as they came: who does it, where it is kept, how it is told."""

    workers: Workers = None
    ray: Ray = None
    store: Store = None
    resume: Resume = False
    output: Output = None
    as_json: AsJson = False
    quiet: Quiet = False

    def check(self) -> None:
        """Make sure, before anything runs, that the output can be written and that there is something to go on with."""
        check_writable(self.output)
        check_resume(self.resume, self.store)

    @property
    def executor(self) -> "Executor":
        """Who is to do it."""
        return executor_of(self.ray, self.workers)

    def keeping(self, what: str) -> AbstractContextManager["Batch"]:
        """A batch of items, called so: see `keeping`."""
        return keeping(self.store, EndsLine(stderr(), what, quiet=self.quiet))


class EndsLine(LiveLine):
    """Tells of items as they end: all the time on a terminal, else each tenth of all."""

    def __init__(self, console: Console, what: str, *, quiet: bool) -> None:
        super().__init__(console, quiet=quiet, doing=f"working on {what}")
        self.what = what
        self.ended = self.total = 0

    def update(self, ended: int, total: int, outcome: "Outcome | None" = None) -> None:
        """Take note of one end."""
        if self.total == 0:
            self.begin_from((ended - 1) / total)
        self.ended, self.total = ended, total
        tenth = ended == total or ended * 10 // total > (ended - 1) * 10 // total
        self.show(f"{ended} of {total} {self.what}", ended / total, now=tenth)

    def follow(self, ended: int, total: int, outcome: "Outcome | None" = None) -> None:
        """Take note of one end in what follows from the batch."""
        self.show(f"{self.total} {self.what}; of what follows from them {ended} of {total}", ended / total)


@dataclass(frozen=True, slots=True)
class Batch:
    """Where the items of a batch are kept as they end, and what tells of them."""

    store: Path | None
    line: EndsLine


@contextmanager
def keeping(store: Path | None, line: EndsLine) -> Iterator[Batch]:
    """A batch that Ctrl-C ends without the loss of an item that has ended: it says where they are, and leaves with 130.

    Args:
        store: The file that was asked for; None: one of its own in the user's cache, which goes unless Ctrl-C ends the batch.
        line: What tells of the items.
    """
    own = None if store is not None else _unfinished(line.what)
    used = store or own
    stays = store is not None
    try:
        with line:
            yield Batch(used, line)
    except KeyboardInterrupt:
        answer()
        stays = stays or line.ended > 0
        stderr().print(_kept(line, used), soft_wrap=True)
        raise typer.Exit(130) from None
    finally:
        if own is not None and not stays:
            for each in own.parent.glob(f"{own.name}*"):  # SQLite's files lie beside it
                each.unlink(missing_ok=True)


def _kept(line: EndsLine, store: Path | None) -> str:
    if line.ended == 0:
        return f"interrupted before any of the {line.what} had ended"
    told = f"interrupted after {line.ended} of {line.total} {line.what}; "
    if store is None:
        return told + "they are not kept, for the cache cannot be written: --store FILE keeps them"
    return told + f"they are kept, and this goes on with them: --store {store} --resume"


def _unfinished(what: str) -> Path | None:
    """A new file of the user's cache; None where it cannot be written."""
    from ..kernel_cache import cache_problem, cache_root

    folder = cache_root() / "unfinished"
    if cache_problem() is not None:
        return None
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return None
    return folder / f"{what.split()[0]}-{time.strftime('%Y%m%d-%H%M%S')}-{os.getpid()}.db"
