"""Every planner on every board of the set, within one allowance: the boards, the trials, and what is true of each board."""

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any, Final

from ..errors import ClamberError
from ..families.climber.planning.random_task import random_task
from ..jobs import LocalProcesses, Outcome, map_items, read_result
from ..planning.genetic.profile import profile_names
from ..planning.planners import PLANNERS, accepts, find_planner
from ..tasks import load_task, task_from_document
from ..trials.measured import Crew
from ..types import Json

NO_HANGS: Final = ("rules.max_hangs=0",)
"""With any number of hangs the reachable space doesn't close, and nothing could be proved."""
THESIS: Final = ("ladder", "modified-ladder", "h", "across", "circle")
SIZES: Final = (10, 20, 40, 80)
"""Holds of a random board."""
DENSITIES: Final = (6.0, 8.0, 10.0, 16.0)
"""Holds per square metre. LIBRA climbs hardly anything at 6 and nearly everything at 16."""
PATTERN: Final = (0, 1, 1, 1, 2, 2, 2, 3, 3, 0)
"""Density of each seed's board, by index: more boards where it is open whether there is a way."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """One board, and what is to be done on it."""

    name: str
    size: str
    """"thesis", or the number of holds."""
    density: str
    """"thesis", or holds per square metre."""
    document: Json
    """The whole task."""


def thesis_case(name: str) -> Case:
    """A board of the thesis, by the name of its task; steps as in the task."""
    return Case(name=name, size="thesis", density="thesis", document=load_task(name, NO_HANGS).document)


def random_case(holds: int, seed: int) -> Case:
    """A random board: from the lowest stance that the rules allow to the top, in steps of 3 in and 15 deg."""
    density = DENSITIES[PATTERN[seed % len(PATTERN)]]
    name = f"random-{holds}-{density:g}-{seed}"
    task = random_task(holds, density, seed, name=name, overrides=NO_HANGS)
    return Case(name=name, size=str(holds), density=f"{density:g}", document=task.document)


def all_cases() -> tuple[Case, ...]:
    """All cases, the same everywhere."""
    made = [random_case(holds, seed) for holds in SIZES for seed in range(len(PATTERN))]
    return (*(thesis_case(name) for name in THESIS), *made)


SEEDLESS: Final = ("exact", "greedy", "route")
"""Planners that draw nothing at random: one seed tells all."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Allowance:
    """What one search may spend."""

    checks: int
    """Single actions judged: the same on any machine."""
    seconds: float
    """In their place, for a planner that can't stop at a number of checks [s]."""
    patience: float
    """No search takes longer than this [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Contender:
    """A planner with its settings, as a comparison names it."""

    name: str
    """Such as "exact" or "genetic/thesis"."""
    planner: str
    options: Json = field(default_factory=dict)

    @property
    def draws(self) -> bool:
        """Whether another seed may give another answer."""
        return self.planner not in SEEDLESS

    @property
    def counts(self) -> bool:
        """Whether its searches end, or can be cut in hindsight, at a number of checks.

        An exact search does the same whatever its limits, so what it judged tells whether an allowance would have sufficed.
        """
        return accepts(self.planner, "max_checks") or self.planner == "exact"

    def limits(self, allowance: Allowance) -> Json:
        """An allowance in the planner's own options; limits of its own in other units are lifted."""
        counted = accepts(self.planner, "max_checks")
        options: Json = {"seconds": allowance.patience if self.counts else allowance.seconds}
        if counted:
            options["max_checks"] = allowance.checks
        if counted and accepts(self.planner, "max_evaluations"):
            options["max_evaluations"] = 1_000_000_000
        return options


def contenders() -> tuple[Contender, ...]:
    """Every planner, the genetic one with each of its profiles."""
    found: list[Contender] = []
    for planner in PLANNERS:
        if planner == "genetic":
            profiles = profile_names()
            found += [Contender(name=f"{planner}/{p}", planner=planner, options={"profile": p}) for p in profiles]
        else:
            found.append(Contender(name=planner, planner=planner))
    return tuple(found)


def run_trial(item: Json) -> Json:
    """Plan once, and check the plan.

    Args:
        item: `document` of the task, `planner`, `options`.

    Returns:
        What the planner answered: `status`, `reason`, `length` (None without a plan that holds up to the goal), `first_length`,
        `cost` (actions judged up to the first plan, or in all), `checks`, `seconds`, `lower_bound`.
    """
    load_machine_code(item["planner"])
    task = task_from_document(item["document"])
    try:
        result = find_planner(item["planner"])(task, threads=1, **item["options"])
    except ClamberError as error:
        return {
            "status": "refused",
            "reason": str(error),
            "length": None,
            "first_length": None,
            "cost": 0,
            "checks": 0,
            "seconds": 0.0,
            "lower_bound": None,
        }
    planned = result.status in ("found", "optimal")
    if planned:
        verdict = result.check()
        assert verdict.ok and verdict.reached, f"{item['planner']} gave a plan that does not hold on {task.name}"
    first = result.first_checks
    return {
        "status": result.status,
        "reason": result.reason,
        "length": result.length if planned else None,
        "first_length": result.first_length if planned else None,
        "cost": first if planned and first is not None else result.checks,
        "checks": result.checks,
        "seconds": result.seconds,
        "lower_bound": result.lower_bound,
    }


@cache
def load_machine_code(planner: str) -> None:
    """Plan something tiny, once a process, so that no trial's time counts what loading the kernels takes, or compiling them."""
    tiny = load_task("ladder", (*NO_HANGS, "goal.y_min=12in"))
    limits = Contender(name=planner, planner=planner).limits(Allowance(checks=2000, seconds=0.1, patience=1.0))
    find_planner(planner)(tiny, threads=1, **limits)


ALLOWANCE: Final = Allowance(checks=2_000_000, seconds=2.0, patience=120.0)
"""Of a trial. A core judges a million actions in half a second to a second."""
SEEDS: Final = (0, 1, 2)
"""Of planners that draw at random."""
REFERENCE: Final = "exact"
"""Whose proofs the others are measured by."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Trial:
    """How one trial ended."""

    case: str
    contender: str
    seed: int
    status: str
    """A planner's status, "refused" where it can't take the task, or "failed"."""
    reason: str
    length: int | None = None
    """Actions of the plan, checked; None without one."""
    first_length: int | None = None
    """Actions of the first plan found."""
    cost: int = 0
    """Actions judged up to the first plan; in all, where there is none or the planner doesn't tell."""
    checks: int = 0
    """Actions judged in all."""
    seconds: float = 0.0
    lower_bound: int | None = None
    """Proved: no plan has fewer actions."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Truth:
    """What is proved of a board."""

    feasible: bool | None
    """None: nobody knows."""
    shortest: int | None
    """The optimum, or the best bound below it; None if there is no plan."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Contest:
    """All trials."""

    cases: tuple[Case, ...]
    contenders: tuple[Contender, ...]
    allowance: Allowance
    trials: tuple[Trial, ...]

    def of(self, contender: str) -> list[Trial]:
        """One planner's trials."""
        return [trial for trial in self.trials if trial.contender == contender]

    def truths(self) -> dict[str, Truth]:
        """What the exact planner proved of each board, and that a board with a checked plan has one."""
        told: dict[str, Truth] = {}
        for case in self.cases:
            here = [trial for trial in self.trials if trial.case == case.name]
            proof = next((trial for trial in here if trial.contender == REFERENCE), None)
            solved = any(trial.length is not None for trial in here)
            if proof is not None and proof.status == "infeasible":
                told[case.name] = Truth(feasible=False, shortest=None)
            else:
                bound = None if proof is None else proof.length if proof.status == "optimal" else proof.lower_bound
                told[case.name] = Truth(feasible=True if solved else None, shortest=bound)
        return told


def run_contest(
    *,
    cases: Sequence[Case] | None = None,
    entrants: Sequence[Contender] | None = None,
    seeds: Sequence[int] = SEEDS,
    allowance: Allowance = ALLOWANCE,
    crew: Crew | None = None,
) -> Contest:
    """Let every planner try every board, each trial on one thread.

    Args:
        cases: The boards; None takes the whole set.
        entrants: The planners; None takes all.
        seeds: For planners that draw at random; the others run once.
        allowance: What a trial may spend.
        crew: Who runs the trials, and where they are kept; None: local processes, one a core. Only the seconds depend on it.

    Raises:
        StoreError: If the crew's file can't be the store of this contest.
        ClusterError: If there is no cluster to run on, or it is lost.
    """
    boards = tuple(all_cases() if cases is None else cases)
    field = tuple(contenders() if entrants is None else entrants)
    plays = [
        (case, contender, seed)
        for case in boards
        for contender in field
        for seed in (seeds if contender.draws else seeds[:1])
    ]
    items: list[Json] = [
        {
            "document": case.document,
            "planner": contender.planner,
            "options": {"seed": seed, **contender.options, **contender.limits(allowance)},
        }
        for case, contender, seed in plays
    ]
    crew = crew or Crew(executor=LocalProcesses(os.cpu_count() or 1))
    if crew.executor.here:
        for planner in {contender.planner for contender in field}:
            load_machine_code(planner)  # compiles here, once, and not in every worker at the same time
    outcomes = map_items(
        run_trial,
        items,
        executor=crew.executor,
        store=crew.store,
        about={"items": items},
        title="the benchmark 'boards'",
        resume=crew.resume,
        progress=crew.progress,
    )
    trials = tuple(
        _trial(case.name, contender.name, seed, outcome, crew.store)
        for (case, contender, seed), outcome in zip(plays, outcomes, strict=True)
    )
    return Contest(cases=boards, contenders=field, allowance=allowance, trials=trials)


def _trial(case: str, contender: str, seed: int, outcome: Outcome, store: Path | None) -> Trial:
    told: dict[str, Any] = outcome.result or {"status": "failed", "reason": outcome.error or ""}
    return read_result(Trial, told | {"case": case, "contender": contender, "seed": seed}, store)
