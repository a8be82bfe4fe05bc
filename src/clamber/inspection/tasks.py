"""A task's start stance with every margin, and what is odd about the task."""

import math
from collections.abc import Iterator

import numpy as np

from ..family import family_of
from ..planning.problem.check import UNLIMITED
from ..planning.problem.codes import pack
from ..planning.problem.plan_families import plan_family
from ..tasks import Task
from ..tasks.library import change_task
from .finding import Finding, Margin


def start_margins(task: Task) -> tuple[Margin, ...]:
    """Every check of the start stance, those that it violates too, in the order of the family's checks."""
    family = plan_family(task)
    lenient = change_task(task, ["rules.hard=[]"])  # with hard checks, a start that violates one is an error
    replay = family.problem(lenient).replay(np.array([pack(0)], np.int32), go_on=True)
    hard = family.hard(task)
    return tuple(
        Margin(
            check=check.name,
            unit=check.unit,
            margin=None if math.isnan(margin) or abs(margin) >= UNLIMITED else float(margin),
            hard=check.name in hard,
            meaning=check.meaning,
        )
        for check, margin in zip(family.checks, replay.margins[0], strict=True)
    )


def inspect_task(task: Task) -> Finding:
    """Facts of a task, whether its start holds and by how much, and what is odd about it."""
    margins = start_margins(task)
    x, y, theta = task.start.x, task.start.y, task.start.theta
    facts = {
        "robot": task.robot.name,
        "world": task.world.name,
        "start": f"x {x:.4g} m, y {y:.4g} m, theta {math.degrees(theta):.4g} deg",
        "goals": ", ".join(goal.name or "unnamed" for goal in task.goals),
        "hard checks": ", ".join(margin.check for margin in margins if margin.hard) or "none",
    }
    return Finding(
        kind="task", name=task.name, title=task.title, facts=facts, odd=tuple(_odd(task, margins)), margins=margins
    )


def _odd(task: Task, margins: tuple[Margin, ...]) -> Iterator[str]:
    hard = {margin.check for margin in margins if margin.hard}
    if not hard:
        yield "no check is hard: any action is allowed"
    starts_done = all(margin.holds for margin in margins if margin.hard) and _is_done(task)
    if starts_done:
        yield "the start meets the goal: the shortest plan has no actions"
    inspection = family_of(task).inspection
    if inspection is not None:
        yield from inspection.odd_task(task, hard)


def _is_done(task: Task) -> bool:
    problem = plan_family(task).problem(task)
    return bool(problem.is_done(problem.start))
