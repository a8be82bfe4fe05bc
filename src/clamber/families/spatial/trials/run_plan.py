"""One plan of a robot in space carried out in contact dynamics."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated

from ....execution.log_stream import LogGap
from ....execution.plant import HoldBreak
from ....execution.sequencer import Sequencer
from ....json_form import HIDDEN, INLINE, Jsonable, Key
from ....planning.problem.plan import Plan
from ..control.believed_tree import believed_tree
from ..execution.carrying import Carrying
from ..execution.carrying_report import CarryingReport
from ..execution.course import Course
from ..execution.estimated_base import EstimatedBase
from ..execution.limbed_body import LimbedBody
from ..execution.settings import Pace
from ..planning.task import SpatialTask
from ..sim.spatial_flaws import Deviations, SpatialFlaws
from ..sim.spatial_plant import SpatialSim


@dataclass(frozen=True, slots=True, kw_only=True)
class SpatialRun(Jsonable):
    """A plan that was carried out."""

    task: Annotated[SpatialTask, Key(get=lambda task: task.name, kind=str)]
    plan: Annotated[Plan, HIDDEN]
    report: Annotated[CarryingReport, INLINE]
    wall_seconds: float
    """That it took."""
    broken: tuple[HoldBreak, ...] = ()
    """Contacts that came off, truly."""
    log_gap: Annotated[LogGap | None, HIDDEN] = None

    @property
    def work(self) -> SpatialTask:
        """What was carried out."""
        return self.task

    @property
    def trace(self) -> None:
        """None is kept."""
        return None

    @property
    def done(self) -> bool:
        """Whether the plan came to its end."""
        return self.report.done

    @property
    def reason(self) -> str:
        """Why not; empty where it did."""
        return self.report.reason


def run_plan(
    task: SpatialTask,
    plan: Plan,
    *,
    flaws: SpatialFlaws | None = None,
    deviations: Deviations | None = None,
    progress: Callable[[int, int], None] | None = None,
    label: str = "plan",
) -> SpatialRun:
    """Carry a plan out.

    Args:
        task: Robot and world.
        plan: Of that task.
        flaws: Of the plant; None: it is ideal.
        deviations: How robot and world truly are; None: as believed.
        progress: Told before each motion: the action that it begins with, and how many there are.
        label: What errors call the plan.

    Raises:
        ClamberError: If an action is none of the task's.
    """
    began = time.perf_counter()
    course = Course.of(task, plan, label)
    plant = SpatialSim(task.robot, task.world, flaws or SpatialFlaws(), deviations)
    sensors = plant.flaws
    belief = EstimatedBase(
        task.robot,
        task.world,
        believed_tree(task.robot, task.world.gravity),
        plant.period,
        late=sensors.late * plant.period,
        coarse=sensors.encoder_step > 0.0,
    )
    body = LimbedBody(task.robot, task.world, plant, belief, Pace.of(task.robot), task.rules.lift)
    report = Sequencer(Carrying(body, course), progress=progress).run()
    seconds = time.perf_counter() - began
    return SpatialRun(task=task, plan=plan, report=report, wall_seconds=seconds, broken=plant.truth().broken)
