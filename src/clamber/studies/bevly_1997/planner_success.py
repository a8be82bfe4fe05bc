"""Sections 2.5 and 2.6: the operators of section 2.2.3 find plans for every task; how surely, over many seeds."""

from collections.abc import Mapping
from statistics import median
from typing import Final

from ...benchmarks.planner_trials import run_trials
from ...planning.genetic.profile import load_profile
from ..result import Compared, StudyResult, Table, Value, Verdict
from . import PAPER
from .replayed import INFERRED, limbed_task

SEEDS: Final = range(100, 120)
"""Not looked at before the verdict's rule was made: that of 0 to 19 was known."""
BUDGET: Final = 500_000
"""Most plans that one seed evaluates."""
OWN_PLANS: Final = ("ladder", "modified-ladder", "h")
"""Tasks of which the thesis shows plans of its planner (2.5.1 to 2.5.3); for the others it prints plans made by hand."""
TASKS: Final = (*OWN_PLANS, "across", "circle")


def judge_planner(found: Mapping[str, int], seeds: int) -> Verdict:
    """Holds if more than half of all seeds find a plan on every task, open if so on those of `OWN_PLANS` alone, else differs.

    Args:
        found: Task -> seeds that found a plan.
        seeds: How many there were.
    """
    solved = {name for name, count in found.items() if 2 * count > seeds}
    if not solved.issuperset(set(found) & set(OWN_PLANS)):
        return "differs"
    return "holds" if solved == set(found) else "open"


def count_successes() -> StudyResult:
    """Seeds of the profile "thesis" that find a plan, on every task."""
    profile = load_profile("thesis")
    rows: list[tuple[Value, ...]] = []
    found: dict[str, int] = {}
    for name in TASKS:
        trials = run_trials(limbed_task(name), profile, SEEDS, max_evaluations=BUDGET)
        evaluations = [value for value in trials.evaluations if value is not None]
        lengths = [value for value in trials.first_lengths if value is not None]
        middle = (median(evaluations), max(evaluations), median(lengths)) if evaluations else (None, None, None)
        found[name] = trials.found
        rows.append((name, trials.found, len(SEEDS), *middle))
    return StudyResult(
        paper=PAPER,
        result="planner-success",
        claim="Sections 2.5 and 2.6: with tail crossover, 5 % mutation and a replacement factor of 0.8 the planner solves the tasks.",
        verdict=judge_planner(found, len(SEEDS)),
        compared=tuple(Compared(f"{row[0]}: seeds that find a plan, of {row[2]}", row[1]) for row in rows)
        + tuple(Compared(f"{row[0]}: evaluations to the first plan, median", row[3]) for row in rows)
        + tuple(Compared(f"{row[0]}: actions of the first plan, median", row[5]) for row in rows),
        deviations=(
            *INFERRED,
            "Population (1000), weights, spread of cut points (3 genes) and length of the first plans (20) are not printed: they are ours.",
            f"Budget {BUDGET} evaluated plans a seed; how many the thesis needed is not printed.",
            "Sub-goals are boxes, and hangs are allowed, as in the printed plans.",
            "The thesis shows plans of its planner for the ladder, the modified ladder and H; across and circle are printed as hand-made "
            "plans.",
            "Section 2.6 says that the planner is able to produce plans, not how often. The verdict is holds if on every task more than "
            "half of the seeds find a plan, so that one search is likelier than not to; open if so on the three tasks of the thesis's "
            "own planner alone; differs if not on these. Until 23 November 2026 one seed a task was enough; the rule was made sharper "
            "when seeds 0 to 19 were known, and is judged on others.",
        ),
        seeds=SEEDS,
        table=Table(
            ("task", "found", "seeds", "evaluations, median", "evaluations, most", "actions, median"), tuple(rows)
        ),
    )
