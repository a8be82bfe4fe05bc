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
from .rivals.greedy import plan_greedy
from .rivals.mcts import plan_mcts
from .rivals.random import plan_random
from .route.planner import plan_route

Planner = Callable[..., PlanResult]
PLANNERS: Final[dict[str, Planner]] = {
    "genetic": plan_genetic,
    "exact": plan_exact,
    "beam": plan_beam,
    "hybrid": plan_hybrid,
    "auto": plan_auto,
    "route": plan_route,
    "greedy": plan_greedy,
    "random": plan_random,
    "mcts": plan_mcts,
}
"""Name -> planner; the command line's choices and the tests read it."""

PROVERS: Final = ("exact", "auto")
"""Planners that can prove that there is no plan."""

FIRST_LOOPS: Final = {
    "genetic": "rollout",
    "exact": "explore_some",
    "beam": "sprout",
    "hybrid": "rollout",
    "auto": "sprout",
    "route": "search",
    "greedy": "greedy",
    "random": "burst",
    "mcts": "simulate",
}
"""Name -> the compiled loop that a planner's first run needs."""


def plan_task(task: Task, planner: str = "genetic", **options: Any) -> PlanResult:
    """Plan with a planner by name."""
    return PLANNERS[planner](task, **options)
