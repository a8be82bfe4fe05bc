"""Many seeds of the genetic planner on one task, and what came of them."""

import os
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path

from ..errors import ClamberError
from ..files import Document
from ..jobs import Executor, LocalProcesses, map_items
from ..jobs.batch import Progress
from ..planning.genetic.learning import Macro
from ..planning.genetic.planner import plan_genetic
from ..planning.genetic.profile import Profile
from ..specs import build_spec
from ..tasks import Task, task_from_document
from ..types import Json
from .rows import Row, median_or_nothing

EVALUATIONS = 50_000
"""Budget of one trial, polishing included."""


@dataclass(frozen=True, slots=True)
class Trials:
    """One entry per seed; None where the budget ran out before a plan was found."""

    evaluations: tuple[int | None, ...]
    """Whole plans evaluated up to the first plan that reaches the goal."""
    first_lengths: tuple[int | None, ...]
    """Actions of that plan."""
    lengths: tuple[int | None, ...]
    """Actions of the plan after polishing."""

    @property
    def found(self) -> int:
        """How many seeds found a plan."""
        return sum(length is not None for length in self.lengths)

    def rows(self, name: str, aim: str | None = None) -> list[Row]:
        """As rows whose names start with `name`."""
        n = len(self.lengths)
        return [
            Row(f"{name}: success of {n} seeds within {EVALUATIONS} evaluations", self.found, "seeds", aim),
            Row(f"{name}: evaluations to success, median", median_or_nothing(self.evaluations), "evaluations"),
            Row(f"{name}: first plan, median length", median_or_nothing(self.first_lengths), "actions"),
            Row(f"{name}: final plan, median length", median_or_nothing(self.lengths), "actions"),
        ]


@dataclass(frozen=True, slots=True, kw_only=True)
class Crew:
    """Who runs many trials, and where their results are kept."""

    executor: Executor
    store: Path | None = None
    resume: bool = False
    progress: Progress | None = None


def run_cases(
    cases: Mapping[str, tuple[Task, Profile]], seeds: Iterable[int], crew: Crew | None = None
) -> dict[str, Trials]:
    """Plan every case with every seed, all of them one batch.

    Args:
        cases: Label -> task and profile.
        seeds: The same for every case.
        crew: Who runs them; None: local processes, one a core.

    Raises:
        StoreError: If the crew's file can't be the store of these trials.
        ClusterError: If there is no cluster to run on, or it is lost.
        TrialError: If a trial raised, or its workers died.
    """
    crew = crew or Crew(executor=LocalProcesses(os.cpu_count() or 1))
    chosen = tuple(seeds)
    items: list[Json] = [
        {"document": task.document, "profile": asdict(profile), "seed": seed}
        for task, profile in cases.values()
        for seed in chosen
    ]
    outcomes = map_items(
        run_trial,
        items,
        executor=crew.executor,
        store=crew.store,
        about={"items": items, "evaluations": EVALUATIONS},
        title=f"{len(chosen)} seeds each of {', '.join(list(cases)[:3])} ... ({len(cases)} cases)",
        resume=crew.resume,
        progress=crew.progress,
    )
    told = []
    for outcome in outcomes:
        if outcome.result is None:
            raise TrialError(outcome.error or "")
        told.append(tuple(outcome.result["told"]))
    rows = [told[k : k + len(chosen)] for k in range(0, len(told), len(chosen))]
    return {label: Trials(*zip(*row, strict=True)) for label, row in zip(cases, rows, strict=True)}


class TrialError(ClamberError):
    """A trial ended without an answer."""

    def __init__(self, problem: str) -> None:
        super().__init__(problem)
        self.problem = problem

    def __str__(self) -> str:
        return f"a trial failed: {self.problem}"


def run_trial(item: Json) -> Json:
    """One seed of one case; runs in a worker.

    Args:
        item: `document` of the task, `profile` as plain data, `seed`.

    Returns:
        `told`: the three entries of `Trials`.
    """
    profile = build_spec(Profile, Document("profile", item["profile"]))
    result = plan_genetic(
        task_from_document(item["document"]),
        seed=item["seed"],
        profile=profile,
        max_evaluations=EVALUATIONS,
        threads=1,
    )
    if result.status != "found":
        return {"told": [None, None, None]}
    return {"told": [result.first_evaluations, result.first_length, result.length]}


def run_trials(
    task: Task,
    profile: Profile,
    seeds: Iterable[int],
    *,
    max_evaluations: int = EVALUATIONS,
    filters: bool = True,
    macros: Sequence[Macro] = (),
) -> Trials:
    """Plan a task with each seed, one thread per plan and as many plans at once as there are cores."""

    def trial(seed: int) -> tuple[int | None, int | None, int | None]:
        result = plan_genetic(
            task,
            seed=seed,
            profile=profile,
            max_evaluations=max_evaluations,
            threads=1,
            filters=filters,
            macros=macros,
        )
        if result.status != "found":
            return None, None, None
        return result.first_evaluations, result.first_length, result.length

    with ThreadPoolExecutor(os.cpu_count() or 1, thread_name_prefix="trial") as pool:
        told = list(pool.map(trial, seeds))
    evaluations, first_lengths, lengths = zip(*told, strict=True)
    return Trials(evaluations, first_lengths, lengths)
