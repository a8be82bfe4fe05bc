"""Carry a task, a plan or a walk out in contact dynamics."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ..errors import PlannerError
from ..families.climber.trials.noise import NO_NOISE, read_noise
from ..families.climber.trials.planning import plan_to_climb, replanner
from ..families.climber.trials.rehearsal import rehearse
from ..families.climber.trials.run_plan import ClimbRun, climbing_flaws, climbing_task, run_plan
from ..families.walker.planning import Walk, is_walk, load_walk
from ..families.walker.planning.task import WalkerTask
from ..families.walker.trials.noise import named_walk_noise, read_walk_noise
from ..families.walker.trials.planned import careful, lay_plan, walk_of
from ..families.walker.trials.run_walk import WalkRun, run_walk, walk_flaws
from ..planning.planners import plan_task
from ..planning.problem.plan import Plan
from ..planning.result import PlanResult
from ..tasks import Task, load_task

PLAN_SECONDS = 600.0
"""Most time of each search for a plan [s]."""


def run(
    what: Task | Walk | Plan | PlanResult | str,
    *,
    planner: str = "auto",
    noise: Sequence[str] = (),
    plant: Sequence[str] = (),
    seed: int = 0,
    replan: bool = True,
    log: str | Path | None = None,
) -> ClimbRun | WalkRun:
    """Carry a task, a plan or a walk out on a simulated robot that differs from what its controller believes by `noise`.

    Args:
        what: A task, which is planned first (with room for what the dynamics do), a plan, a planner's answer, a walk, or the name or
            file of a task or a walk.
        planner: Of a task without a plan (`clamber list planners`).
        noise: Texts "key=width", such as "peg_error=3mm" or "friction=30%"; "usual" for all at once.
        plant: Texts "key=value" that change the simulated robot, such as "backlash=1deg" of climbers or "friction=50%" of walkers.
        seed: Of planner and noise; the same seed gives the same run.
        replan: Whether a climber plans again where a hold cannot be had.
        log: An .mcap file that grows while a climber climbs.

    Returns:
        What happened: `done`, `reason`, `report` with every action or step, `trace`, `to_json()`. SI units, world frame.

    Raises:
        PlannerError: If there is no plan for the task that can be carried out.
        ClamberError: If something cannot be read, or something speaks against the plan.
    """
    thing: Any = _opened(what)
    if isinstance(thing, Walk):
        return _walk(thing, noise, plant, seed)
    task, plan = thing
    if isinstance(task, WalkerTask):
        return _planned_walk(task, plan, planner, noise, plant, seed)
    return _climb(task, plan, planner, noise, plant, seed, replan, None if log is None else Path(log))


def _opened(what: Task | Walk | Plan | PlanResult | str) -> Walk | tuple[Task, Plan | None]:
    """A walk, or a task with its plan if there is one."""
    if isinstance(what, str):
        return load_walk(what) if is_walk(what) else (load_task(what), None)
    if isinstance(what, Walk):
        return what
    if isinstance(what, PlanResult):
        if not what.has_plan:
            raise PlannerError(what.planner, what.task.name, f"there is no plan to carry out: {what.reason}")
        return what.task, what.plan
    if isinstance(what, Plan):
        return what.rebuild_task(), what
    return what, None


def _climb(
    task: Task,
    plan: Plan | None,
    planner: str,
    noise: Sequence[str],
    plant: Sequence[str],
    seed: int,
    replan: bool,
    log: Path | None,
) -> ClimbRun:
    climb = climbing_task(task)
    flaws = climbing_flaws(climb, plant)
    widths = read_noise(NO_NOISE, noise)
    if plan is None:
        plan = plan_to_climb(
            climb, planner, seconds=PLAN_SECONDS, seed=seed, rehearse=lambda task, plan: rehearse(task, plan, flaws)
        )
    if plan is None:
        raise PlannerError(planner, climb.name, "it found no plan that can be carried out; nothing has moved")
    again = replanner(planner, seconds=PLAN_SECONDS, seed=seed) if replan else None
    return run_plan(climb, plan, flaws, noise=widths, seed=seed, replan=again, log=log)


def _planned_walk(
    task: WalkerTask, plan: Plan | None, planner: str, noise: Sequence[str], plant: Sequence[str], seed: int
) -> WalkRun:
    if plan is None:
        task = careful(task)
        result = plan_task(task, planner, seed=seed, seconds=PLAN_SECONDS)
        if not result.has_plan:
            raise PlannerError(planner, task.name, f"no plan that can bear to be walked: {result.reason}")
        plan = result.plan
    walk, lay = walk_of(task), lay_plan(task, plan)
    widths = read_walk_noise(named_walk_noise("none"), noise)
    return run_walk(walk, walk_flaws(walk, plant), noise=widths, seed=seed, lay=lay)


def _walk(walk: Walk, noise: Sequence[str], plant: Sequence[str], seed: int) -> WalkRun:
    widths = read_walk_noise(named_walk_noise("none"), noise)
    return run_walk(walk, walk_flaws(walk, plant), noise=widths, seed=seed)
