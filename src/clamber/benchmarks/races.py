"""Our planner beside the genetic algorithms of other libraries: plans per second, and time until the first plan."""

import importlib.util
from collections.abc import Iterable
from dataclasses import dataclass
from statistics import median
from typing import Any, Final

from ..planning.problem.problem import CompiledProblem
from ..planning.problem.problems import pose_problem
from ..tasks import load_task
from .peers import OPTIONAL, PEERS, Race, race
from .plain_problem import PlainProblem, plain_module
from .rows import NOTHING, Row, Say, keep_quiet, median_or_nothing

SEEDS: Final = (0, 1, 2)
SECONDS: Final = 4.0
"""Most time of one search [s]."""
PLAIN_SECONDS: Final = 4.0
PLAIN_TASK: Final = "ladder"


@dataclass(frozen=True, slots=True)
class Course:
    """A task to race on."""

    task: str
    label: str
    length: int
    """Genes per plan for libraries whose plans all have the same length: half as many again as our first plans need."""


COURSES: Final = (
    Course("ladder", "ladder, 3 in", 80),
    Course("modified-ladder", "modified-ladder", 150),
    Course("h", "h", 200),
)


def installed(peer: str) -> bool:
    """Whether a library is there."""
    return peer not in OPTIONAL or importlib.util.find_spec(OPTIONAL[peer]) is not None


def race_rows(
    *,
    courses: Iterable[Course] = COURSES,
    seeds: tuple[int, ...] = SEEDS,
    seconds: float = SECONDS,
    plain_seconds: float = PLAIN_SECONDS,
    say: Say = keep_quiet,
) -> list[Row]:
    """Every library on every course, with our compiled evaluator on one core, then once each with the plain one."""
    rows = []
    for course in courses:
        problem = pose_problem(load_task(course.task), threads=1).problem
        runs: dict[str, list[Race]] = {peer: [] for peer in PEERS}
        for seed in seeds:  # libraries take turns
            for peer in PEERS:
                if installed(peer):
                    say(f"{peer} on {course.label}, seed {seed}")
                    runs[peer].append(race(peer, problem, seed, seconds=seconds, length=course.length))
        for peer, done in runs.items():
            rows += _rows(f"{course.label}, {peer}, compiled evaluator, one core", done, len(seeds), seconds)
    return rows + _plain_rows(plain_seconds, say)


def _rows(name: str, runs: list[Race], seeds: int, seconds: float) -> list[Row]:
    if not runs:
        return [Row(f"{name} (not installed: pip install 'clamber[bench]')", NOTHING, "plans/s")]
    found = sum(run.success is not None for run in runs)
    return [
        Row(f"{name}: plans per second, median of {seeds} seeds", median(run.rate for run in runs), "plans/s"),
        Row(f"{name}: seeds of {seeds} with a plan within {seconds:g} s", found, "seeds"),
        Row(
            f"{name}: time to the first plan, median of {seeds} seeds",
            median_or_nothing([run.success for run in runs]),
            "s",
        ),
    ]


def _plain_rows(seconds: float, say: Say) -> list[Row]:
    module = plain_module()
    if module is None:
        return [Row(f"{PLAIN_TASK}, plain evaluator (needs a checkout: it lies in the tests)", NOTHING, "plans/s")]
    course = next(course for course in COURSES if course.task == PLAIN_TASK)
    task: Any = load_task(course.task)
    problem: CompiledProblem = PlainProblem(task, pose_problem(task, threads=1).problem.actions, module)
    rows = []
    for peer in PEERS:
        if not installed(peer):
            continue
        say(f"{peer} on {course.label} with the plain evaluator")
        run = race(peer, problem, 0, seconds=seconds, length=course.length)
        name = f"{course.label}, {peer}, plain evaluator"
        rows.append(Row(f"{name}: plans per second, one seed", run.rate, "plans/s"))
        rows.append(
            Row(f"{name}: time to the first plan", NOTHING, f"s (none within {seconds:g} s)")
            if run.success is None
            else Row(f"{name}: time to the first plan, one seed", run.success, "s")
        )
    return rows
