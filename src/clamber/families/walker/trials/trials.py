"""Many walks of one kind, each with its own seed: run over workers, stored as they end, and what they say together."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from operator import attrgetter
from types import MappingProxyType
from typing import Annotated, Final

import numpy as np

from ....execution.fault import Failing, draw_fault
from ....json_form import Count, Jsonable, Key, in_json
from ....planning.problem.plan import Plan
from ....tasks import task_from_document
from ....trials.fault_trials import FaultRow, TriedFault, fault_rows, told_fault
from ....trials.trial_runs import Cause, Setup, Trials, causes_of, wilson_interval
from ....types import Json
from ....units import DEGREE, GRAVITY
from ..execution.own_sensors import FORCES, INCLINES, channels_of
from ..planning import Walk
from ..planning.task import WalkerTask
from ..planning.walks import walk_from_document
from ..robot import WalkerRobot
from ..robot.weight import weight_of
from .noise import WalkNoise
from .planned import lay_plan, walk_of
from .run_walk import WalkRun, run_walk, step_told, walk_flaws

BEGINS: Final = (1.0, 100.0)
"""First and last time at which a fault of a trial begins [s]: while the robot levels, and in its first steps."""


def failing_of(robot: WalkerRobot) -> Failing:
    """Sensors of lengths, forces, inclines and joints; motors of lengths and joints."""
    names = [channel.name for channel in channels_of(robot)]
    weight = GRAVITY * weight_of(robot).total
    arm = () if robot.arm is None else zip(robot.arm.lowest, robot.arm.highest, strict=True)
    spans = (
        *[robot.mechanism.stroke] * 3,
        *[robot.legs.stroke] * 6,
        *[weight] * 6,
        *[math.pi / 2] * 2,
        *(high - low for low, high in arm),
    )
    motors = [name for k, name in enumerate(names) if k < FORCES.start or k >= INCLINES.stop]
    return Failing(sensors=dict(zip(names, spans, strict=True)), motors=motors, weight=weight)


LEVEL: Final = 0.1 * DEGREE
"""A plate counts as level within this [rad]: what the paper's robot levels itself to."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WalkTrial(Jsonable):
    """How one walk ended."""

    seed: Count
    done: bool
    """Whether both frames came to the end of the way."""
    reason: str
    """Why not; empty where it is done."""
    seconds: float
    """Simulated."""
    steps: Count
    tilt: float
    """Largest angle of the plate from level while it walked [rad]."""
    margin: float | None
    """Least margin of balance while it walked [m]; None where fewer than three feet were on the ground at a time."""
    off: float | None
    """From where the way ends [m]; None where it was never laid."""
    turned: float | None
    """Heading from that at the end of the way [rad]."""
    kicks: Count
    held_way: float | None = None
    """Way over which the tool was to be held at a point [m]; None where the walk has none, or ended before it was laid."""
    held_error: float | None = None
    """Largest distance of the tool from that point while it was held [m]; None where the robot did not come so far."""
    fault: Annotated[Json | None, Key(kind=TriedFault)] = None
    """The fault that the robot had, when it was noticed, and how that ended; None in trials without."""


def walk_once(item: Json, step: Callable[[str, float | None], None] | None = None) -> WalkRun:
    """One walk of many.

    Args:
        item: As `WalkSetup.item` writes it.
        step: Told the step that begins.
    """
    lay = None
    if "plan" in item:
        task = task_from_document(item["document"])
        assert isinstance(task, WalkerTask)
        walk, lay = walk_of(task), lay_plan(task, Plan.from_json(item["plan"] | {"document": item["document"]}))
    else:
        walk = walk_from_document(item["document"])
    faults, seed = item.get("faults", ()), item["seed"]
    fault = draw_fault(faults, seed, failing_of(walk.robot), BEGINS) if faults else None
    flaws, noise = walk_flaws(walk, item["plant"]), WalkNoise(item["noise"])
    told = None if step is None else lambda *moment: step(*step_told(*moment))
    return run_walk(walk, flaws, noise=noise, seed=seed, lay=lay, fault=fault, progress=told)


def judged(seed: int, run: WalkRun) -> WalkTrial:
    """What is kept of a walk."""
    report, margin = run.report, run.margin
    off, turned = (None, None) if report.missed is None else report.missed
    way, error = (None, None) if run.held is None else (run.held.part.way, run.held.largest)
    return WalkTrial(
        seed=seed,
        done=run.done,
        reason=run.reason,
        seconds=report.seconds,
        steps=len(report.steps),
        tilt=run.tilt,
        margin=margin if np.isfinite(margin) else None,
        off=off,
        turned=turned,
        kicks=report.kicks,
        held_way=way,
        held_error=error,
        fault=told_fault(run.fault, run.done, report),
    )


def run_walk_trial(item: Json) -> Json:
    """One walk, as `WalkTrial.to_json`; runs in a worker."""
    return judged(item["seed"], walk_once(item)).to_json()


@dataclass(frozen=True, slots=True)
class WalkSetup(Setup[WalkRun, WalkTrial]):
    """What all trials have in common: a walk, or a task with its plan."""

    kind = WalkTrial
    unknown = MappingProxyType(
        {
            "seconds": 0.0,
            "steps": 0,
            "tilt": 0.0,
            "margin": None,
            "off": None,
            "turned": None,
            "kicks": 0,
        }
    )
    walked: Walk | WalkerTask
    noise: WalkNoise
    plant: tuple[str, ...] = ()
    """Settings of the plant, such as "friction=50%"."""
    plan: Plan | None = None
    """Of a task."""
    planned: bool = False
    """Whether a planner made the plan, so that it is no part of what was asked for."""
    faults: tuple[str, ...] = ()
    """Kinds of faults, one of which each trial has; none without."""

    @property
    def work(self) -> Walk | WalkerTask:
        """See `Setup`."""
        return self.walked

    @property
    def name(self) -> str:
        """Of what is walked."""
        return self.walked.name

    @property
    def worker(self) -> Callable[[Json], Json]:
        """One trial."""
        return run_walk_trial

    @property
    def title(self) -> str:
        """The same in words."""
        return f"walks '{self.name}'"

    @property
    def levels(self) -> bool:
        """Whether the plate is to be kept level; in a plan it always is."""
        return not isinstance(self.walked, Walk) or self.walked.level

    def about(self) -> Json:
        """What tells these trials from others; not how many, nor from which seed on."""
        told = self._plain()
        if isinstance(self.walked, WalkerTask):
            told["plan"] = None if self.plan is None or self.planned else self.plan.to_json()
        return told

    def item(self, seed: int) -> Json:
        """One trial for a worker."""
        told = self._plain()
        if self.plan is not None:
            told["plan"] = self.plan.to_json() | {"document": {}}
        return told | {"seed": seed}

    def _plain(self) -> Json:
        told = {"document": self.walked.document, "plant": list(self.plant), "noise": self.noise.to_json()}
        return told | ({"faults": list(self.faults)} if self.faults else {})

    def begun(self, asked: int) -> "WalkTrials":
        """No walks yet."""
        return WalkTrials(self, asked, [])

    def again(
        self, seed: int, kept: Json | None, step: Callable[[str, float | None], None]
    ) -> tuple[WalkRun, WalkTrial]:
        """One walk again."""
        run = walk_once(self.item(seed), step)
        return run, judged(seed, run)


@dataclass(slots=True, repr=False)
class WalkTrials(Trials[WalkSetup, WalkTrial], Jsonable):
    """Walks that ended."""

    setup: Annotated[
        WalkSetup,
        Key("walk", get=attrgetter("name"), kind=str),
        Key(
            "noise",
            get=lambda setup: setup.noise.to_json(),
            kind=dict[str, float],
            meaning="Key to its width, SI units.",
        ),
    ]
    ended: Annotated[list[WalkTrial], Key("trials", after="faults")]

    @property
    @in_json(after="interval")
    def balanced(self) -> Count:
        """Walks whose margin of balance was positive throughout, done or not."""
        return sum(trial.margin is not None and trial.margin > 0.0 for trial in self.ended)

    @property
    @in_json(after="balanced")
    def level(self) -> Count:
        """Walks that came to their end with the plate never more than 0.1 deg from level since the first step."""
        return sum(trial.done and trial.tilt <= LEVEL for trial in self.ended)

    @in_json(after="level")
    def balanced_interval(self) -> tuple[float, float]:
        """Of the share of those that were balanced, 95 % (Wilson)."""
        return wilson_interval(self.balanced, len(self.ended))

    @in_json(after="balanced_interval")
    def causes(self) -> tuple[Cause, ...]:
        """Why runs ended early, the commonest first."""
        return causes_of(self.ended, attrgetter("reason"), attrgetter("steps"))

    @in_json(after="causes")
    def faults(self) -> tuple[FaultRow, ...]:
        """By kind; none in trials without."""
        return fault_rows(self.ended) if self.setup.faults else ()
