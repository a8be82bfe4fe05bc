"""Who runs the items of a command, local processes or a Ray cluster, and the options of commands that have many."""

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import typer
from rich.console import Console

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

    def line(self, what: str) -> "EndsLine":
        """What tells of items, called so, as they end."""
        return EndsLine(stderr(), what, quiet=self.quiet)


class EndsLine:
    """Tells of items as they end, each tenth of all."""

    def __init__(self, console: Console, what: str, *, quiet: bool) -> None:
        self._console = console
        self._what = what
        self._quiet = quiet

    def update(self, ended: int, total: int, outcome: "Outcome | None" = None) -> None:
        """Take note of one end."""
        if not self._quiet and (ended == total or ended * 10 // total > (ended - 1) * 10 // total):
            self._console.print(f"{ended} of {total} {self._what}", style="dim")
