"""What measurements of every family share: rows of figures, work that is timed in turn, and who runs many trials."""

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from ..errors import StatedError
from ..jobs import Executor, map_items
from ..jobs.batch import Progress
from ..json_form import Jsonable, OrNull
from ..types import Floats, Json

NOTHING = math.nan
"""The value of a row that could not be measured, or of a time until something that did not happen."""


@dataclass(frozen=True, slots=True)
class Row(Jsonable):
    """One measurement."""

    name: str
    value: OrNull
    """NaN where there is none."""
    unit: str
    aim: str | None = None
    """What it should be, in words."""


Say = Callable[[str], None]
"""Told, in a few words, what is being measured."""


def keep_quiet(_: str) -> None:
    """For those who want to hear nothing on the way."""


def median_or_nothing(values: Sequence[float | None]) -> float:
    """The median where None counts as larger than anything; `NOTHING` if the median itself is such a one."""
    middle = median([math.inf if value is None else value for value in values]) if values else math.inf
    return middle if math.isfinite(middle) else NOTHING


def round_times(
    works: Sequence[Callable[[], Any]], rounds: int, clock: Callable[[], float] = time.thread_time
) -> Floats:
    """Time of each piece of work in each round [s], shape (rounds, works); they take turns, so that a busy machine hits all alike.

    The clock is this thread's share of a core, which does not run while others have the core; work on many threads needs another.
    """
    times = np.empty((rounds, len(works)))
    for work in works:
        work()
    for row in times:
        for i, work in enumerate(works):
            start = clock()
            work()
            row[i] = clock() - start
    return times


class TrialError(StatedError):
    """A trial ended without an answer."""

    says = "a trial failed: {problem}"
    problem: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Crew:
    """Who runs many trials, and where their results are kept."""

    executor: Executor
    store: Path | None = None
    resume: bool = False
    progress: Progress | None = None

    def answers(self, work: Callable[[Json], Json], items: Sequence[Json], about: Json, title: str) -> list[Json]:
        """What every item's work answers, in order.

        Raises:
            StoreError: If the file can't be the store of these items.
            ClusterError: If there is no cluster to run on, or it is lost.
            TrialError: If a work raised, or its workers died.
        """
        told: list[Json] = []
        for outcome in map_items(
            work,
            items,
            executor=self.executor,
            store=self.store,
            about=about,
            title=title,
            resume=self.resume,
            progress=self.progress,
        ):
            if outcome.result is None:
                raise TrialError(outcome.error or "")
            told.append(outcome.result)
        return told
