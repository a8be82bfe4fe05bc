"""Carry a task, a plan or a walk out in contact dynamics."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..planning.problem.plan import Plan
from ..planning.result import PlanResult
from ..tasks import Task
from ..trials.dynamics import CarriedOut, RunEvents, RunRequest
from .opening import work_of
from .options import check_kind, texts

if TYPE_CHECKING:
    from ..families.walker.planning import Walk


def run(
    what: Task | Walk | Plan | PlanResult | str | Path,
    *,
    planner: str = "auto",
    noise: str | Sequence[str] = (),
    plant: str | Sequence[str] = (),
    seed: int = 0,
    law: str | None = None,
    replan: bool = True,
    log: str | Path | None = None,
) -> CarriedOut:
    """Carry a task, a plan or a walk out on a simulated robot that differs from what its controller believes by `noise`.

    Args:
        what: A task, which is planned first (with room for what the dynamics do), a plan, a planner's answer, a walk, or the name or
            file of a task, a plan or a walk.
        planner: Of a task without a plan (`clamber list planners`).
        noise: Texts "key=width", such as "peg_error=3mm" or "friction=30%"; "usual" for all at once.
        plant: Texts "key=value" that change the simulated robot, such as "backlash=1deg", or "friction=50%" of walkers.
        seed: Of planner and noise; the same seed gives the same run.
        law: Of the whole body of a robot in space, such as "operational-space"; None: "whole-body".
        replan: Whether a robot plans again where a hold cannot be had.
        log: An .mcap file that grows while a climber climbs, or a robot in space moves.

    Returns:
        What happened: `done`, `reason`, `report` with every action or step, `trace`, `to_json()`. SI units, world frame.

    Raises:
        PlannerError: If there is no plan for the task that can be carried out.
        ClamberError: If something cannot be read, or something speaks against the plan.
    """
    check_kind("law", law, str | None)
    work = work_of(what, plant=texts("plant", plant))
    asked = RunRequest(
        planner=planner,
        noise=texts("noise", noise),
        plant=work.plant,
        seed=seed,
        law=law,
        replan=replan,
        log=None if log is None else Path(log),
    )
    work.check(asked)
    made: CarriedOut = work.dynamics.run(work.item, work.plan, asked, RunEvents())
    return made
