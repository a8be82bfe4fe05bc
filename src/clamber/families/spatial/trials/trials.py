"""Many runs of one plan of a robot in space, each with its own seed: run over workers, stored as they end, and what they say together."""

from collections.abc import Callable
from dataclasses import (
    dataclass,
    field,
    replace,
)
from operator import attrgetter
from types import MappingProxyType
from typing import Annotated

import numpy as np

from ....execution.fault import draw_fault
from ....json_form import Count, Jsonable, Key, in_json
from ....planning.problem.plan import Plan
from ....tasks import task_from_document
from ....trials.dynamics import Conditions, RunEvents
from ....trials.fault_trials import FaultRow, TriedFault, fault_rows, told_fault
from ....trials.sensitivity import Effect, find_effects
from ....trials.trial_runs import Cause, Setup, Trials, causes_of
from ....types import Json
from ..control.laws import USUAL
from ..execution.faulty_spatial import failing_of
from ..planning.task import SpatialTask
from ..sim.spatial_flaws import Deviations, read_spatial_flaws
from .noise import SPATIAL_NOISE, SpatialNoise, drawn
from .planning import replanner
from .run_plan import (
    Control,
    SpatialRun,
    run_plan,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class SpatialTrial(Jsonable):
    """How one run ended."""

    seed: Count
    done: bool
    """Whether the plan came to its end."""
    reason: str
    """Why not; empty where it did."""
    seconds: float
    """Simulated."""
    actions: Count
    """Of the plan that were carried out."""
    off: float
    """Largest distance of the body from where it was to be, as believed [m]."""
    lost: float | None
    """How far the robot was from where it believed to be, at the end [m]; None where that is not known."""
    breaks: Count
    """Contacts that came off."""
    replans: Count
    """Plans made on the way."""
    wall_seconds: float
    """That it took."""
    drawn: dict[str, float]
    """Deviation of each key of the noise that is drawn, of holds those that the plan takes; empty where it raised."""
    fault: Annotated[Json | None, Key(kind=TriedFault)] = None
    """The fault that the robot had, when it was noticed, and how that ended; None in trials without."""


def run_once(item: Json, step: Callable[[str, float | None], None] | None = None) -> SpatialRun:
    """One run of many; `item` as `SpatialSetup.item` writes it."""
    task = task_from_document(item["document"])
    assert isinstance(task, SpatialTask)
    seed, noise = item["seed"], SpatialNoise(item["noise"])

    def tell(text: str, share: float | None = None) -> None:
        if step is not None:
            step(text, share)

    search = Conditions(**item["search"])
    plan = Plan.from_json(item["plan"] | {"document": item["document"]})
    return run_plan(
        task,
        plan,
        flaws=noise.flaws(read_spatial_flaws(item["plant"], seed), seed),
        deviations=_deviations(noise, item, task, plan),
        progress=lambda action, of: tell(f"action {action} of {of}", action / of),
        control=Control(item["law"], replanner(search, RunEvents(note=tell), seed)),
    )


def _deviations(noise: SpatialNoise, item: Json, task: SpatialTask, plan: Plan) -> Deviations | None:
    """How robot and world truly are, with the fault that the seed draws; None: as believed."""
    seed, kinds = item["seed"], item.get("faults", ())
    true = noise.deviations(task.robot, task.world, seed) if noise.any else None
    if not kinds:
        return true
    fault = draw_fault(kinds, seed, failing_of(task, plan))
    return replace(true or Deviations.none(task.robot, task.world), fault=fault)


def judged(seed: int, run: SpatialRun, noise: SpatialNoise) -> SpatialTrial:
    """What is kept of a run under a noise."""
    report, lost = run.report, None
    if report.pose is not None and report.true_pose is not None:
        lost = float(np.linalg.norm(np.subtract(report.pose[:3], report.true_pose[:3])))
    ended = [motion.last for motion in report.motions if motion.outcome == "ok"]
    return SpatialTrial(
        seed=seed,
        done=run.done,
        reason=run.reason,
        seconds=report.seconds,
        actions=max(ended, default=0),
        off=report.off,
        lost=lost,
        breaks=len(run.broken),
        replans=len(report.replans),
        wall_seconds=run.wall_seconds,
        drawn=drawn(noise, run.task, run.plan, seed),
        fault=told_fault(run.fault, run.done, report),
    )


def run_spatial_trial(item: Json) -> Json:
    """One run, as `SpatialTrial.to_json`; runs in a worker."""
    return judged(item["seed"], run_once(item), SpatialNoise(item["noise"])).to_json()


@dataclass(frozen=True, slots=True, kw_only=True)
class SpatialSetup(Setup[SpatialRun, SpatialTrial]):
    """What all trials have in common."""

    kind = SpatialTrial
    unknown = MappingProxyType(
        {
            "seconds": 0.0,
            "actions": 0,
            "off": 0.0,
            "lost": None,
            "breaks": 0,
            "replans": 0,
            "wall_seconds": 0.0,
            "drawn": {},
        }
    )
    task: SpatialTask
    noise: SpatialNoise
    plant: tuple[str, ...] = ()
    """Settings of the plant, such as "friction=50%"."""
    law: str = USUAL
    """Of the whole body, by name."""
    plan: Plan | None = None
    planned: bool = False
    """Whether a planner made the plan, so that it is no part of what was asked for."""
    search: Conditions = field(default_factory=Conditions)
    """How plans are searched for on the way."""
    faults: tuple[str, ...] = ()
    """Kinds of faults, one of which each trial has; none without."""

    @property
    def name(self) -> str:
        """Of the task."""
        return self.task.name

    @property
    def worker(self) -> Callable[[Json], Json]:
        """One trial."""
        return run_spatial_trial

    @property
    def title(self) -> str:
        """In words."""
        return f"runs of '{self.name}'"

    def about(self) -> Json:
        """Task, plant, noise, law, and the plan if it was asked for."""
        return self._plain() | {"plan": None if self.plan is None or self.planned else self.plan.to_json()}

    def item(self, seed: int) -> Json:
        """One trial for a worker."""
        assert self.plan is not None, "plan first"
        return self._plain() | {"plan": self.plan.to_json() | {"document": {}}, "seed": seed}

    def _plain(self) -> Json:
        search = {
            "planner": self.search.planner,
            "plan_seconds": self.search.plan_seconds,
            "replan": self.search.replan,
        }
        told = {
            "document": self.task.document,
            "plant": list(self.plant),
            "noise": self.noise.to_json(),
            "law": self.law,
            "search": search,
        }
        return told | ({"faults": list(self.faults)} if self.faults else {})

    def begun(self, asked: int) -> "SpatialTrials":
        """No runs yet."""
        return SpatialTrials(self, asked, [])

    def again(
        self, seed: int, kept: Json | None, step: Callable[[str, float | None], None]
    ) -> tuple[SpatialRun, SpatialTrial]:
        """One run again."""
        run = run_once(self.item(seed), step)
        return run, judged(seed, run, self.noise)


@dataclass(slots=True)
class SpatialTrials(Trials[SpatialSetup, SpatialTrial], Jsonable):
    """Runs that ended."""

    setup: Annotated[
        SpatialSetup,
        Key("task", get=attrgetter("name"), kind=str),
        Key(
            "noise",
            get=lambda setup: setup.noise.to_json(),
            kind=dict[str, float],
            meaning="Key to its width, SI units.",
        ),
    ]
    ended: Annotated[list[SpatialTrial], Key("trials", after="effects")]

    @in_json(after="interval")
    def causes(self) -> tuple[Cause, ...]:
        """Why runs ended early, the commonest first."""
        return causes_of(self.ended, attrgetter("reason"), attrgetter("actions"))

    @in_json(after="causes")
    def faults(self) -> tuple[FaultRow, ...]:
        """By kind; none in trials without."""
        return fault_rows(self.ended) if self.setup.faults else ()

    @in_json(after="faults")
    def effects(self) -> tuple[Effect, ...]:
        """What each key of the noise did to success; of keys that are the same in each run, and beside faults, nothing."""
        return () if self.setup.faults else tuple(find_effects(SPATIAL_NOISE, self.ended))
