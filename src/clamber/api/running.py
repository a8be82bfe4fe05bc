"""Carry a task, a plan or a walk out in contact dynamics: once, many times under noise, or so often that a plan learns from it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

from ..planning.problem.plan import Plan
from ..planning.result import PlanResult
from ..tasks import Task
from ..trials.dynamics import CarriedOut, RunEvents, RunRequest, TrialsRequest
from ..trials.held_out import are_held_out
from ..trials.trial_runs import Trials, run_trials
from .opening import work_of
from .options import Crew, Runs, check_kind, check_options, executor_for, store_of, texts

if TYPE_CHECKING:
    from ..families.climber.trials.plan_repair import LearnedPlan
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


REHEARSED: int = 500_000
"""First seed of rehearsals unless stated: far from those that trials begin with."""


def trials(
    what: Task | Plan | PlanResult | str | Path | Any,
    n: int = 24,
    *,
    seed: int = 0,
    noise: str | Sequence[str] = (),
    plant: str | Sequence[str] = (),
    fault: str | Sequence[str] = (),
    **options: Unpack[Runs],
) -> Trials[Any, Any]:
    """Carry a task, a plan or a walk out many times under noise: how often it succeeds, and why it fails.

    Args:
        what: As `run` takes it.
        n: How many runs.
        seed: Of the first run; each further one has the next.
        noise: Texts "key=width" that differ from the usual widths, such as "friction=30%"; "none" first leaves all others out.
        plant: Texts "key=value" that change the simulated robot.
        fault: Kinds of faults, one of which each run has.
        options: `workers` (processes; one a core unless given), `ray` (HOST:PORT of a cluster), `store` and `resume` (an SQLite file that
            keeps each run as it ends), `planner`, `seconds` [s], `law`, `replan`, `force`, and `task`, in which a plan is carried out.

    Returns:
        The trials: `done` of `ended`, each with its `seed`; `again(seed)` is one of them as a whole run. `clamber.draw` draws those of
        climbers. Ctrl-C ends them early, with what there is: then there are fewer than `asked`.

    Raises:
        PlannerError: If there is no plan that can be carried out.
        ClamberError: If something cannot be read, or cannot be as asked for.
    """
    check_options(options, Runs.__annotations__)
    check_kind("n", n, int)
    check_kind("seed", seed, int)
    seeds = range(seed, seed + n)
    are_held_out(seeds)
    work = work_of(what, options.get("task"), texts("plant", plant), force=options.get("force", False))
    request = TrialsRequest(
        planner=options.get("planner", "auto"),
        plan_seconds=options.get("seconds", 600.0),
        noise=texts("noise", noise),
        plant=work.plant,
        law=options.get("law"),
        replan=options.get("replan", True),
        force=options.get("force", False),
        faults=texts("fault", fault),
    )
    work.check(request)
    executor, store = executor_for(options), store_of(options)
    setup = work.dynamics.trials(work.item, work.plan, request, RunEvents(), store, work.label)
    return run_trials(setup, seeds, executor=executor, store=store, resume=options.get("resume", False))


def validate(
    plan: Plan | PlanResult | str | Path,
    n: int = 24,
    *,
    lessons: int = 12,
    seed: int = REHEARSED,
    noise: str | Sequence[str] = (),
    seconds: float = 60.0,
    task: str | None = None,
    workers: int | None = None,
) -> LearnedPlan:
    """Climb by a plan under noise, change what fails most, keep the change if more climbs succeed, and again.

    Args:
        plan: A climber's plan, a planner's answer, or a plan's name or file.
        n: Climbs of each rehearsal.
        lessons: Most changes that are tried.
        seed: Of a rehearsal's first climb.
        noise: As `trials` takes it.
        seconds: Most time for each search for another way [s].
        task: In which a plan's file is carried out, in place of its own.
        workers: Processes; None: one a core.

    Returns:
        What was learned: `plan`, the best one, `first` and `best` with their climbs, `lessons`. Ctrl-C ends it with the best so far.

    Raises:
        ClamberError: If the plan cannot be read or carried out.
    """
    from ..families.climber.trials.plan_repair import validate_plan

    crew: Crew = {"workers": workers}
    check_options(crew, Crew.__annotations__)
    check_kind("n", n, int)
    check_kind("lessons", lessons, int)
    check_kind("seed", seed, int)
    check_kind("seconds", seconds, float)
    work, widths = work_of(plan, task, force=True), texts("noise", noise)
    return validate_plan(
        work, widths, executor_for(crew), range(seed, seed + n), lessons=lessons, seconds=float(seconds)
    )
