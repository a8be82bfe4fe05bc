"""Many seeds of the genetic planner on one task, and what came of them."""

import os
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

from ..planning.genetic.learning import Macro
from ..planning.genetic.planner import plan_genetic
from ..planning.genetic.profile import Profile
from ..tasks import Task
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
