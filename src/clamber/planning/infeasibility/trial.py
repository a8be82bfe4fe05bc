"""Settle by exact search whether a changed task is feasible, within shares of one budget of time."""

import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from ...errors import SpecError, StartError
from ...tasks import Task
from ...tasks.library import change_task
from ...types import Ints
from ..exact.costs import Aim
from ..exact.explore import Exploration, explore, inform
from ..problem.problem import CompiledProblem
from ..problem.problems import pose_problem

SMALL = 4_000
"""Stances up to which a search without a table of the relaxed problem is tried first: it is done before the table is."""


@dataclass(frozen=True, slots=True)
class Answer:
    """Whether a changed task is feasible."""

    status: Literal["open", "shut", "unsettled"]
    codes: Ints = field(default_factory=lambda: np.zeros(0, np.int32))
    """The plan; without one, the way to the furthest stance."""
    shortest: bool = False
    """Whether the plan is proved to be the shortest."""
    problem: CompiledProblem | None = None
    """What the plan belongs to; None where the start itself is forbidden."""


class Trial:
    """Asks the exact planner about changes of one task; every answer but "unsettled" is a proof."""

    def __init__(
        self,
        task: Task,
        *,
        max_stances: int,
        seconds: float | None,
        tell: Callable[[int], None] | None = None,
    ) -> None:
        """Start the clock.

        Args:
            task: The task that is infeasible as it is.
            max_stances: Most stances that one search keeps.
            seconds: Most time for all searches [s]; None for any.
            tell: Called now and then with the number of searches begun.
        """
        self.task = task
        self.max_stances = max_stances
        self.searches = 0
        self._tell = tell
        self.stopped = threading.Event()
        """Set, it ends the searches of all threads."""
        self._ends = None if seconds is None else time.monotonic() + seconds
        self._until = self._ends
        self._lock = threading.Lock()  # places are tried in threads

    def left(self) -> float | None:
        """Time left [s]; None: any."""
        return None if self._ends is None else max(0.0, self._ends - time.monotonic())

    def grant(self, share: float) -> None:
        """Let what follows take at most this share of the time left."""
        if self._ends is not None:
            now = time.monotonic()
            self._until = now + share * max(0.0, self._ends - now)

    def granted(self) -> float | None:
        """What is left of the share [s]; None: any."""
        return None if self._until is None else max(0.0, self._until - time.monotonic())

    def settle(self, overrides: Sequence[str], crew: int = 1) -> Answer:
        """Whether the task is feasible with some overrides; `crew` threads that ask at once share the memory.

        Raises:
            KeyboardInterrupt: If the search is interrupted.
        """
        if self.granted() == 0.0:
            return Answer("unsettled")
        self._count()
        task = change_task(self.task, overrides)
        try:
            problem = pose_problem(task, threads=1).problem
        except (StartError, SpecError):  # the changed task was built, so what fails is its start stance
            return Answer("shut")
        seen = self.search(problem, Aim(), SMALL)
        if not (seen.found or seen.exhausted):
            seen = self.search(inform(problem, self.granted())[0], Aim(), self.max_stances // crew)
        status: Literal["open", "shut", "unsettled"] = (
            "open" if seen.ways else "shut" if seen.exhausted else "unsettled"
        )
        return Answer(status, seen.codes, seen.found, problem)

    def search(self, problem: CompiledProblem, aim: Aim, most: int) -> Exploration:
        """One exact search within the granted time, that keeps `most` stances at most.

        Raises:
            KeyboardInterrupt: If it is interrupted.
        """

        def tell(_stances: int, _bound: float) -> None:
            self._count(0)
            if self.stopped.is_set():
                raise KeyboardInterrupt

        seen = explore(
            problem,
            most_stances=min(most, self.max_stances),
            seconds=self.granted(),
            tell=tell,
            aim=aim,
        )
        if seen.interrupted:
            raise KeyboardInterrupt
        return seen

    def _count(self, more: int = 1) -> None:
        with self._lock:
            self.searches += more
            if self._tell is not None:
                self._tell(self.searches)
