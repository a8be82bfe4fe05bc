"""What would make an infeasible task feasible, at the end of `clamber plan`."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Annotated, Literal

from ...errors import SpecError, StartError
from ...json_form import INLINE
from ...openings.find import find_openings
from ...openings.result import Openings
from ...planning.result import PlanResult
from ...tasks import Task
from ..output import print_json, stderr, stdout
from .openings_text import print_openings
from .text import ProgressLine


@dataclass(frozen=True, slots=True)
class Planned:
    """A plan, or why there is none."""

    result: Annotated[PlanResult, INLINE]
    openings: Openings | None
    """What would open the task; None where there is a plan, or nothing was proved or looked for."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NoStart:
    """The task's start stance is refused; exit code 2."""

    status: Literal["no start"] = "no start"
    task: str
    reason: str
    openings: Openings
    """What would allow it."""


class Seeker:
    """Looks for openings where a planner proved that there is no plan, and tells them."""

    def __init__(self, task: Task, seconds: float | None, threads: int | None, as_json: bool, quiet: bool) -> None:
        """Bind a task; `seconds` None: nothing is looked for."""
        self._task, self._seconds, self._threads = task, seconds, threads
        self._as_json, self._quiet = as_json, quiet

    @contextmanager
    def told_of_start(self) -> Iterator[None]:
        """Within it, an error about the start stance comes with what would allow it."""
        try:
            yield
        except (StartError, SpecError) as error:
            if (found := self._find()) is not None:
                if self._as_json:
                    print_json(NoStart(task=self._task.name, reason=str(error), openings=found))
                else:
                    print_openings(stdout(), found)
            raise

    def with_openings(self, result: PlanResult) -> "Planned":
        """A planner's answer with the openings of an infeasible task."""
        return Planned(result, self._find() if result.status == "infeasible" else None)

    def print(self, result: PlanResult) -> None:
        """Print them, if no plan is proved."""
        if result.status == "infeasible" and (found := self._find()) is not None:
            print_openings(stdout(), found)

    def _find(self) -> Openings | None:
        if self._seconds is None:
            return None
        with ProgressLine(stderr(), quiet=self._quiet) as line:
            return find_openings(self._task, seconds=self._seconds, threads=self._threads, progress=line.update)
