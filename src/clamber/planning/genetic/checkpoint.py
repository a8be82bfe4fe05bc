"""The state of a genetic search as a file: written whole or not at all, and looked through before a search goes on from it."""

import json
import time
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Annotated, Any, Final

import numpy as np
from pydantic import Field, StrictBool

from ...errors import FileError, SpecError
from ...files import Document, parse_json, read_text, write_atomically
from ...jobs.release import difference, release
from ...regular_files import is_there
from ...specs import build_spec, spec
from ..problem.problem import MAX_FEATURES, ROLLOUT, CompiledProblem
from .evolve import Evolution, Generation, Genes, Population, explicit_problem
from .learning import Macro

SCHEMA: Final = "clamber-checkpoint-1"
MOST: Final = 64 * 1024 * 1024
"""Largest checkpoint that is read [bytes]: a population of 10 000 sequences of 800 actions."""
EVERY: Final = 2.0
"""Seconds between checkpoints."""
ALLOWED: Final = "a checkpoint is what an earlier run of the same search wrote; name another file to start anew"
Count = Annotated[int, Field(strict=True, ge=0, le=2**62)]
Gene = Annotated[int, Field(strict=True, ge=0, le=2**31 - 1)]
Number = Annotated[float, Field(allow_inf_nan=False)]
Whole = Annotated[int, Field(strict=True, ge=-(2**31), le=2**31 - 1)]
Record = tuple[
    Number, Number, Annotated[tuple[Number, ...], Field(min_length=MAX_FEATURES, max_length=MAX_FEATURES)],
    Annotated[int, Field(strict=True, ge=-(2**63), le=2**63 - 1)], Whole, Whole, Whole, Whole, Whole, Whole,
]  # fmt: skip
"""The fields of `ROLLOUT`."""


@dataclass(slots=True)
class Run:
    """Everything that a checkpoint keeps."""

    state: Evolution
    macros: list[Macro]
    turn: int = 0
    stale: int = 0
    polished: Genes | None = None
    first_length: int | None = None
    first_evaluations: int | None = None
    first_checks: int | None = None


@spec
class _Line:
    generation: Count
    evaluations: Count
    best_fitness: Number
    furthest: Whole
    stage: Whole


@spec
class _Kept:
    """A checkpoint's file, by its types."""

    genes: tuple[tuple[Gene, ...], ...]
    width: tuple[Gene, Gene]
    records: tuple[Record, ...]
    follow: tuple[tuple[Annotated[int, Field(strict=True, ge=-1, le=2**31 - 1)], ...], ...]
    generation: Count
    evaluations: Count
    checks: Count
    history: tuple[_Line, ...]
    best: tuple[Gene, ...]
    best_fitness: Number | None
    best_actions: Count
    stage: Whole
    found: StrictBool
    improved: Count
    since: Number | None
    macros: tuple[Macro, ...]
    turn: Count
    stale: Count
    polished: tuple[Gene, ...] | None
    first: tuple[Count | None, Count | None, Count | None]


class Keeper:
    """Writes checkpoints now and then, whole or not at all, and reads them back."""

    def __init__(self, path: Path | None, identity: str) -> None:
        self.path = path
        self.identity = identity
        self.last = time.monotonic()

    def save(self, run: Run, *, now: bool = False) -> None:
        """Write the state, if it is time.

        Raises:
            FileError: If it cannot be written.
        """
        if self.path is None or (not now and time.monotonic() - self.last < EVERY):
            return
        self.last = time.monotonic()
        state = run.state
        population = state.population
        used = int(population.lengths.max(initial=1))
        data = {
            "schema": SCHEMA,
            "identity": self.identity,
            "release": release(),
            "genes": [row[:n].tolist() for row, n in zip(population.genes, population.lengths, strict=True)],
            "width": [int(population.genes.shape[1]), used],
            "records": [[record[name].tolist() for name in ROLLOUT.names or ()] for record in population.records],
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
            "since": state.since if np.isfinite(state.since) else None,
            "macros": [asdict(macro) for macro in run.macros],
            "turn": run.turn,
            "stale": run.stale,
            "polished": None if run.polished is None else run.polished.tolist(),
            "first": [run.first_length, run.first_evaluations, run.first_checks],
        }
        write_atomically(self.path, json.dumps(data))

    def load(self, problem: CompiledProblem, population: int, longest: int) -> Run | None:
        """The state to go on from; None where there is no file yet.

        Args:
            problem: What is planned.
            population: Plans of a generation.
            longest: Most genes of one.

        Raises:
            FileError: If the file is none, or belongs to another search.
            SpecError: If a gene, code, index or number in it is none that this search can have.
        """
        if self.path is None or not is_there(self.path):
            return None
        label = str(self.path)
        try:
            data = parse_json(read_text(self.path, MOST))
        except ValueError as error:
            raise FileError(label, f"is no checkpoint: {error}", ALLOWED) from None
        if not isinstance(data, dict) or data.get("schema") != SCHEMA:
            raise FileError(label, f"is no checkpoint: it does not say schema = {SCHEMA!r}", ALLOWED)
        if data.get("identity") != self.identity:
            raise FileError(label, "belongs to another search (task, profile, inventory or seed)", ALLOWED)
        if (told := data.get("release")) != release():
            other = difference(release(), told) if isinstance(told, dict) else "it does not name which"
            raise FileError(label, f"belongs to another release of Clamber ({other})", ALLOWED)
        kept = build_spec(_Kept, Document(label, data), without=("schema", "identity", "release"))
        return _Reader(label, kept, problem).run(population, longest)


class _Reader:
    """Holds a checkpoint's genes, codes and indices against the problem."""

    def __init__(self, label: str, kept: _Kept, problem: CompiledProblem) -> None:
        self.label, self.kept = label, kept
        for i, macro in enumerate(kept.macros):
            problem.limits.macro(macro.codes, f"macros.{i}.codes", label)
        self.problem = with_macros(problem, kept.macros)
        self.entries = len(self.problem.actions)

    def run(self, population: int, longest: int) -> Run:
        kept = self.kept
        n = len(kept.genes)
        self._check("genes", n, n == population, f"must be {population} plans, as the profile says")
        self._check("width.0", kept.width[0], kept.width[0] == longest, f"must be {longest}, as the profile says")
        for key, rows in (("records", kept.records), ("follow", kept.follow)):
            self._check(key, len(rows), len(rows) == n, f"must be {n}, one for each plan")
        genes, lengths = np.zeros((n, longest), np.int32), np.zeros(n, np.int32)
        records, follow = np.zeros(n, ROLLOUT), np.full((n, 1 + self.entries), -1, np.int32)
        for i, row in enumerate(kept.genes):
            self._check(f"genes.{i}", len(row), len(row) <= longest, f"must be at most {longest} genes")
            self._genes(f"genes.{i}", row)
            genes[i, : len(row)], lengths[i] = row, len(row)
            next_ = kept.follow[i]
            self._check(
                f"follow.{i}",
                next_[:1],
                len(next_) == 1 + max(0, next_[0] if next_ else -2),
                "must be a count and as many",
            )
            self._genes(f"follow.{i}", next_[1:])
            follow[i, : len(next_)] = next_
            for name, value in zip(ROLLOUT.names or (), kept.records[i], strict=True):
                records[name][i] = value
            for name in ("genes", "best_genes"):
                held = int(records[name][i])
                self._check(
                    f"records.{i}.{name}", held, 0 <= held <= len(row), f"must be 0 to {len(row)}, the plan's genes"
                )
        self._genes("best", kept.best)
        best = np.array(kept.best, np.int32)
        polished = None if kept.polished is None else self._polished(best)
        if kept.found:
            replayed = self.problem.replay(self.problem.actions.spell(best) if polished is None else polished)
            stances = replayed.stances if replayed.ok else replayed.stances[:-1]
            reached = any(self.problem.is_done(stances[i : i + 1]) for i in range(len(stances)))
            self._check("found", True, reached, "must be false: its best plan does not reach the goal")
        state = Evolution(
            Population(genes, lengths, records, follow),
            history=[Generation(**{f.name: getattr(line, f.name) for f in fields(line)}) for line in kept.history],
            best=best,
            best_fitness=-np.inf if kept.best_fitness is None else kept.best_fitness,
            since=-np.inf if kept.since is None else kept.since,
            generation=kept.generation, evaluations=kept.evaluations, checks=kept.checks, best_actions=kept.best_actions,
            stage=kept.stage, found=kept.found, improved=kept.improved,
        )  # fmt: skip
        return Run(state, list(kept.macros), kept.turn, kept.stale, polished, *kept.first)

    def _polished(self, best: Genes) -> Genes:
        """Codes of the polished plan, each of which the plan that it came from may be made of."""
        codes = self.problem.limits.codes(self.kept.polished, "polished", self.label)
        known = set(explicit_problem(self.problem, best)[0].actions.codes.tolist())
        for at, code in enumerate(codes.tolist()):
            self._check(
                f"polished.{at}", code, code in known, "must be an action of the best plan, or a move of the body"
            )
        return codes

    def _genes(self, key: str, genes: tuple[int, ...]) -> None:
        at = next((k for k, gene in enumerate(genes) if gene >= self.entries), None)
        if at is not None:
            allowed = f"must be an entry of the action table, 0 to {self.entries - 1}"
            self._check(f"{key}.{at}", genes[at], False, allowed)

    def _check(self, key: str, value: Any, holds: bool, allowed: str) -> None:
        if not holds:
            raise SpecError(self.label, key, value, allowed)


def with_macros(problem: CompiledProblem, macros: tuple[Macro, ...] | list[Macro]) -> CompiledProblem:
    """The problem with macros in its inventory, behind its own entries."""
    return problem.rebind(problem.actions.extended([(macro.name, macro.codes, False) for macro in macros]))
