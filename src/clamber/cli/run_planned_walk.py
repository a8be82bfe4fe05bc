"""`clamber run` of a walker's task or plan: plan it if need be, and walk it."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import typer

from ..actions.plan import Plan
from ..tasks.walker import WalkerTask
from .output import announce_compilation, stderr
from .plan_text import ProgressLine
from .run_report import RunReport
from .run_walk import refuse_climbs_options, walk_and_tell


def run_planned_walk(
    what: str,
    task: WalkerTask,
    plan: Plan | None,
    settings: Sequence[str],
    noise: Sequence[str],
    planner: str,
    seconds: float,
    seed: int,
    outputs: Sequence[Path],
    save_plan: Path | None,
    climbs_only: Mapping[str, bool],
    telling: RunReport,
    *,
    as_json: bool,
    quiet: bool,
) -> None:
    """Carry a planned walk out and say how it went; leaves with 1 where there is no plan, or where it did not come to its end.

    Args:
        what: The task's or plan's name or file.
        task: The task.
        plan: Its plan; None: it is planned first, with more room than its checks ask for.
        settings: Texts "key=value" of task and plant.
        noise: Texts "key=size".
        planner: How to search.
        seconds: For which the planner may search [s].
        seed: Of planner and noise.
        outputs: Files to write.
        save_plan: Where the plan is kept.
        climbs_only: Options that only climbs have -> whether they are given.
        telling: Its report, if one is asked for.
        as_json: Whether to print JSON alone.
        quiet: Whether to tell nothing on the way.
    """
    from ..experiments.walk.planned import careful, lay_plan, walk_of
    from ..planning.planners import find_planner, plan_task

    refuse_climbs_options(what, climbs_only)
    find_planner(planner)
    announce_compilation(quiet=quiet)
    if plan is None:
        task = careful(task)
        with ProgressLine(stderr(), quiet=quiet) as line:
            result = plan_task(task, planner, seed=seed, seconds=seconds, progress=line.update)
        if not result.has_plan:
            stderr().print(f"no plan for '{task.name}' that can bear to be walked: {result.reason}; nothing has moved")
            raise typer.Exit(1)
        plan = result.plan
    if save_plan is not None:
        plan.save(save_plan)
    walk_and_tell(
        walk_of(task), settings, noise, seed, outputs, telling, lay_plan(task, plan, what), plan,
        as_json=as_json, quiet=quiet,
    )  # fmt: skip
