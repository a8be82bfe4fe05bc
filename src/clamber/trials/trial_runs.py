"""Many runs of one work, each with its own seed: run over workers, stored as they end."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar, Final, Generic, Protocol, TypeVar

import numpy as np
from pydantic import Field

from ..errors import ClamberError
from ..interrupts import Interruptible
from ..jobs import Executor, Kept, Outcome, look_into, map_items, read_result
from ..json_form import HIDDEN, Count, Jsonable, in_json
from ..notebook import Pictured
from ..planning.problem.plan import Plan
from ..types import Floats, Json

Z95: Final = 1.959963984540054
"""Two-sided 95 % of the normal distribution."""
ERROR: Final = "error"
"""Begins the reason of a trial that raised, or whose workers died."""


def wilson_interval(hits: int, n: int, z: float = Z95) -> tuple[float, float]:
    """Interval of a share of which `hits` of `n` are known, (Wilson, JASA 22, 1927; closed form).

    On average over shares it holds what it says, also near 0 and 1, where the usual p +- z s does not.

    Args:
        hits: How many of `n`, 0 to `n`.
        n: Trials; 0 tells nothing, so the whole of 0 to 1.
        z: Standard deviations to either side.
    """
    assert 0 <= hits <= n
    if n == 0:
        return 0.0, 1.0
    share, extra = hits / n, z * z / n
    middle = (share + extra / 2.0) / (1.0 + extra)
    half = z / (1.0 + extra) * math.sqrt(share * (1.0 - share) / n + extra / (4.0 * n))
    low = 0.0 if hits == 0 else max(0.0, middle - half)
    return low, 1.0 if hits == n else min(1.0, middle + half)


class Trial(Protocol):
    """How one run ended, as a frozen dataclass of plain data."""

    @property
    def seed(self) -> int:
        """That drew what was not as believed."""

    @property
    def done(self) -> bool:
        """Whether it came to its end."""

    @property
    def fault(self) -> Json | None:
        """The fault that the robot had; see `told_fault`."""


@dataclass(frozen=True, slots=True)
class Cause:
    """Runs that ended early in the same way."""

    words: str
    """Such as "fell"."""
    n: int
    interval: tuple[float, float]
    """Of their share of all runs, 95 %, Wilson's."""
    steps: tuple[Count, ...]
    """After how many steps or actions, each once."""
    seeds: tuple[Count, ...]
    reason: str
    """Of the first one."""


class PairingError(ClamberError):
    """Trials that cannot be compared seed by seed."""

    def __str__(self) -> str:
        return "trials are compared seed by seed, and these have no seed in common"


@dataclass(frozen=True, slots=True, kw_only=True)
class Paired(Jsonable):
    """Trials of two works, seed by seed, over the seeds that both have."""

    both: Count
    """Seeds with which both came to their end."""
    first: tuple[Count, ...]
    """Seeds with which only the first did."""
    second: tuple[Count, ...]
    """Seeds with which only the second did."""
    neither: Count
    p: float
    """Chance that they differ so unevenly or more if each seed goes either way alike (sign test, two-sided) [-]."""

    def told(self) -> str:
        """The same in words."""
        return (
            f"seed by seed: both done {self.both}, only the first {len(self.first)}, only the second {len(self.second)}, "
            f"neither {self.neither}; p = {self.p:.2g} (sign test, two-sided)"
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class StoredFault:
    """What is read back of a trial's fault; see `fault_trials.told_fault`."""

    kind: str
    where: str
    start: Annotated[float, Field(strict=True)]
    noticed: Annotated[float | None, Field(strict=True)]
    at: str
    ending: str


def check_told(fault: Json | None, store: Path | None) -> None:
    """Make sure that what a store has of a trial's fault can be summed up.

    Raises:
        SpecError: If a field is missing, or has a value of another type.
    """
    if fault is not None:
        read_result(StoredFault, fault, store)


TrialT = TypeVar("TrialT", bound=Trial)
SetupT = TypeVar("SetupT", bound="Setup[Any, Any]")
RunT = TypeVar("RunT")


class Setup(ABC, Generic[RunT, TrialT]):
    """What all trials of a work have in common, as plain as a worker needs it."""

    kind: ClassVar[type[Any]]
    """Of a trial."""
    unknown: ClassVar[Mapping[str, Any]]
    """What a trial that raised has in place of what it would have told."""
    task: Any
    plan: Plan | None
    faults: tuple[str, ...]

    @property
    def work(self) -> Any:
        """The task, or what else is carried out."""
        return self.task

    @property
    @abstractmethod
    def worker(self) -> Callable[[Json], Json]:
        """Runs one item; a function at the top of a module."""

    @property
    @abstractmethod
    def title(self) -> str:
        """What they are trials of, for errors about stores."""

    @abstractmethod
    def about(self) -> Json:
        """What tells these trials from others; not how many, nor from which seed on."""

    @abstractmethod
    def item(self, seed: int) -> Json:
        """One trial for a worker."""

    def trial(self, result: Json, store: Path | None = None) -> TrialT:
        """The trial that a worker returned, or that a store has.

        Raises:
            SpecError: If it is none.
        """
        trial: TrialT = read_result(self.kind, result, store)
        check_told(trial.fault, store)
        return trial

    def failed(self, seed: int, error: str) -> TrialT:
        """A trial that raised, or whose workers died; it counts as a failure."""
        made: TrialT = self.kind(seed=seed, done=False, reason=f"{ERROR}: {error}", **self.unknown)
        return made

    @abstractmethod
    def again(self, seed: int, kept: Json | None, step: Callable[[str, float | None], None]) -> tuple[RunT, TrialT]:
        """One trial again, with its whole run.

        Args:
            seed: Of the trial.
            kept: What a store has of it, so that what a clock decided comes out alike; None: nothing.
            step: Told the action or step that begins.
        """

    def begun(self, asked: int) -> "Trials[Any, TrialT]":
        """Trials of which none has ended; `asked`: how many there are to be."""
        return Trials(self, asked, [])

    def warm_up(self) -> None:  # most have nothing to load
        """Load what all workers need, once and not in all of them at the same time."""

    def kept(self, store: Path | None) -> Kept | None:
        """What the store of these trials holds; None where there is no such file yet.

        Raises:
            StoreError: If the file can't be the store of these trials.
        """
        if store is None:
            return None
        return look_into(store, self.worker, about=self.about(), title=self.title)

    def stored_plan(self, store: Path | None) -> Plan | None:
        """The plan that the store of these trials was begun with; None where there is none yet."""
        kept = self.kept(store)
        return None if kept is None or kept.note is None else Plan.from_json(kept.note, "plan of the store")


@dataclass(slots=True, repr=False)
class Trials(Pictured, Generic[SetupT, TrialT]):
    """Runs that ended, and how long they took."""

    setup: SetupT
    """With its plan."""
    asked: Count
    """How many there are to be."""
    ended: list[TrialT]
    wall_seconds: Annotated[float, HIDDEN] = 0.0
    """All workers together, for the runs that ended."""

    @in_json(after="asked")
    def n(self) -> Count:
        """Runs that ended."""
        return len(self.ended)

    @property
    @in_json(after="n")
    def done(self) -> int:
        """Runs that came to their end."""
        return sum(trial.done for trial in self.ended)

    @property
    @in_json(after="done")
    def interval(self) -> tuple[float, float]:
        """Of the share that came to their end, 95 %, Wilson's."""
        return wilson_interval(self.done, len(self.ended))

    def of(self, name: str) -> Floats:
        """A number of all runs that have it."""
        values = [getattr(trial, name) for trial in self.ended]
        return np.array([value for value in values if value is not None], np.float64)

    def against(self, other: "Trials[Any, Any]") -> Paired:
        """These and those of another work, seed by seed.

        Raises:
            PairingError: If they have no seed in common.
        """
        from scipy.stats import binomtest

        mine, theirs = ({trial.seed: trial.done for trial in trials.ended} for trials in (self, other))
        shared = sorted(mine.keys() & theirs.keys())
        if not shared:
            raise PairingError
        first = tuple(seed for seed in shared if mine[seed] > theirs[seed])
        second = tuple(seed for seed in shared if mine[seed] < theirs[seed])
        both = sum(mine[seed] and theirs[seed] for seed in shared)
        apart = len(first) + len(second)
        return Paired(
            both=both,
            first=first,
            second=second,
            neither=len(shared) - both - apart,
            p=float(binomtest(len(first), apart).pvalue) if apart else 1.0,
        )

    def told(self) -> str:
        """How many came to their end, with the interval of the share."""
        low, high = self.interval
        return f"{self.done} of {len(self.ended)} done, {100 * low:.0f} to {100 * high:.0f} % (95 %), of {self.setup.title}"

    def again(self, seed: int) -> Any:
        """One of them once more, with its whole run, as `clamber.run` gives it."""
        run, _ = self.setup.again(seed, None, lambda words, share: None)
        return run


def causes_of(
    trials: Sequence[TrialT], reason: Callable[[TrialT], str], steps: Callable[[TrialT], int]
) -> tuple[Cause, ...]:
    """Why runs ended early, the commonest first, by what their reasons say without numbers: "fell" of "step 3: fell: the robot tips"."""
    found: dict[str, list[TrialT]] = {}
    for trial in trials:
        if not trial.done:
            parts = [part.strip() for part in reason(trial).split(":")]
            words = parts[1] if parts[0].startswith("step ") and len(parts) > 1 else parts[0]
            found.setdefault(words, []).append(trial)
    return tuple(
        Cause(
            words,
            len(alike),
            wilson_interval(len(alike), len(trials)),
            tuple(sorted({steps(each) for each in alike})),
            tuple(each.seed for each in alike),
            reason(alike[0]),
        )
        for words, alike in sorted(found.items(), key=lambda pair: -len(pair[1]))
    )


def run_trials(
    setup: Setup[Any, TrialT],
    seeds: Sequence[int],
    *,
    executor: Executor,
    store: Path | None = None,
    resume: bool = False,
    told: Callable[[Any], None] | None = None,
) -> Trials[Any, TrialT]:
    """Run with every seed; each trial is stored, and told of, as it ends. Ctrl-C ends it early, with what there is.

    Args:
        setup: What all trials have in common, with its plan if it is carried out by one.
        seeds: One trial each.
        executor: Who runs them.
        store: SQLite file that keeps plan and trials.
        resume: Whether to go on with that file: trials in it are not run again.
        told: Given the trials so far at each end.

    Returns:
        As `setup.begun` makes them.

    Raises:
        StoreError: If the file can't be the store of these trials.
        ClusterError: If there is no cluster to run on, or it is lost.
    """
    trials = setup.begun(len(seeds))
    kept = setup.kept(store) if resume else None
    wanted = set(seeds)
    if kept is not None:
        trials.ended = [setup.trial(result, store) for result in kept.results if result.get("seed") in wanted]
    if executor.here and len(trials.ended) < len(seeds):
        setup.warm_up()

    def take(ended: int, total: int, outcome: Outcome) -> None:
        trials.wall_seconds += outcome.seconds
        if outcome.result is not None:
            trials.ended.append(setup.trial(outcome.result, store))
        if told is not None:
            told(trials)

    with Interruptible():
        outcomes = map_items(
            setup.worker,
            [setup.item(seed) for seed in seeds],
            executor=executor,
            store=store,
            about=setup.about(),
            title=setup.title,
            note=None if setup.plan is None else setup.plan.to_json(),
            resume=resume,
            progress=take,
        )
        trials.wall_seconds = sum(outcome.seconds for outcome in outcomes)
        trials.ended = [
            setup.failed(seed, outcome.error or "") if outcome.result is None else setup.trial(outcome.result, store)
            for seed, outcome in zip(seeds, outcomes, strict=True)
        ]
    return trials


def stored_result(setup: Setup[Any, Any], seed: int, store: Path | None) -> Json | None:
    """What the store has of a seed's trial; None where it is not there.

    Raises:
        StoreError: If the file can't be the store of these trials.
    """
    kept = setup.kept(store)
    results = () if kept is None else kept.results
    return next((result for result in results if result.get("seed") == seed), None)
