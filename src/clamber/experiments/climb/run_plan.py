"""One plan carried out in contact dynamics: the plant with its flaws, pegs that are not where the map says, and what came out."""

import time
from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...actions.plan import Plan
from ...errors import SpecError
from ...execution.climb.climb_trace import TOPIC, ClimbTrace, TracedClimber, limb_notes, report_notes
from ...execution.climb.course import climbable, lay_course
from ...execution.climb.sequencer import ClimbReport, Progress, Replan, Sequencer
from ...execution.log_stream import LogStream
from ...sim.limb_flaws import LimbFlaws, PlantError
from ...tasks import Task
from ...tasks.limbed import LimbedTask
from ...types import Floats, Json
from ...units import parse_quantity
from ..limb.flaw_texts import named_flaws, read_flaws
from .plants import climbing_plant, truth_of

PLANT: str = "plant."
"""First word of settings that change the plant."""
PHYSICS_RATE: float = 1000.0
"""Of the contact dynamics [Hz]."""
LEAST_MAP_ERROR: float = 0.004
"""What a hook may stop from its hold's place however exact the map is [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class ClimbRun:
    """A plan that was carried out."""

    task: LimbedTask
    plan: Plan
    report: ClimbReport
    trace: ClimbTrace
    wall_seconds: float
    """That it took."""

    def to_json(self) -> Json:
        """Plain data."""
        return self.report.to_json() | {"task": self.task.name, "wall_seconds": self.wall_seconds}


def split_settings(settings: Sequence[str]) -> tuple[list[str], list[str]]:
    """Those of the task, and those of the plant without their "plant."."""
    plant = [text[len(PLANT) :] for text in settings if text.startswith(PLANT)]
    return [text for text in settings if not text.startswith(PLANT)], plant


def climbing_task(task: Task) -> LimbedTask:
    """The task under the rules that can be carried out.

    Raises:
        SpecError: If it is none of a limbed climber.
    """
    if not isinstance(task, LimbedTask):
        raise SpecError(f"task '{task.name}'", "robot.family", "walker", "must be 'limbed': only climbers can be run")
    return climbable(task)


def climbing_flaws(task: LimbedTask, settings: Sequence[str], seed: int | None = None) -> LimbFlaws:
    """The nominal plant of a task's robot with settings such as "backlash=1deg".

    Raises:
        PlantError: If one of them cannot be.
    """
    nominal = named_flaws("nominal", task.robot).with_changes(physics_rate=PHYSICS_RATE)
    return read_flaws(nominal, settings, seed)


def read_peg_error(text: str) -> float:
    """The largest error of a peg's place along each axis, from a text such as "3mm" [m].

    Raises:
        UnitError: If it is no length.
        PlantError: If it is less than nothing.
    """
    error = parse_quantity(text, "length")
    if error < 0.0:
        raise PlantError("peg error", text, "must be 0 mm or more")
    return error


def true_pegs(task: LimbedTask, error: float, seed: int) -> Floats | None:
    """Where the pegs truly are: each coordinate off by up to `error` [m] either way, shape (n_holds, 2); None: as the map says."""
    if error == 0.0:
        return None
    places = task.world.positions()
    return places + np.random.default_rng(seed).uniform(-error, error, places.shape)


def run_plan(
    task: LimbedTask,
    plan: Plan,
    flaws: LimbFlaws,
    *,
    peg_error: float = 0.0,
    seed: int = 0,
    force: bool = False,
    replan: Replan | None = None,
    progress: Progress | None = None,
    label: str = "plan",
    log: Path | None = None,
    plant: str = "torques",
) -> ClimbRun:
    """Carry a plan out.

    Args:
        task: Robot, board and start.
        plan: The plan.
        flaws: Of the plant.
        peg_error: Largest error of a peg's place along each axis [m].
        seed: Of the pegs' places.
        force: Whether to carry out a plan that something speaks against.
        replan: What plans again where a hold cannot be had.
        progress: Told before each action.
        label: What errors call the plan.
        log: An .mcap file that grows as the robot climbs (`execution.log_stream`).
        plant: By name or address, see `climbing_plant`.

    Raises:
        FileError: If the log cannot be written.
        PlanRefusedError: If something speaks against the plan and it is not forced.
        SpecError: If an action is none that the task's robot and board have.
        StartError: If the start violates a hard check.
    """
    began = time.perf_counter()
    course = lay_course(task, plan, label)
    with climbing_plant(plant, task, flaws, true_pegs(task, peg_error, seed)) as moved:
        climber = TracedClimber(
            task.robot, task.world, moved, map_error=LEAST_MAP_ERROR + peg_error, truth=truth_of(moved)
        )
        sequencer = Sequencer(climber, course, replan=replan, force=force, progress=progress)
        stream = None if log is None else LogStream(log, climber.titles, limb_notes(climber.limbs), TOPIC)
        with nullcontext() if stream is None else stream:
            climber.told = None if stream is None else stream.add
            report = sequencer.run()
            notes = report.to_json() | {"task": task.name, "peg_error": peg_error, "seed": seed}
            if stream is not None:
                stream.add(climber.last())
                stream.finish(report_notes(notes))
    return ClimbRun(task, plan, report, climber.trace(notes), time.perf_counter() - began)
