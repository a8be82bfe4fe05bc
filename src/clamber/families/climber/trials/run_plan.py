"""One plan carried out in contact dynamics: the plant with its flaws, pegs that are not where the map says, and what came out."""

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass
from operator import attrgetter
from pathlib import Path
from typing import Annotated

import numpy as np

from ....execution.fault import FIRST_HOLDS, Failing, Fault
from ....execution.faulty_plants import FaultyBody
from ....execution.log_scene import LoggedScene
from ....execution.log_stream import LogGap, WantedLog, growing_log
from ....execution.plant import BodyPlant
from ....execution.sequencer import Sequencer
from ....json_form import HIDDEN, INLINE, Jsonable, Key
from ....notebook import Pictured
from ....planning.problem.plan import Plan
from ....sim.flaw_texts import named_flaws, read_flaws
from ....sim.limb_flaws import LimbFlaws
from ....tasks import Task
from ....trials.dynamics import TaskRun
from ....types import Floats
from ..execution.body_gains import USUAL, BodyGains
from ..execution.climb_report import ClimbReport
from ..execution.climb_scene import climb_scene
from ..execution.climb_trace import TOPIC, ClimbTrace, TracedClimber, limb_notes
from ..execution.climbing import Climbing, Progress, Replan
from ..execution.executable_plan import climbable, lay_course
from ..planning.task import LimbedTask, limbed
from .noise import NO_NOISE, Drawn, Noise, assumed_backlash, check_noise, draw_for, terrain_covariance, true_places
from .plants import climbing_plant, drawn_plant, truth_of
from .warm_up import warm_up


def failing_of(task: LimbedTask, plan: Plan) -> Failing:
    """Encoders, motors, and the holds that the plan comes to first."""
    robot = task.robot
    names, spans = robot.joint_names, [joint.upper - joint.lower for joint in robot.joints]
    taken = [*task.start.holds.values(), *(action.hold for action in plan.actions if action.hold is not None)]
    holds = tuple(dict.fromkeys(hold for hold in taken if hold))[:FIRST_HOLDS]
    sensors = dict(zip(names, spans, strict=True)) | {"body": math.tau}
    return Failing(sensors=sensors, motors=names, holds=holds, weight=robot.weight)


PHYSICS_RATE: float = 1000.0
"""Of the contact dynamics [Hz]."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ClimbRun(Jsonable, TaskRun, Pictured):
    """A climb that was carried out; exit code 1 where it is not done."""

    task: Annotated[LimbedTask, Key(get=attrgetter("name"), kind=str, after="actions")]
    plan: Annotated[Plan, HIDDEN]
    report: Annotated[ClimbReport, INLINE]
    trace: Annotated[ClimbTrace, HIDDEN]
    drawn: Annotated[Drawn, HIDDEN]
    """How far things truly were from what was believed."""
    wall_seconds: Annotated[float, Key(after="task")]
    """That it took, without compiling or loading kernels and without looking for new plans on the way."""
    fault: Annotated[Fault | None, HIDDEN] = None
    """That the robot had."""
    log_gap: Annotated[LogGap | None, Key(after="wall_seconds", may_be_missing=True)] = None
    """What its log lacks, there only if it could not be written to its end; None: nothing, or there is no log."""

    @property
    def scene(self) -> LoggedScene:
        """See `CarriedOut`."""
        return climb_scene(self.task, true=self.trace.true_pose is not None)

    @property
    def true_pegs(self) -> Floats | None:
        """Where the holds truly are, shape (n_holds, 2) [m], NaN for those that are missing; None: all where they are mapped."""
        mapped, places = self.task.world.positions(), true_places(self.task, self.drawn)
        places[self.drawn.missing] = np.nan
        return None if np.array_equal(places, mapped) else places


def action_told(step: int, steps: int, title: str, time: float) -> tuple[str, float]:
    """The action that begins, `time` [s] after the start, in words, and the share of the plan that is done [-]."""
    return f"action {step} of {steps}: {title}, at {time:.0f} s", (step - 1) / max(steps, 1)


def climbing_task(task: Task) -> LimbedTask:
    """The task under the rules that can be carried out.

    Raises:
        SpecError: If it is none of a limbed climber.
    """
    return climbable(limbed(task, f"task '{task.name}'"))


def climbing_flaws(task: LimbedTask, settings: Sequence[str], seed: int | None = None) -> LimbFlaws:
    """The nominal plant of a task's robot with settings such as "backlash=1deg".

    Raises:
        PlantError: If one of them cannot be.
    """
    nominal = named_flaws("nominal", task.robot).with_changes(physics_rate=PHYSICS_RATE)
    return read_flaws(nominal, settings, seed)


def run_plan(
    task: LimbedTask,
    plan: Plan,
    flaws: LimbFlaws,
    *,
    noise: Noise = NO_NOISE,
    seed: int = 0,
    force: bool = False,
    replan: Replan | None = None,
    progress: Progress | None = None,
    label: str = "plan",
    log: Path | WantedLog | None = None,
    plant: str = "torques",
    gains: BodyGains = USUAL,
    fault: Fault | None = None,
) -> ClimbRun:
    """Carry a plan out.

    Args:
        task: Robot, board and start.
        plan: The plan.
        flaws: Of the plant, as the controller believes them.
        noise: By how much the plant may differ from that.
        seed: Of how much it does.
        force: Whether to carry out a plan that something speaks against.
        replan: What plans again where a hold cannot be had.
        progress: Told before each action.
        label: What errors call the plan.
        log: An .mcap file that grows as the robot climbs (`execution.log_stream`).
        plant: By name or address, see `climbing_plant`.
        gains: How body and limbs are controlled.
        fault: That the robot has; None: none.

    Raises:
        FileError: If the log cannot be made; one that cannot be written to its end does not end the run.
        PlanRefusedError: If something speaks against the plan and it is not forced.
        SpecError: If an action is none that the task's robot and board have.
        StartError: If the start violates a hard check.
        NoiseError: If a width is more than what there is of it.
    """
    warm_up()
    began, planning = time.perf_counter(), 0.0

    def timed_replan(task: LimbedTask) -> Plan | None:
        nonlocal planning
        assert replan is not None
        asked = time.perf_counter()
        found = replan(task)
        planning += time.perf_counter() - asked
        return found

    course = lay_course(task, plan, label)
    check_noise(noise, task.robot, flaws)
    drawn = draw_for(task, noise, seed)
    with climbing_plant(plant, task, lambda: drawn_plant(task, flaws, drawn)) as moved:
        body = moved if fault is None else FaultyBody(moved, fault, task.robot.inertias)
        climber = believing_climber(task, body, noise, drawn, gains)
        again = None if replan is None else timed_replan
        sequencer = Sequencer(Climbing(climber, course, replan=again, force=force), progress=progress)
        scene = climb_scene(task, true=climber.truth is not None)
        with growing_log(
            log, climber.samples, climber.titles, limb_notes(task.robot.limb_names), TOPIC, scene
        ) as finish:
            report = sequencer.run()
            notes = report.to_json() | {"task": task.name, "noise": noise.to_json(), "seed": seed}
            if fault is not None:
                notes |= {"fault": fault.to_json()}
            gap = finish(notes)
    taken = time.perf_counter() - began - planning
    return ClimbRun(task, plan, report, climber.trace(notes), drawn, taken, fault, gap)


def believing_climber(
    task: LimbedTask, plant: BodyPlant, noise: Noise, drawn: Drawn, gains: BodyGains = USUAL
) -> TracedClimber:
    """The controller of a plant as it was drawn: it knows the nominal robot, and how far off its map may be."""
    return TracedClimber(
        task.robot,
        task.world,
        plant,
        gains=gains,
        map_error=noise.widths["peg_error"],
        terrain=terrain_covariance(task, noise.widths["terrain"], noise.widths["tilt"]),
        backlash=assumed_backlash(task.robot, drawn),
        truth=truth_of(plant),
        watched=True,
    )
