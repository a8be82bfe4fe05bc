"""The exact planner beside plain breadth-first search: the same kernels, the same answers, the time of each."""

import time
from dataclasses import dataclass
from typing import Final

from ..planning.exact.explore import explore
from ..planning.problem.problems import pose_problem
from ..tasks import load_task
from .breadth import breadth_first
from .rows import NOTHING, Row, Say, keep_quiet

NO_HANGS: Final = "rules.max_hangs=0"
MOST_STANCES: Final = 12_000_000


@dataclass(frozen=True, slots=True)
class Case:
    """A task that is proved."""

    label: str
    task: str
    overrides: tuple[str, ...] = ()


CASES: Final = (
    Case("ladder, 3 in", "ladder"),
    Case("ladder, 1 in", "ladder", ("step.length=1in",)),
    Case("modified ladder, 1 in", "modified-ladder"),
    Case("h, 3 in, no sub-goals", "h", ("step.length=3in", "subgoals=[]")),
    Case("h, 1 in", "h"),
    Case("across, 1 in", "across"),
    Case("circle, 1 in", "circle"),
)


def bench_exact(*, cases: tuple[Case, ...] = CASES, say: Say = keep_quiet) -> list[Row]:
    """Optimum, stances and time of both searches on every case without hangs, and the ratio of the whole set's times."""
    _warm()
    rows: list[Row] = []
    plain_total = exact_total = 0.0
    for case in cases:
        say(case.label)
        task = load_task(case.task, (NO_HANGS, *case.overrides))
        problem = pose_problem(task, threads=1).problem
        started = time.perf_counter()
        plain = breadth_first(problem, most_stances=MOST_STANCES)
        plain_seconds = time.perf_counter() - started
        started = time.perf_counter()
        seen = explore(problem.informed(), most_stances=MOST_STANCES)
        exact_seconds = time.perf_counter() - started
        assert plain.complete and plain.length == (len(seen.codes) if seen.found else None), case.label
        plain_total, exact_total = plain_total + plain_seconds, exact_total + exact_seconds
        length = NOTHING if plain.length is None else plain.length
        rows += [
            Row(f"{case.label}: proved optimum", length, "actions"),
            Row(f"{case.label}: breadth-first search, {plain.stances} stances", plain_seconds, "s"),
            Row(f"{case.label}: exact planner with its bound made, {seen.stances} stances", exact_seconds, "s"),
        ]
    rows.append(Row("whole set: breadth-first search", plain_total, "s"))
    rows.append(Row("whole set: exact planner", exact_total, "s"))
    rows.append(
        Row("whole set: exact planner's part of breadth-first search", exact_total / plain_total, "1", "at most 0.1")
    )
    return rows


def _warm() -> None:
    """Load or compile both searches before the clock runs."""
    small = pose_problem(load_task("ladder", (NO_HANGS, "goal.y_min=12in")), threads=1).problem
    breadth_first(small, most_stances=10_000)
    explore(small.informed(), most_stances=10_000)
