"""Laws on the same limb, the same plant and the same command: run them, once or in many trials over processes, keep what happened."""

import base64
import math
import pickle
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from ..control.chain import Chain
from ..control.outside_law import LoopController, controller_of
from ..errors import ClamberError
from ..execution.closed_loop import close_loop
from ..execution.trace import LimbTrace
from ..jobs import Executor, Outcome, map_items
from ..jobs.batch import Progress
from ..sim.bench_limb import BenchLimb
from ..sim.limb_flaws import ForceSensor, LimbFlaws
from ..sim.plants import plant_maker
from ..types import Json
from .measures import Entry, Measures, Run, measure
from .scenario import Scenario

MISBELIEVED: Final = ("rotor", "damping", "friction", "mass", "inertia")
"""What a controller may be wrong about, joint by joint; lengths and angles it knows."""
MOMENT_ARM: Final = 0.05
"""Noise of a sensor's moments over that of its forces, of a size with the sensor [m]."""


def believed_chain(chain: Chain, flaws: LimbFlaws) -> Chain:
    """The chain as a controller believes it that is wrong by up to `flaws.model_error`, drawn from the seed."""
    if flaws.model_error == 0.0:
        return chain
    assert flaws.seed is not None
    # a stream of its own: the plant's draws stay the same whatever is believed
    draw = np.random.default_rng(np.random.SeedSequence(flaws.seed, spawn_key=(1000,)))
    joints = chain.joints.copy()
    for j in range(chain.n):
        for key in MISBELIEVED:
            joints[key][j] *= 1.0 + draw.uniform(-flaws.model_error, flaws.model_error)
    return Chain(chain.name, chain.joint_names, joints, chain.root.copy(), chain.plane).with_shares("inertia")


def with_sensors(flaws: LimbFlaws, entries: Sequence[Entry]) -> LimbFlaws:
    """The plant with the force sensors that the laws read and `flaws` does not have: ideal but for its `wrench_noise`."""
    noise, seed = flaws.wrench_noise, flaws.seed or 0
    needed = frozenset[str]().union(*(entry.settings.sensors() for entry in entries))
    added = {
        place: ForceSensor(noise=noise, moment_noise=MOMENT_ARM * noise, seed=2 * seed + k)
        for k, place in enumerate(("wrist", "base"))
        if place in needed and getattr(flaws, place) is None
    }
    return flaws.with_changes(**added)


def run_contest(
    limb: BenchLimb,
    scenario: Scenario,
    entries: Sequence[Entry],
    flaws: LimbFlaws,
    *,
    plant: str = "mujoco",
    timed: bool = True,
) -> list[Run]:
    """Run every entry alone, from rest at the limb's start; a run that leaves the finite numbers ends in NaN.

    Laws that read a force have one to read: the plant gets the sensors of `with_sensors`.

    Unless `timed`, `Run.tick_seconds` is NaN.

    Raises:
        UnknownNameError: If there is no such plant.
        PlantError: If the plant does not have one of the flaws.
        LawError: If settings do not fit the limb.
    """
    moved = plant_maker(plant)(limb.chain, scenario.on(with_sensors(flaws, entries)), gears=limb.gears)
    believed = believed_chain(limb.chain, flaws)
    out = []
    for entry in entries:
        controller = controller_of(believed, entry.settings, period=flaws.period)
        moved.reset(limb.q0)
        trace = close_loop(moved, controller, scenario.aims, keep=True)
        out.append(Run(entry, trace, _tick_seconds(controller, trace) if timed else math.nan))
    return out


def _tick_seconds(controller: LoopController, trace: LimbTrace) -> float:
    """Seconds of one tick, by the law again on what was sensed: the best of three rounds."""
    rounds = []
    states = [trace.sensed[k] for k in range(min(200, len(trace.time))) if np.isfinite(trace.sensed[k]).all()]
    if not states:
        return float("nan")
    for _ in range(3):
        controller.reset()
        begin = time.perf_counter()
        for k, state in enumerate(states):
            controller.command(trace.aims[k], state)
        rounds.append((time.perf_counter() - begin) / len(states))
    return min(rounds)


@dataclass(frozen=True, slots=True, eq=False)
class Contest:
    """What is the same in all trials of a comparison."""

    limb: BenchLimb
    scenario: Scenario
    entries: Sequence[Entry]
    flaws: LimbFlaws
    """Of the plant, before the seed of a trial is drawn."""
    plant: str = "mujoco"

    def measure_trial(self, trial: int) -> list[Measures]:
        """Measures of every entry on the plant of a trial; how long a tick takes is not among them.

        The plant's seed is that of `flaws` plus the trial's number; without a seed all trials are the same.
        """
        seed = self.flaws.seed
        drawn = self.flaws if seed is None else self.flaws.with_changes(seed=seed + trial)
        runs = run_contest(self.limb, self.scenario, self.entries, drawn, plant=self.plant, timed=False)
        return [measure(run, self.scenario, self.limb) for run in runs]

    def measure_trials(
        self, trials: Sequence[int], workers: int, progress: Callable[[int], None]
    ) -> list[list[Measures]]:
        """Measures of every entry in each of `trials`, the same for any number of workers; `progress` is told how many have ended.

        Raises:
            ClamberError: If a worker failed.
        """
        out = []
        if workers == 1:
            for ended, trial in enumerate(trials, start=1):
                out.append(self.measure_trial(trial))
                progress(ended)
            return out
        # values of this very program for its own workers: the run of a law is not plain data
        items = [{"contest": _packed(self), "trial": trial} for trial in trials]
        ends = map_items(
            run_trial, items, workers=min(workers, len(trials)), progress=lambda ended, total, end: progress(ended)
        )
        for trial, end in zip(trials, ends, strict=True):
            if end.result is None:
                raise ClamberError(f"trial {trial}: {end.error}")
            out.append(_unpacked(end.result["measures"]))
        return out


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Crew:
    """Who works through many items, and where what they find is kept; results don't depend on it."""

    workers: int = 1
    """Processes."""
    executor: Executor | None = None
    """In place of local processes."""
    store: Path | None = None
    """SQLite file that keeps each result of a titled batch as it ends."""
    resume: bool = False
    """Whether to go on with it."""
    progress: Progress | None = None
    """Told of each end."""
    then: Progress | None = None
    """Told instead of each end in a batch that follows from another, and is not kept."""

    def map(
        self, function: Callable[[Json], Json], items: Sequence[Json], *, title: str = "", about: Json | None = None
    ) -> list[Outcome]:
        """How each item ends; only a titled batch is kept."""
        kept: dict[str, Any] = {"store": self.store, "resume": self.resume, "title": title} if title else {}
        who: dict[str, Any] = {
            "workers": self.workers,
            "executor": self.executor,
            "progress": self.progress if title else self.then,
        }
        return map_items(function, items, about=about, **kept, **who)


def run_trial(item: Json) -> Json:
    """Packed `measures` of every law in one `trial` of a packed `contest`; runs in a worker."""
    return {"measures": _packed(_unpacked(item["contest"]).measure_trial(item["trial"]))}


def _packed(value: object) -> str:
    return base64.b64encode(pickle.dumps(value)).decode()


def _unpacked(text: str) -> Any:
    return pickle.loads(base64.b64decode(text))
