"""The laws of a whole body on the same first steps: how near each keeps to its aims, and moments of a run that ticks are timed on."""

import time
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from ....control.whole_body.law import BodyLaw
from ....control.whole_body.programme import HOLDS, SWINGS, Aims
from ....control.whole_body.tree import State
from ....execution.sequencer import Sequencer
from ....planning.problem.codes import MOVE, NEAREST, pack
from ....planning.problem.plan import Plan
from ....planning.problem.problems import plan_family
from ....tasks import load_task
from ....types import Floats
from ..control.believed_tree import believed_tree, joint_limits
from ..control.laws import USUAL, body_law
from ..execution.carrying import Carrying
from ..execution.course import Course
from ..execution.run_trace import TracedBody
from ..execution.settings import usual_gains
from ..planning.task import SpatialTask
from ..robot.contacts import MOST_ROWS
from ..sim.spatial_flaws import SpatialFlaws
from ..sim.spatial_plant import SpatialSim
from .run_plan import body_of

EVERY: Final = 25
"""Ticks between moments that are kept."""


@dataclass(frozen=True, slots=True, eq=False)
class Moment:
    """A robot at a tick, and what is asked of it."""

    state: State
    aims: Aims


@dataclass(frozen=True, slots=True, kw_only=True)
class LawTrial:
    """What became of one law's run, as it truly was."""

    reason: str
    """Why it did not come to its end; empty where it did."""
    motions: int
    """That were carried out."""
    body: float
    """Largest distance of the body from where it was to be [m]."""
    tip: float
    """The same of a tip that swings, before it feels for its hold [m]."""
    slid: float
    """Farthest that a tip that holds on went from where it took hold [m]."""
    torque: float
    """Largest share of a joint's torque that was asked for [-]."""
    off: int
    """Contacts that came off."""


class WatchedBody(TracedBody):
    """A robot whose true errors are noted."""

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self.errors = dict.fromkeys(("body", "tip", "slid"), 0.0)
        self.moments: list[Moment] = []
        self._taken = np.full((len(self.holds), 4), -1.0)

    def tick(self) -> None:
        """As of any, noted."""
        super().tick()
        aims, truth = self.law.aims, self.plant.truth()
        assert truth is not None
        tips = truth.tips
        self._note("body", truth.pose.position - aims.position)
        for limb, does in enumerate(aims.does.tolist()):
            if does == SWINGS and not self._pressed[limb].any():
                self._note("tip", tips[limb] - aims.tip[limb])
            if does == HOLDS and self._taken[limb, 0] == self.holds[limb]:
                self._note("slid", tips[limb] - self._taken[limb, 1:])
            elif does == HOLDS:
                self._taken[limb] = self.holds[limb], *tips[limb]
        if self.ticks % EVERY == 0:
            self.moments.append(Moment(copied(self.law.state), copied(aims)))

    def _note(self, name: str, error: Floats) -> None:
        self.errors[name] = max(self.errors[name], float(np.linalg.norm(error)))


class ClockedSim(SpatialSim):
    """A simulated robot whose physics is timed."""

    def __init__(self, task: SpatialTask) -> None:
        super().__init__(task.robot, task.world, SpatialFlaws())
        self.physics = 0.0
        """Spent in `mj_step` [s]."""
        self._raw_step, self._step = self._step, self._clocked

    def _clocked(self, model: Any, data: Any, steps: int) -> None:
        began = time.perf_counter()
        self._raw_step(model, data, steps)
        self.physics += time.perf_counter() - began


AIMS: Final = {4: ">= 10", 6: ">= 5"}
"""Limbs -> how many times real time a closed loop is to be, for limbs of three joints."""


def time_loop(task: SpatialTask, plan: Plan, rounds: int = 5) -> dict[str, tuple[float, str, str | None]]:
    """How fast a plan is carried out as `clamber run` does it, its samples included: measure -> median, unit and aim."""
    times = []
    for _ in range(rounds + 1):  # the first loads the kernels
        plant = ClockedSim(task)
        body = body_of(task, plant, plant.flaws, USUAL)
        performer = Carrying(body, task, Course.of(task, plan))
        began = time.perf_counter()
        report = Sequencer(performer).run()
        taken = time.perf_counter() - began
        times.append((report.seconds / taken, plant.physics / taken, taken / plant.physics))
    real, share, ratio = np.median(times[1:], axis=0).tolist()
    return {
        "closed loop, one core": (real, "x real time", AIMS.get(len(task.robot.limb_names))),
        "share of mj_step in it": (share, "share", None),
        "closed loop over its mj_step": (ratio, "ratio", "<= 2"),
    }


def copied(arrays: Any) -> Any:
    """A tuple of arrays, with copies of them."""
    return type(arrays)(*(array.copy() for array in arrays))


def spatial_task(name: str) -> SpatialTask:
    """A task of a robot in space, by its name."""
    task = load_task(name)
    assert isinstance(task, SpatialTask)
    return task


def first_steps(task: SpatialTask) -> Plan:
    """A short plan of a task: a move of the body, a limb to another hold, as far as that can be, another move."""
    problem = plan_family(task).problem(task)
    moves = [pack(MOVE, 0, argument) for argument in range(5)]
    limbs = range(len(task.robot.limb_names))
    nearest = [pack(NEAREST, limb, rank) for rank in range(task.step.nearest) for limb in limbs]
    codes: list[int] = []
    for choices in (moves, nearest, moves):
        codes += [code for code in choices if problem.replay([*codes, code]).ok][:1]
    return Plan.of_codes(task, codes)


def try_law(task: SpatialTask, plan: Plan, law: str) -> tuple[LawTrial, list[Moment]]:
    """Stand, and carry a plan out by a law; what became of it, and moments of the run."""
    plant = SpatialSim(task.robot, task.world, SpatialFlaws())
    body = body_of(task, plant, plant.flaws, law, WatchedBody)
    assert isinstance(body, WatchedBody)
    report = Sequencer(Carrying(body, task, Course.of(task, plan))).run()
    truth = plant.truth()
    trial = LawTrial(
        reason=report.reason,
        motions=sum(motion.outcome == "ok" for motion in report.motions),
        torque=report.torque,
        off=len(truth.broken),
        **body.errors,
    )
    return trial, body.moments


def law_at(task: SpatialTask, moment: Moment, law: str = USUAL) -> BodyLaw:
    """A law of a task's robot at a moment."""
    tree = believed_tree(task.robot, task.world.gravity)
    made = body_law(law)(tree, joint_limits(task.robot), usual_gains(task.robot), MOST_ROWS)
    arrays: tuple[Any, ...] = (*made.state, *made.aims)
    for array, values in zip(arrays, (*moment.state, *moment.aims), strict=True):
        array[...] = values
    made.look()
    return made
