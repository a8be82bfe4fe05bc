"""From a task to the problem that planners work on, by family."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Final

from ..json_form import Count, Jsonable, in_json
from ..tasks import Task
from .code_limits import CodeLimits
from .inventory import Dropped, make_inventory
from .limbed_problem import LimbedProblem, limbed_limits
from .problem import CompiledProblem
from .walker_problem import WalkerProblem, stride_lengths, walker_limits, walker_table


@dataclass(frozen=True, slots=True)
class Posed:
    """A task as a problem, and what its inventory's filters did."""

    problem: CompiledProblem
    full_size: int
    """Modules of the unfiltered inventory."""
    dropped: tuple[Dropped, ...] = ()

    def sized(self, length: int) -> "SizedInventory":
        """The inventory with the size of the search for plans of `length` actions."""
        names = tuple(self.problem.actions.names)
        return SizedInventory(len(names), self.full_size, names, self.dropped, length)


@dataclass(frozen=True, slots=True)
class SizedInventory(Jsonable):
    """The modules that a plan can be made of, and the search sizes D = N^m (thesis 2.2.1)."""

    modules: Count
    full_size: Count
    """Before the filters."""
    names: tuple[str, ...]
    dropped: tuple[Dropped, ...]
    length: Count
    """Actions of a plan, for the size of the search."""

    @property
    @in_json()
    def log10_before(self) -> float:
        """Logarithm of how many plans of that length there are before the filters."""
        return self.length * math.log10(self.full_size)

    @property
    @in_json()
    def log10_after(self) -> float:
        """The same after them."""
        return self.length * math.log10(self.modules)


def _limbed(task: Any, threads: int | None, filters: bool) -> Posed:
    inventory = make_inventory(task, filters=filters)
    return Posed(LimbedProblem(task, inventory.table(), threads=threads), inventory.full_size, inventory.dropped)


def _walker(task: Any, threads: int | None, filters: bool) -> Posed:
    table = walker_table(stride_lengths(task))
    return Posed(WalkerProblem(task, table, threads=threads), len(table))


PROBLEMS: Final[dict[str, Callable[[Any, int | None, bool], Posed]]] = {"limbed": _limbed, "walker": _walker}
"""Family of the robot -> how its tasks become problems."""


LIMITS: Final[dict[str, Callable[[Any], CodeLimits]]] = {"limbed": limbed_limits, "walker": walker_limits}
"""Family of the robot -> the codes and indices of its tasks."""


def code_limits(task: Task) -> CodeLimits:
    """The codes that are actions of a task, and the indices that its stances may have."""
    return LIMITS[task.document["robot"]["family"]](task)


BURDENS: Final[dict[str, tuple[str, ...]]] = {"limbed": LimbedProblem.burdens, "walker": WalkerProblem.burdens}
"""Family of the robot -> what can be told of being in a stance, each with its unit at the end."""


def _hangless(task: Any) -> Task:
    bare: Task = replace(task, rules=replace(task.rules, max_hangs=0))
    return bare


WITHOUT_HANGS: Final[dict[str, Callable[[Any], Task]]] = {"limbed": _hangless, "walker": lambda task: task}
"""Family of the robot -> a task of it with no hangs."""


def without_hangs(task: Task) -> Task:
    """The same task with no hangs allowed."""
    return WITHOUT_HANGS[task.document["robot"]["family"]](task)


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
    return PROBLEMS[task.document["robot"]["family"]](task, threads, filters)
