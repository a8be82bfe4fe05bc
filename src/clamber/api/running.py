"""Carry a task, a plan or a walk out in contact dynamics."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import PlannerError
from ..family import families, family_of
from ..planning.problem.plan import Plan
from ..planning.result import PlanResult
from ..tasks import Task, load_task
from ..trials.dynamics import CarriedOut, RunEvents, RunRequest
from ..trials.work import dynamics_of

if TYPE_CHECKING:
    from ..families.walker.planning import Walk


def run(
    what: Task | Walk | Plan | PlanResult | str,
    *,
    planner: str = "auto",
    noise: Sequence[str] = (),
    plant: Sequence[str] = (),
    seed: int = 0,
    replan: bool = True,
    log: str | Path | None = None,
) -> CarriedOut:
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
    work, found = _opened(what)
    dynamics = dynamics_of(family_of(work))
    file = None if log is None else Path(log)
    asked = RunRequest(planner=planner, noise=tuple(noise), plant=tuple(plant), seed=seed, replan=replan, log=file)
    dynamics.check(work, asked)
    made: CarriedOut = dynamics.run(work, found, asked, RunEvents())
    return made


def _opened(what: Task | Walk | Plan | PlanResult | str) -> tuple[Any, Plan | None]:
    """A task, with its plan if there is one, or what a family can carry out besides."""
    if isinstance(what, str):
        other = next((work for family in families() if (work := family.other_work(what)) is not None), None)
        return (load_task(what) if other is None else other), None
    if isinstance(what, PlanResult):
        if not what.has_plan:
            raise PlannerError(what.planner, what.task.name, f"there is no plan to carry out: {what.reason}")
        return what.task, what.plan
    if isinstance(what, Plan):
        return what.rebuild_task(), what
    return what, None
