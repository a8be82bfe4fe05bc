"""The planners by name."""

from collections.abc import Callable
from typing import Any, Final

from ..tasks import Task
from .auto.planner import plan_auto
from .beam.planner import plan_beam
from .exact.planner import plan_exact
from .genetic.planner import plan_genetic
from .hybrid.planner import plan_hybrid
from .result import PlanResult

Planner = Callable[..., PlanResult]
PLANNERS: Final[dict[str, Planner]] = {
    "genetic": plan_genetic,
    "exact": plan_exact,
    "beam": plan_beam,
    "hybrid": plan_hybrid,
    "auto": plan_auto,
}
"""Name -> planner; the command line's choices and the tests read it."""


def plan_task(task: Task, planner: str = "genetic", **options: Any) -> PlanResult:
    """Plan with a planner by name."""
    return PLANNERS[planner](task, **options)
