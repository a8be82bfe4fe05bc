"""Who runs the items of a command: local processes, or a Ray cluster."""

import os
from pathlib import Path
from typing import TYPE_CHECKING

import typer
from rich.console import Console

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
