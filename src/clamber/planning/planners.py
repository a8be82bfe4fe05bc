"""The planners by name."""

from collections.abc import Callable
from functools import wraps
from inspect import signature
from typing import Any, Final

from ..errors import UnknownNameError
from ..extensions import blamed, failure, load_outside, outside
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
"""Name -> planner, ours; `find_planner` knows those of other packages too."""

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


USUAL: Final = ("progress", "seconds", "seed", "threads")
"""Options that all our planners are given; another package's may do without."""


def first_loop(planner: str) -> str:
    """The compiled loop that a planner's first run needs; of another package's, that of the replay which proves its plan."""
    return FIRST_LOOPS.get(planner, "replay")


def find_planner(name: str) -> Planner:
    """A planner by name, ours or another package's.

    Raises:
        UnknownNameError: If there is none.
        ExtensionError: If another package's cannot be loaded.
    """
    if name in PLANNERS:
        return PLANNERS[name]
    theirs = outside("planners")
    if name not in theirs:
        raise UnknownNameError("planner", name, (*PLANNERS, *theirs))
    return _guarded(name, load_outside("planners", name))


def _guarded(name: str, planner: Callable[..., Any]) -> Planner:
    """Another package's planner; what goes wrong in it is its own, and what it answers is looked at."""
    if not callable(planner):
        raise failure("planners", name, f"is a {type(planner).__name__}; a planner is a function of a task")
    with blamed("planners", name):
        known = signature(planner).parameters

    @wraps(planner)
    def plan(task: Task, **options: Any) -> PlanResult:
        taken = {key: value for key, value in options.items() if key in known or key not in USUAL}
        with blamed("planners", name):
            result = planner(task, **taken)
        if not isinstance(result, PlanResult):
            raise failure("planners", name, f"answered a {type(result).__name__}; a planner answers a PlanResult")
        if result.has_plan and not result.check().ok:
            raise failure("planners", name, "its plan violates a hard check when it is carried out again")
        return result

    return plan


def plan_task(task: Task, planner: str = "genetic", **options: Any) -> PlanResult:
    """Plan with a planner by name, ours or another package's."""
    return find_planner(planner)(task, **options)
