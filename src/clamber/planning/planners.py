"""The planners by name."""

from collections.abc import Callable
from typing import Any, Final

from ..tasks import Task
from .exact.planner import plan_exact
from .genetic.planner import plan_genetic
from .result import PlanResult
from .route.planner import plan_route

Planner = Callable[..., PlanResult]
PLANNERS: Final[dict[str, Planner]] = {"genetic": plan_genetic, "exact": plan_exact, "route": plan_route}
"""Name -> planner; the command line's choices and the tests read it."""


def plan_task(task: Task, planner: str = "genetic", **options: Any) -> PlanResult:
    """Plan with a planner by name."""
    return PLANNERS[planner](task, **options)
