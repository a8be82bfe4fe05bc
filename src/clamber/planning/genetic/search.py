"""One genetic search from its first generation to a polished plan, that can be stopped, resumed and watched."""

import json
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from ...actions.problem import ROLLOUT, CompiledProblem
from ...errors import FileError
from ...files import write_atomically
from ..progress import Listener
from .evolve import (
    Evolution,
    Generation,
    Genes,
    Population,
    first_generation,
    next_generation,
    out_of_time,
    tell,
)
from .learning import Macro, learn_while_searching
from .polish import BATCH, PATIENCE, explicit_problem, polish, spell_to_goal
from .profile import Profile

CHECKPOINT_SCHEMA: Final = "clamber-checkpoint-1"
CHECKPOINT_EVERY: Final = 2.0
"""Seconds between checkpoints."""
LEARN_EVERY: Final = 10
"""Generations between looks for a repeated sequence."""


@dataclass(frozen=True, slots=True)
class Budget:
    """When a search stops."""

    evaluations: int
    """Most plans to evaluate, polishing included; the first generation is always evaluated."""
    seconds: float | None = None
    """Most wall-clock time [s]; a search that it ends is not repeatable."""
    checks: int | None = None
    """Most single actions to judge; a generation that has begun is finished."""

    def allows(self, state: Evolution, more: int, started: float) -> bool:
        """Whether so many more plans may be evaluated in a search that began at `started` (monotonic clock)."""
        judged = self.checks is not None and state.checks >= self.checks
        return state.evaluations + more <= self.evaluations and not judged and not out_of_time(started, self.seconds)


@dataclass(frozen=True, slots=True)
class Outcome:
    """What a search came to: codes (holds resolved) of the best plan, and how it got there."""

    codes: Genes
    found: bool
    interrupted: bool
    first_length: int | None
    """Actions of the first plan that reached the goal, before polishing."""
    first_evaluations: int | None
    """Plans evaluated up to it."""
    first_checks: int | None
    """Single actions judged up to it."""
    evaluations: int
    checks: int
    history: tuple[Generation, ...]
    macros: tuple[Macro, ...]
    names: tuple[str, ...]
    """What the inventory called each gene of the plan; empty after polishing, which names holds instead."""


@dataclass(slots=True)
class _Run:
    """Everything that a checkpoint keeps."""

    state: Evolution
    macros: list[Macro]
    turn: int = 0
    stale: int = 0
    polished: Genes | None = None
    first_length: int | None = None
    first_evaluations: int | None = None
    first_checks: int | None = None


def search(
    problem: CompiledProblem,
    profile: Profile,
    *,
    seed: int,
    budget: Budget,
    stages: int,
    listener: Listener | None = None,
    checkpoint: Path | None = None,
    identity: str = "",
    seeds: Sequence[Genes] = (),
) -> Outcome:
    """Search for a plan, then make it shorter.

    Args:
        problem: What to plan.
        profile: The planner's settings.
        seed: Same seed, same plan, on any number of threads.
        budget: When to stop.
        stages: Goals of the task, for the listener.
        listener: Called after every generation.
        checkpoint: File that the search is saved to, and resumed from if it is there.
        identity: Names task, profile, inventory and seeds; a checkpoint of another one is refused.
        seeds: Genes of plans, or beginnings of plans, that the first generation holds.

    Returns:
        The outcome; Ctrl-C ends the search with the best so far.

    Raises:
        FileError: If the checkpoint belongs to another search or is damaged.
    """
    started = time.monotonic()
    identity = f"{identity}/seed {seed}/profile {json.dumps(asdict(profile), sort_keys=True, default=str)}"
    keeper = _Keeper(checkpoint, identity)
    interrupted = False
    run = keeper.load(problem)
    base = problem
    if run is None:
        run = _Run(first_generation(problem, profile, seed, seeds), [])
    else:
        problem = _with_macros(base, run.macros)
    try:
        tell(listener, problem, run.state, stages)
        while not run.state.found and budget.allows(run.state, profile.search.population, started):
            if (
                profile.search.learned_macros
                and run.state.generation % LEARN_EVERY == LEARN_EVERY - 1
                and not run.macros
            ):
                run.macros = learn_while_searching(problem, run.state)
                if run.macros:
                    problem = _with_macros(base, run.macros)
                    run.state.population.follow = np.full(
                        (len(run.state.population.genes), 1 + len(problem.actions)), -1, np.int32
                    )
            next_generation(problem, profile, run.state, seed)
            keeper.save(run)
            tell(listener, problem, run.state, stages)
        _polish(problem, profile, run, seed, budget, started, keeper, listener, stages)
    except KeyboardInterrupt:
        interrupted = True
    _note_success(run)
    keeper.save(run, now=True)
    return _outcome(problem, run, interrupted)


def _note_success(run: _Run) -> None:
    if run.state.found and run.first_length is None:
        run.first_length, run.first_evaluations = run.state.best_actions, run.state.evaluations
        run.first_checks = run.state.checks


def _polish(
    problem: CompiledProblem,
    profile: Profile,
    run: _Run,
    seed: int,
    budget: Budget,
    started: float,
    keeper: "_Keeper",
    listener: Listener | None,
    stages: int,
) -> None:
    state = run.state
    if not state.found:
        return
    _note_success(run)
    most = min(budget.evaluations, run.first_evaluations + profile.search.polish if run.first_evaluations else 0)
    named, start = explicit_problem(problem, state.best)
    genes = start if run.polished is None else _entries(named, run.polished)
    while state.evaluations + BATCH <= most and run.stale < PATIENCE and budget.allows(state, BATCH, started):
        genes, shorter = polish(named, profile, state, genes, seed, run.turn)
        run.polished = named.actions.spell(genes)
        run.turn += 1
        run.stale = 0 if shorter else run.stale + 1
        state.best_actions = len(genes)
        keeper.save(run)
        tell(listener, problem, state, stages)


def _entries(problem: CompiledProblem, codes: Genes) -> Genes:
    """Table entries of single codes."""
    index = {int(code): i for i, code in enumerate(problem.actions.codes)}
    return np.array([index[int(code)] for code in codes], np.int32)


def _with_macros(problem: CompiledProblem, macros: list[Macro]) -> CompiledProblem:
    return problem.rebind(problem.actions.extended([(macro.name, macro.codes, False) for macro in macros]))


def _outcome(problem: CompiledProblem, run: _Run, interrupted: bool) -> Outcome:
    state = run.state
    names: tuple[str, ...] = ()
    codes = spell_to_goal(problem, state.best) if run.polished is None else run.polished
    if run.polished is None:
        names = tuple(
            problem.actions.names[g]
            for g in state.best
            for _ in range(problem.actions.offsets[g + 1] - problem.actions.offsets[g])
        )[: len(codes)]
    return Outcome(
        codes, state.found, interrupted, run.first_length, run.first_evaluations, run.first_checks,
        state.evaluations, state.checks, tuple(state.history), tuple(run.macros), names,
    )  # fmt: skip


class _Keeper:
    """Writes checkpoints now and then, whole or not at all, and reads them back."""

    def __init__(self, path: Path | None, identity: str) -> None:
        self.path = path
        self.identity = identity
        self.last = time.monotonic()

    def save(self, run: _Run, *, now: bool = False) -> None:
        if self.path is None or (not now and time.monotonic() - self.last < CHECKPOINT_EVERY):
            return
        self.last = time.monotonic()
        state = run.state
        population = state.population
        used = int(population.lengths.max(initial=1))
        data = {
            "schema": CHECKPOINT_SCHEMA,
            "identity": self.identity,
            "genes": [row[:n].tolist() for row, n in zip(population.genes, population.lengths, strict=True)],
            "width": [int(population.genes.shape[1]), used],
            "records": [_record_to_json(record) for record in population.records],
            "follow": [row[: 1 + max(0, int(row[0]))].tolist() for row in population.follow],
            "generation": state.generation,
            "evaluations": state.evaluations,
            "checks": state.checks,
            "history": [asdict(line) for line in state.history],
            "best": state.best.tolist(),
            "best_fitness": state.best_fitness if np.isfinite(state.best_fitness) else None,
            "best_actions": state.best_actions,
            "stage": state.stage,
            "found": state.found,
            "improved": state.improved,
            "since": state.since,
            "macros": [asdict(macro) for macro in run.macros],
            "turn": run.turn,
            "stale": run.stale,
            "polished": None if run.polished is None else run.polished.tolist(),
            "first": [run.first_length, run.first_evaluations, run.first_checks],
        }
        write_atomically(self.path, json.dumps(data))

    def load(self, problem: CompiledProblem) -> _Run | None:
        if self.path is None or not self.path.exists():
            return None
        allowed = "a checkpoint is what an earlier run of the same search wrote; name another file to start anew"
        try:
            data = json.loads(self.path.read_text(encoding="utf-8"))
            if data["schema"] != CHECKPOINT_SCHEMA or data["identity"] != self.identity:
                raise FileError(str(self.path), "belongs to another search (task, profile, inventory or seed)", allowed)
            return _run_from_json(data, problem)
        except (ValueError, KeyError, TypeError, IndexError, OSError) as error:
            raise FileError(str(self.path), f"is no checkpoint: {error}", allowed) from None


def _record_to_json(record: np.void) -> list[Any]:
    return [record[name].tolist() for name in ROLLOUT.names or ()]


def _run_from_json(data: dict[str, Any], problem: CompiledProblem) -> _Run:
    n, width = len(data["genes"]), data["width"][0]
    genes = np.zeros((n, width), np.int32)
    lengths = np.zeros(n, np.int32)
    records = np.zeros(n, ROLLOUT)
    macros = [Macro(**{**macro, "codes": tuple(macro["codes"])}) for macro in data["macros"]]
    follow = np.full((n, 1 + len(problem.actions) + len(macros)), -1, np.int32)
    for i in range(n):
        lengths[i] = len(data["genes"][i])
        genes[i, : lengths[i]] = data["genes"][i]
        follow[i, : len(data["follow"][i])] = data["follow"][i]
        for name, value in zip(ROLLOUT.names or (), data["records"][i], strict=True):
            records[name][i] = value
    state = Evolution(
        Population(genes, lengths, records, follow),
        generation=data["generation"],
        evaluations=data["evaluations"],
        checks=data["checks"],
        history=[Generation(**line) for line in data["history"]],
        best=np.array(data["best"], np.int32),
        best_fitness=-np.inf if data["best_fitness"] is None else data["best_fitness"],
        best_actions=data["best_actions"],
        stage=data["stage"],
        found=data["found"],
        improved=data["improved"],
        since=data["since"],
    )
    polished = None if data["polished"] is None else np.array(data["polished"], np.int32)
    run = _Run(state, macros, data["turn"], data["stale"], polished)
    first_length, first_evaluations, first_checks = data["first"]
    return replace(run, first_length=first_length, first_evaluations=first_evaluations, first_checks=first_checks)
