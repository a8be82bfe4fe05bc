"""Trials of a comparison over worker processes: each runs every law on a plant of its own seed, and is measured there."""

import base64
import pickle
from collections.abc import Callable, Sequence
from typing import Any

from ..errors import ClamberError
from ..jobs import map_items
from ..sim.limb_flaws import LimbFlaws
from ..types import Json
from .bench_limb import BenchLimb
from .contest import Entry, run_contest
from .measures import Measures, measure
from .scenario import Scenario


def drawn(flaws: LimbFlaws, trial: int) -> LimbFlaws:
    """The plant of a trial: its seed is that of `flaws` plus the trial's number; without a seed all are the same."""
    return flaws if flaws.seed is None else flaws.with_changes(seed=flaws.seed + trial)


def run_trials(
    limb: BenchLimb,
    scenario: Scenario,
    entries: Sequence[Entry],
    flaws: LimbFlaws,
    trials: Sequence[int],
    *,
    plant: str,
    workers: int = 1,
    progress: Callable[[int], None] | None = None,
) -> list[list[Measures]]:
    """Measures of every entry in each of `trials`; the same for any number of workers.

    Args:
        limb: On the bench.
        scenario: What is asked of it.
        entries: The laws.
        flaws: Of the plant, before its seed is drawn.
        trials: Numbers of trials.
        plant: Its name.
        workers: Processes; with one all is run in this one.
        progress: Told how many have ended.

    Raises:
        ClamberError: If a worker failed.
    """
    told = progress or (lambda ended: None)
    if workers == 1:
        out = []
        for ended, trial in enumerate(trials, start=1):
            out.append(measure_trial(limb, scenario, entries, drawn(flaws, trial), plant))
            told(ended)
        return out
    # values of this very program for its own workers: the run of a law is not plain data
    common = _packed((limb, scenario, tuple(entries), flaws, plant))
    outcomes = map_items(
        run_trial,
        [{"common": common, "trial": trial} for trial in trials],
        workers=min(workers, len(trials)),
        progress=lambda ended, total, outcome: told(ended),
    )
    out = []
    for trial, outcome in zip(trials, outcomes, strict=True):
        if outcome.result is None:
            raise ClamberError(f"trial {trial}: {outcome.error}")
        out.append(_unpacked(outcome.result["measures"]))
    return out


def measure_trial(
    limb: BenchLimb, scenario: Scenario, entries: Sequence[Entry], flaws: LimbFlaws, plant: str
) -> list[Measures]:
    """Measures of every entry on one plant; how long a tick takes is not among them."""
    return [
        measure(run, scenario, limb) for run in run_contest(limb, scenario, entries, flaws, plant=plant, timed=False)
    ]


def run_trial(item: Json) -> Json:
    """One trial; runs in a worker.

    Args:
        item: `trial`, its number, and `common`, what all trials share, packed.

    Returns:
        `measures`, those of every law, packed.
    """
    limb, scenario, entries, flaws, plant = _unpacked(item["common"])
    return {"measures": _packed(measure_trial(limb, scenario, entries, drawn(flaws, item["trial"]), plant))}


def _packed(value: object) -> str:
    return base64.b64encode(pickle.dumps(value)).decode()


def _unpacked(text: str) -> Any:
    return pickle.loads(base64.b64decode(text))
