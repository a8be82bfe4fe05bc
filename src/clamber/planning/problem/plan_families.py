"""What a plan and its verdict have to know about a family of robots, and the families that have it."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np

from ...family import family_of
from ...tasks import Task
from ...types import Ints
from .check import Check
from .code_limits import CodeLimits
from .plan_costs import PlanCost
from .planned import PlannedAction
from .posed import Posed
from .problem import CompiledProblem, Records


class PlanFamily(ABC):
    """How plans of one family are named, replayed and reported; tasks and stances are the family's own."""

    checks: ClassVar[tuple[Check, ...]]
    """In the order of a replay's margins."""
    burdens: ClassVar[tuple[str, ...]] = ()
    """What can be told of being in a stance, each with its unit at the end."""

    @abstractmethod
    def posed(self, task: Any, threads: int | None, filters: bool) -> Posed:
        """The task as a problem with the hard checks alone, its inventory filtered if asked for."""

    @abstractmethod
    def limits(self, task: Any) -> CodeLimits:
        """The codes that are actions of a task, and the indices that its stances may have."""

    def without_hangs(self, task: Any) -> Any:
        """The same task with no hangs allowed; most families have none."""
        return task

    @abstractmethod
    def sizes(self, task: Any) -> Mapping[str, float]:
        """Check -> the size that its margin is a share of, in its own unit; counts have none, for they are never tight."""

    @abstractmethod
    def problem(self, task: Any) -> CompiledProblem:
        """The task with every check evaluated, for replays."""

    @abstractmethod
    def hard(self, task: Any) -> tuple[str, ...]:
        """Names of the checks that forbid an action."""

    @abstractmethod
    def action(self, task: Any, code: int, after: np.void, gene: str | None) -> PlannedAction:
        """A packed code as a named action, its hold read from the stance that it led to."""

    @abstractmethod
    def code(self, task: Any, action: PlannedAction) -> int:
        """The packed code of a named action; raises `ActionError` where the task has no such action."""

    @abstractmethod
    def module(self, task: Any, code: int) -> str:
        """Name of a packed code as a module of the inventory."""

    @abstractmethod
    def pose(self, stance: np.void) -> tuple[float, float, float]:
        """Place [m] and angle [rad] of the body, world frame."""

    def holds(self, task: Any, stance: np.void) -> dict[str, int]:
        """Limb name -> number of its hold, 0 if it is free; empty where nothing is held."""
        return {}

    def taken(self, task: Any, stance: np.void) -> int | None:
        """Number of the hold that the last action took, None if it took none."""
        return None

    def model(self, task: Any) -> str:
        """The rules that a proof about a task holds for."""
        return f"hard checks {', '.join(self.hard(task))}"

    def costs(self, task: Any) -> Mapping[str, PlanCost]:
        """What a plan may be asked to have little of, beside its actions: name -> cost; one adds up, one is a largest value."""
        return {}

    def power(self, stance: np.void) -> float:
        """Power that holding the stance takes [W]; 0 in models without forces."""
        return 0.0

    def duration(self, task: Any) -> float:
        """Time that one action takes [s], for its energy; 0 in models without forces."""
        return 0.0

    def torque(self, stance: np.void) -> float:
        """Largest joint torque [N m]; 0 in models without forces."""
        return 0.0

    def nearest(self, task: Any, problem: CompiledProblem, stances: Records, asked: Ints) -> list[int | None]:
        """What each "nearest" among the codes `asked` takes from the stance before it: hold numbers, shape (n,)."""
        return [None] * len(asked)

    def goals_met(self, stance: np.void) -> int:
        """Goals met, in order."""
        return int(stance["stage"])


def plan_family(task: Task) -> PlanFamily:
    """How plans of a task's family are named, replayed and reported."""
    return family_of(task).plans
