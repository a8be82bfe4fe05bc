"""What would make an infeasible task feasible, at the end of `clamber plan`."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Annotated, Literal

from rich.console import Console

from ...errors import SpecError, StartError
from ...json_form import INLINE
from ...planning.infeasibility.find import InfeasibilityExplanation, Places, explain_infeasibility, shown
from ...planning.problem.verdict import ToRun
from ...planning.result import PlanResult
from ...tasks import Task
from ...terminal.output import print_json, stderr, stdout
from ...viewing.text_table import plain_table
from .options import PlanOptions
from .text import ProgressLine


@dataclass(frozen=True, slots=True)
class Planned:
    """A plan, or why there is none."""

    result: Annotated[PlanResult, INLINE]
    openings: InfeasibilityExplanation | None
    """What would open the task; None where there is a plan, or nothing was proved or looked for."""
    to_run: ToRun | None
    """None where there is no plan, or its robots have no contact dynamics."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NoStart:
    """The task's start stance is refused; exit code 2."""

    status: Literal["no start"] = "no start"
    task: str
    reason: str
    openings: InfeasibilityExplanation
    """What would allow it."""


class Seeker:
    """Looks for openings where a planner proved that there is no plan, and tells them."""

    def __init__(self, task: Task, words: PlanOptions, *, looks: bool) -> None:
        """Bind a task; unless it `looks`, nothing is looked for."""
        self._task, self._words, self._looks = task, words, looks

    @contextmanager
    def told_of_start(self) -> Iterator[None]:
        """Within it, an error about the start stance comes with what would allow it."""
        try:
            yield
        except (StartError, SpecError) as error:
            if (found := self._find()) is not None:
                if self._words.as_json:
                    print_json(NoStart(task=self._task.name, reason=str(error), openings=found))
                else:
                    print_openings(stdout(), found)
            raise

    def with_openings(self, result: PlanResult, to_run: ToRun | None) -> "Planned":
        """A planner's answer with the openings of an infeasible task, and whether its plan would be run."""
        return Planned(result, self._find() if result.status == "infeasible" else None, to_run)

    def print(self, result: PlanResult) -> None:
        """Print them, if no plan is proved."""
        if result.status == "infeasible" and (found := self._find()) is not None:
            print_openings(stdout(), found)

    def _find(self) -> InfeasibilityExplanation | None:
        if not self._looks:
            return None
        seconds, threads = self._words.openings_seconds, self._words.threads
        with ProgressLine(stderr(), quiet=self._words.quiet) as line:
            return explain_infeasibility(self._task, seconds=seconds, threads=threads, progress=line.update)


WHY = {"interrupted": "interrupted", "time": "out of time (--openings-seconds)"}


def print_openings(console: Console, found: InfeasibilityExplanation) -> None:
    """Print every kind of change that opens the task, the smallest of each, and what doesn't."""
    console.print()
    best = () if found.places is None else found.places.openings[:1]
    rows = (*found.openings, *best)
    if rows:
        console.print("any one of these changes makes it feasible:", style="bold green")
        right = ("actions",)
        table = plain_table("change", "from", "to", "not yet at", *right, right=right)
        for opening in rows:
            ends = (shown(value, opening.unit) for value in (opening.before, opening.after, opening.shut_at))
            length = f"{opening.length}" if opening.shortest else f"at most {opening.length}"
            table.add_row(opening.key, *ends, length if opening.least else f"{length} *")
        console.print(table)
    else:
        console.print("no single change that was tried makes it feasible", style="bold red")
    if any(not opening.least for opening in rows):
        console.print("*: values in between were not all settled, so less may be enough")
    if found.places is not None:
        _print_places(console, found.places)
    for proved, words in ((True, "proved infeasible even with"), (False, "not settled in the time")):
        texts = [shut.text for shut in found.shut if shut.proved == proved]
        if texts:
            console.print(f"{words}: {', '.join(texts)}")
    ended = f"; {WHY[found.ended]}" if found.ended else ""
    console.print(f"{found.searches} exact searches, {found.seconds:.1f} s{ended}")


def _print_places(console: Console, places: Places) -> None:
    spots = f"{len(places.openings)} of {places.tried} places" + (
        "" if places.complete else f" ({places.places} in all)"
    )
    console.print(
        f"one hold more: {spots} open it, on a lattice of {places.spacing * 1000:.4g} mm "
        "wherever a limb could ever grab" + ("; the best:" if places.openings else "")
    )
    if places.openings:
        console.print(f"  --set '{places.openings[0].overrides[0]}'", soft_wrap=True)
