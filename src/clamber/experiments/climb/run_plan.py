"""One plan carried out in contact dynamics: the plant with its flaws, pegs that are not where the map says, and what came out."""

import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...actions.plan import Plan
from ...actions.plan_source import is_plan, open_plan
from ...errors import SpecError
from ...execution.climb.climb_trace import ClimbTrace, TracedClimber
from ...execution.climb.course import climbable, lay_course
from ...execution.climb.sequencer import ClimbReport, Progress, Replan, Sequencer
from ...sim.climber_plant import ClimberPlant
from ...sim.limb_flaws import LimbFlaws
from ...tasks import Task, load_task
from ...tasks.limbed import LimbedTask
from ...types import Json
from ..limb.flaw_texts import named_flaws, read_flaws
from .noise import (
    NO_NOISE,
    Drawn,
    Noise,
    assumed_backlash,
    check_noise,
    draw,
    drawn_flaws,
    drawn_hook,
    drawn_robot,
    encoder_offsets,
)

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
    drawn: Drawn
    """How far things truly were from what was believed."""
    wall_seconds: float
    """That it took."""

    def to_json(self) -> Json:
        """Plain data."""
        return self.report.to_json() | {"task": self.task.name, "wall_seconds": self.wall_seconds}


def split_settings(settings: Sequence[str]) -> tuple[list[str], list[str]]:
    """Those of the task, and those of the plant without their "plant."."""
    plant = [text[len(PLANT) :] for text in settings if text.startswith(PLANT)]
    return [text for text in settings if not text.startswith(PLANT)], plant


def open_climb(what: str, task: str | None, settings: Sequence[str]) -> tuple[LimbedTask, Plan | None, tuple[str, ...]]:
    """A task, or a plan and its task, that can be carried out, and settings of its plant.

    Args:
        what: A task's name or file, or a plan's.
        task: A task in place of the one that the plan names.
        settings: Texts "key=value" for task and plant.

    Returns:
        The task under the rules that can be carried out, the plan if `what` is one, and settings of the plant such as "backlash=1deg".

    Raises:
        SpecError: If the task is none of a limbed climber, or a plan's task is given beside a task.
        ClamberError: As `open_plan` and `load_task`.
    """
    for_task, for_plant = split_settings(settings)
    if is_plan(what):
        opened = open_plan(what, task, for_task)
        return climbing_task(opened.task), opened.plan, tuple(for_plant)
    if task is not None:
        raise SpecError(what, "--task", task, "is for a plan; this is a task itself")
    return climbing_task(load_task(what, for_task)), None, tuple(for_plant)


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

    Raises:
        PlanRefusedError: If something speaks against the plan and it is not forced.
        SpecError: If an action is none that the task's robot and board have.
        StartError: If the start violates a hard check.
        NoiseError: If a width is more than what there is of it.
    """
    began = time.perf_counter()
    course = lay_course(task, plan, label)
    check_noise(noise, task.robot, flaws)
    started = set(course.holds(0).values())
    known = np.array([hold.number in started for hold in task.world.holds])
    drawn = draw(noise, task.robot, known, seed)
    climber = drawn_climber(task, flaws, noise, drawn)
    sequencer = Sequencer(climber, course, replan=replan, force=force, progress=progress)
    report = sequencer.run()
    notes = report.to_json() | {"task": task.name, "noise": noise.to_json(), "seed": seed}
    return ClimbRun(task, plan, report, climber.trace(notes), drawn, time.perf_counter() - began)


def drawn_climber(task: LimbedTask, flaws: LimbFlaws, noise: Noise, drawn: Drawn) -> TracedClimber:
    """A robot as it was drawn, under a controller that knows the nominal one and how far off its map may be."""
    plant = ClimberPlant(
        drawn_robot(task.robot, drawn),
        task.world,
        drawn_flaws(flaws, drawn),
        pegs=task.world.positions() + drawn.pegs,
        shape=drawn_hook(drawn),
        offsets=encoder_offsets(drawn),
    )
    return TracedClimber(
        task.robot,
        task.world,
        plant,
        map_error=LEAST_MAP_ERROR + noise.widths["peg_error"],
        backlash=assumed_backlash(task.robot, drawn),
        truth=plant.truth,
    )
