"""Many walks of one kind, each with its own seed: run over workers, stored as they end, and what they say together."""

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Final

import numpy as np

from ...jobs import Executor, Outcome, map_items
from ...jobs.release import release
from ...tasks.walks import Walk
from ...tasks.walks.library import walk_from_document
from ...types import Floats, Json
from ..intervals import wilson_interval
from .noise import WalkNoise
from .run_walk import run_walk, walk_flaws

ERROR: Final = "error"
"""Start of the reason of a trial that raised, or whose workers died."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WalkTrial:
    """How one walk ended."""

    seed: int
    done: bool
    """Whether both frames came to the end of the way."""
    reason: str
    """Why not; empty where it is done."""
    seconds: float
    """Simulated."""
    steps: int
    tilt: float
    """Largest angle of the plate from level while it walked [rad]."""
    margin: float | None
    """Least margin of balance while it walked [m]; None where fewer than three feet were on the ground at a time."""
    off: float | None
    """From where the way ends [m]; None where it was never laid."""
    turned: float | None
    """Heading from that at the end of the way [rad]."""
    kicks: int
    held_way: float | None = None
    """Way over which the tool was to be held at a point [m]; None where the walk has none, or ended before it was laid."""
    held_error: float | None = None
    """Largest distance of the tool from that point while it was held [m]; None where the robot did not come so far."""

    def to_json(self) -> Json:
        """Plain data."""
        return {name: getattr(self, name) for name in self.__slots__}


@dataclass(slots=True)
class WalkTrials:
    """Walks that ended."""

    walk: Walk
    noise: WalkNoise
    asked: int
    """How many there are to be."""
    ended: list[WalkTrial]
    wall_seconds: float = 0.0
    """All workers together, for the walks that ended."""

    @property
    def done(self) -> int:
        """Walks that came to their end."""
        return sum(trial.done for trial in self.ended)

    @property
    def interval(self) -> tuple[float, float]:
        """Of the share that came to their end, 95 %, Wilson's."""
        return wilson_interval(self.done, len(self.ended))

    @property
    def balanced(self) -> int:
        """Walks whose margin of balance was positive throughout, done or not."""
        return sum(trial.margin is not None and trial.margin > 0.0 for trial in self.ended)

    def of(self, name: str) -> Floats:
        """A number of all walks that have it."""
        return np.array(
            [value for trial in self.ended if (value := getattr(trial, name)) is not None], dtype=np.float64
        )

    def to_json(self) -> Json:
        """Plain data."""
        return {
            "walk": self.walk.name,
            "noise": self.noise.to_json(),
            "asked": self.asked,
            "n": len(self.ended),
            "done": self.done,
            "interval": list(self.interval),
            "balanced": self.balanced,
            "trials": [trial.to_json() for trial in self.ended],
        }


def run_walk_trial(item: Json) -> Json:
    """One walk; runs in a worker.

    Args:
        item: `document` of the walk, settings of the `plant`, `noise` as plain data, `seed`.

    Returns:
        `WalkTrial.to_json`.
    """
    walk = walk_from_document(item["document"])
    run = run_walk(walk, walk_flaws(walk, item["plant"]), noise=WalkNoise(item["noise"]), seed=item["seed"])
    report, margin = run.report, run.margin
    off, turned = (None, None) if report.missed is None else report.missed
    way, error = (None, None) if run.held is None else (run.held.part.way, run.held.largest)
    return WalkTrial(
        seed=item["seed"], done=run.done, reason=run.reason, seconds=report.seconds, steps=len(report.steps),
        tilt=run.tilt, margin=margin if np.isfinite(margin) else None, off=off, turned=turned, kicks=report.kicks,
        held_way=way, held_error=error,
    ).to_json()  # fmt: skip


def run_walk_trials(
    walk: Walk,
    noise: WalkNoise,
    seeds: Sequence[int],
    *,
    executor: Executor,
    plant: Sequence[str] = (),
    store: Path | None = None,
    resume: bool = False,
    told: Callable[[WalkTrials], None] | None = None,
) -> WalkTrials:
    """Walk with every seed; each trial is stored, and told of, as it ends. Ctrl-C ends it early, with what there is.

    Args:
        walk: What is walked.
        noise: What deviates.
        seeds: One trial each.
        executor: Who runs them.
        plant: Settings of the plant, such as "friction=50%".
        store: SQLite file that keeps the trials.
        resume: Whether to go on with that file.
        told: Given what there is so far at each end.

    Raises:
        StoreError: If the file can't be the store of these trials.
        ClusterError: If there is no cluster to run on, or it is lost.
    """
    trials = WalkTrials(walk, noise, len(seeds), [])
    common = {"document": walk.document, "plant": list(plant), "noise": noise.to_json()}

    def take(ended: int, total: int, outcome: Outcome) -> None:
        trials.wall_seconds += outcome.seconds
        if outcome.result is not None:
            trials.ended.append(WalkTrial(**outcome.result))
        if told is not None:
            told(trials)

    with suppress(KeyboardInterrupt):
        outcomes = map_items(
            run_walk_trial,
            [common | {"seed": seed} for seed in seeds],
            executor=executor,
            store=store,
            about=common | {"release": release() | {"mujoco": version("mujoco")}},
            title=f"walks '{walk.name}'",
            resume=resume,
            progress=take,
        )
        trials.wall_seconds = sum(outcome.seconds for outcome in outcomes)
        trials.ended = [
            _error(seed, outcome.error or "") if outcome.result is None else WalkTrial(**outcome.result)
            for seed, outcome in zip(seeds, outcomes, strict=True)
        ]
    return trials


def _error(seed: int, error: str) -> WalkTrial:
    """A trial without an answer; it counts as a walk that failed."""
    return WalkTrial(
        seed=seed, done=False, reason=f"{ERROR}: {error}", seconds=0.0, steps=0, tilt=0.0, margin=None, off=None,
        turned=None, kicks=0,
    )  # fmt: skip
