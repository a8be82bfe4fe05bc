"""Plan, check a plan, look for what would open a task; and what a planner of one's own needs to answer."""

from collections.abc import Sequence
from inspect import Parameter, signature
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import OptionError, PlannerError, SpecError
from ..files import as_text
from ..inspection.finding import Finding
from ..inspection.open_file import inspect_file, inspect_thing, kind_of
from ..planning.exact.costs import read_costs
from ..planning.infeasibility.find import InfeasibilityExplanation
from ..planning.infeasibility.find import explain_infeasibility as _explain_infeasibility
from ..planning.planners import accepts, find_planner
from ..planning.problem.plan import Plan
from ..planning.problem.plan_source import is_plan, open_plan
from ..planning.problem.problems import plan_family
from ..planning.problem.verdict import Verdict, check_plan
from ..planning.result import PlanResult, Status, furthest_of
from ..tasks import Task, load_task
from ..tasks.library import check_task
from ..types import Ints
from .options import check_kind

USUAL = {"seed": 0, "seconds": None, "threads": None}
"""Options that are left away where a planner has none of the kind."""


def plan(task: Task | str, planner: str = "auto", *, minimize: str | None = None, **options: Any) -> PlanResult:
    """Find a plan for a task, prove that there is none, or say how far it came.

    Args:
        task: A task, or its name or file.
        planner: Its name (`clamber list planners`), ours or another package's.
        minimize: Costs for the exact planner, the first one first, such as "length,torque".
        options: Of the planner: `seed`, `seconds` (most time [s]), `threads`, `max_checks` (single actions judged), ...

    Returns:
        The answer, with `status`, `plan`, `reason` and `check()`; no plan is an answer and no error.

    Raises:
        ClamberError: If the task cannot be had, its start does not hold, or the planner has no such option.
    """
    chosen = task_of(task)
    search = find_planner(planner)
    if minimize is not None:
        options["minimize"] = read_costs("minimize", minimize)
    for name in options:
        if not accepts(planner, name):
            raise PlannerError(planner, chosen.name, f"it has no option '{name}'")
        _check_option(name, options[name], signature(search).parameters.get(name))
    usual = {name: value for name, value in USUAL.items() if accepts(planner, name)}
    return search(chosen, **(usual | options))


def task_of(task: Any) -> Task:
    """A task, or the one of a name or file.

    Raises:
        OptionError: If it is neither.
    """
    if isinstance(task, str | Path):
        return load_task(str(task))
    return check_task(task, "give one of `clamber.load_task`, or a task's name or file")


def _check_option(name: str, value: Any, parameter: Parameter | None) -> None:
    """Make sure that an option of a planner is of the kind that it takes, and no number below 0."""
    kind = None if parameter is None or isinstance(parameter.annotation, str) else parameter.annotation
    if kind is not None and kind is not Parameter.empty:
        check_kind(name, value, kind)


def check(what: Plan | PlanResult | str | Path, task: Task | str | None = None, *, go_on: bool = False) -> Verdict:
    """Carry a plan out again, without whoever made it, and judge every step by every check.

    Args:
        what: A plan, a planner's answer, or a plan's name or file.
        task: To carry it out in; None: its own.
        go_on: Whether to go on past a violation.

    Returns:
        The verdict: `ok`, `reached`, `per_step`, `tightest()`, `first_violation`. Margins are signed, positive holds.

    Raises:
        ClamberError: If the plan cannot be read, or has actions that the task has not.
    """
    if isinstance(what, str | Path):
        if not is_plan(str(what)):
            raise OptionError(
                "what", f"'{what}' is a {kind_of(str(what))}", "give a plan; `clamber.inspect` looks at the rest"
            )
        opened = open_plan(what, task if isinstance(task, str) else None)
        return check_plan(opened.task if task is None or isinstance(task, str) else task, opened.plan, go_on=go_on)
    made = what.plan if isinstance(what, PlanResult) else what
    if not isinstance(made, Plan):
        raise OptionError.of_value(
            "what", what, "is no plan", "give a plan, a planner's answer, or a plan's name or file"
        )
    if task is None:
        own: Task = what.task if isinstance(what, PlanResult) else made.rebuild_task()
    else:
        own = task_of(task)
    return check_plan(own, made, go_on=go_on)


def inspect(what: Any) -> Finding:
    """What a robot, board, ground, world, task or walk is, whether a task's start holds, and what is odd about it.

    Args:
        what: Its name or file, or what a `load_...` function gave.

    Returns:
        The finding: `kind`, `ok`, `facts`, `margins` of a task's start, `odd`.

    Raises:
        OptionError: If it is none of these.
        ClamberError: If it breaks a rule of its format; the error names file and key.
    """
    if isinstance(what, str | Path):
        return inspect_file(str(what))
    finding = inspect_thing(what)
    if finding is None:
        raise OptionError.of_value("what", what, "is no robot, world or task", "give one, or its name or file")
    return finding


def explain_infeasibility(
    task: Task | PlanResult | str, *, seconds: float = 60.0, threads: int | None = None
) -> InfeasibilityExplanation:
    """Which single, smallest changes of an infeasible task would allow a plan.

    Args:
        task: A task, an answer about one, or its name or file.
        seconds: Most time to look [s].
        threads: Threads; None for one a core.

    Returns:
        `openings` (key, from, to, plan length), `shut` (what does not help), `places` for one hold more.

    Raises:
        ClamberError: If the task cannot be had.
    """
    chosen = task.task if isinstance(task, PlanResult) else task_of(task)
    return _explain_infeasibility(chosen, seconds=seconds, threads=threads)


def load_plan(name_or_path: str | Path, task: str | None = None) -> Plan:
    """A plan by its name or from the file that `clamber plan -o` or `Plan.save` wrote.

    Args:
        name_or_path: Name (`clamber list plans`) or file.
        task: Of a plan in the thesis's numbers: the task that it is for, in place of the one that it names.

    Raises:
        ClamberError: If it cannot be read.
    """
    return open_plan(as_text(name_or_path), task).plan


def answer(
    task: Task,
    codes: Sequence[int] | Ints,
    *,
    planner: str,
    seed: int = 0,
    reason: str = "",
    checks: int = 0,
    seconds: float = 0.0,
    status: Status | None = None,
) -> PlanResult:
    """What a planner of one's own answers, from the actions that it chose; they are carried out and judged here.

    Args:
        task: What was planned.
        codes: Packed actions as `CompiledProblem.replay` takes them, shape (n,): the plan, or what leads furthest.
        planner: Its name.
        seed: Of what it drew at random.
        reason: Why it ended, in a sentence.
        checks: Single actions that it judged.
        seconds: That it took [s].
        status: "optimal", "infeasible" or "bounded" only where that is proved; None: "found" if the goal is reached, else "stopped".

    Raises:
        SpecError: If an action violates a hard check.
    """
    family = plan_family(task)
    problem = family.problem(task)
    packed = problem.limits.codes(codes)
    replay = problem.replay(packed)
    if not replay.ok:
        step, check_ = len(replay.reasons), family.checks[int(replay.reasons[-1])]
        raise SpecError(
            planner, f"actions.{step - 1}", int(packed[step - 1]), f"violates the hard check '{check_.name}'"
        )
    reached = problem.is_done(replay.stances[-1:])
    return PlanResult(
        status=status or ("found" if reached else "stopped"),
        plan=Plan.of_codes(task, packed, seed=seed, planner=planner),
        task=task,
        reason=reason or ("every goal is reached" if reached else "stopped before the goal"),
        evaluations=0,
        checks=checks,
        seconds=seconds,
        seed=seed,
        planner=planner,
        max_torque=float(np.max([family.torque(stance) for stance in replay.stances[1:]], initial=0.0)),
        furthest=None if reached else furthest_of(task, problem, packed),
    )
