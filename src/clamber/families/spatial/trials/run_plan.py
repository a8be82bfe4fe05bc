"""One plan of a robot in space carried out in contact dynamics."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from ....execution.fault import Fault
from ....execution.log_scene import LoggedScene
from ....execution.log_stream import (
    LogGap,
    WantedLog,
    growing_log,
)
from ....execution.plant import HoldBreak
from ....execution.sequencer import Sequencer
from ....json_form import (
    HIDDEN,
    INLINE,
    Jsonable,
    Key,
)
from ....notebook import Pictured
from ....planning.problem.plan import Plan
from ....trials.dynamics import TaskRun
from ....types import Floats
from ..control.believed_tree import believed_tree, joint_inertias
from ..control.laws import USUAL
from ..execution.carrying import Carrying, Replan
from ..execution.carrying_report import CarryingReport
from ..execution.course import Course
from ..execution.estimated_base import EstimatedBase
from ..execution.faulty_spatial import FaultySpatial
from ..execution.plant import SpatialPlant
from ..execution.run_trace import TOPIC, RunTrace, TracedBody
from ..execution.settings import Pace
from ..execution.space_scene import space_scene
from ..planning.task import SpatialTask
from ..sim.spatial_flaws import Deviations, SpatialFlaws
from ..sim.spatial_plant import SpatialSim


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class SpatialRun(Jsonable, TaskRun, Pictured):
    """A plan that was carried out."""

    task: Annotated[SpatialTask, Key(get=lambda task: task.name, kind=str)]
    plan: Annotated[Plan, HIDDEN]
    report: Annotated[CarryingReport, INLINE]
    trace: Annotated[RunTrace, HIDDEN]
    """What happened."""
    wall_seconds: float
    """That it took."""
    broken: tuple[HoldBreak, ...] = ()
    """Contacts that came off, truly."""
    fault: Annotated[Fault | None, HIDDEN] = None
    """That the robot had."""
    log_gap: Annotated[LogGap | None, HIDDEN] = None

    @property
    def scene(self) -> LoggedScene:
        """See `CarriedOut`."""
        return space_scene(self.task, true=self.trace.true_pose is not None)


@dataclass(frozen=True, slots=True)
class Control:
    """Who controls a run."""

    law: str = USUAL
    """Of the whole body, by name."""
    replan: Replan | None = None
    """Makes another plan for the rest of a task where a hold cannot be had; None: none is made."""


def body_of(
    task: SpatialTask, plant: SpatialPlant, sensors: SpatialFlaws, law: str, kind: type[TracedBody] = TracedBody
) -> TracedBody:
    """The robot of a run, which estimates where it is.

    Args:
        task: Robot and world, as believed.
        plant: What moves.
        sensors: Their delay, encoders and play, as data sheets say.
        law: Of the whole body, by name.
        kind: Class of the body.
    """
    belief = EstimatedBase(
        task.robot,
        task.world,
        believed_tree(task.robot, task.world.gravity),
        sensors.period,
        late=sensors.late * sensors.period,
        coarse=sensors.encoder_step > 0.0,
        play=sensors.backlash,
    )
    return kind(task.robot, task.world, plant, belief, Pace.of(task.robot), task.rules.lift, law=law)


def failing_plant(task: SpatialTask, plant: SpatialPlant, fault: Fault, joints: Floats) -> FaultySpatial:
    """The plant with a fault; `joints`: positions about which it is to hold its posture by itself, shape (n,)."""
    inertias = joint_inertias(believed_tree(task.robot, task.world.gravity), joints)
    return FaultySpatial(plant, fault, task.robot.chains, inertias)


def run_plan(
    task: SpatialTask,
    plan: Plan,
    *,
    flaws: SpatialFlaws | None = None,
    deviations: Deviations | None = None,
    progress: Callable[[int, int], None] | None = None,
    log: Path | WantedLog | None = None,
    control: Control = Control(),
    label: str = "plan",
) -> SpatialRun:
    """Carry a plan out.

    Args:
        task: Robot and world.
        plan: Of that task.
        flaws: Of the plant; None: it is ideal.
        deviations: How robot and world truly are, and what fails; None: as believed.
        progress: Told before each motion: the action that it begins with, and how many there are.
        log: An .mcap file that grows as the robot moves (`execution.log_stream`).
        control: Law, and who plans again.
        label: What errors call the plan.

    Raises:
        ClamberError: If an action is none of the task's, or no law has that name.
    """
    began = time.perf_counter()
    course = Course.of(task, plan, label)
    fault = None if deviations is None else deviations.fault
    plant = SpatialSim(task.robot, task.world, flaws or SpatialFlaws(), deviations)
    moved = plant if fault is None else failing_plant(task, plant, fault, course.start.joints)
    body = body_of(task, moved, plant.flaws, control.law)
    scene = space_scene(task, true="base x true [m]" in body.titles)
    with growing_log(log, body.samples, body.titles, body.named.notes(), TOPIC, scene) as finish:
        report = Sequencer(Carrying(body, task, course, control.replan), progress=progress).run()
        notes = report.to_json() | {"task": task.name} | ({} if fault is None else {"fault": fault.to_json()})
        gap = finish(notes)
    return SpatialRun(
        task=task,
        plan=plan,
        report=report,
        trace=body.trace(notes),
        wall_seconds=time.perf_counter() - began,
        broken=plant.truth().broken,
        fault=fault,
        log_gap=gap,
    )
