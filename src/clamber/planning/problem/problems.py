"""From a task to the problem that planners work on."""

from dataclasses import replace
from typing import Any

from ...family import family_of
from ...tasks import Task
from .code_limits import CodeLimits
from .posed import Posed


def code_limits(task: Task) -> CodeLimits:
    """The codes that are actions of a task, and the indices that its stances may have."""
    return family_of(task).plans.limits(task)


def without_hangs(task: Task) -> Task:
    """The same task with no hangs allowed."""
    bare: Task = family_of(task).plans.without_hangs(task)
    return bare


def last_goal_only(task: Task) -> Task:
    """The same task without its sub-goals."""
    bare: Any = task  # each family's task has goals of its own type
    last: Task = replace(bare, goals=bare.goals[-1:])
    return last


def first_goal_only(task: Task) -> Task:
    """The same task up to its first goal."""
    near: Any = task  # each family's task has goals of its own type
    first: Task = replace(near, goals=near.goals[:1])
    return first


def pose_problem(task: Task, *, threads: int | None = None, filters: bool = True) -> Posed:
    """A task as a problem with the hard checks alone, for planners.

    Args:
        task: The task.
        threads: Threads for batches; None for one a core.
        filters: Whether the inventory's filters are applied.
    """
    return family_of(task).plans.posed(task, threads, filters)
