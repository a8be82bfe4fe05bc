"""The planners by name; each is imported when it is asked for, so that lists of them are quick."""

from collections.abc import Callable
from functools import wraps
from importlib import import_module
from inspect import signature
from typing import TYPE_CHECKING, Any, Final, NamedTuple, TypeAlias

from ..errors import UnknownNameError
from ..extensions import blamed, failure, load_outside, outside

if TYPE_CHECKING:
    from ..tasks import Task
    from .result import PlanResult

Planner: TypeAlias = "Callable[..., PlanResult]"


class BuiltIn(NamedTuple):
    """A planner that comes with Clamber."""

    path: str
    """Module and name of the function."""
    title: str
    """First line of its docstring."""
    first_loop: str
    """The compiled loop that its first run needs."""


PLANNERS: Final[dict[str, BuiltIn]] = {
    "genetic": BuiltIn(
        "clamber.planning.genetic.planner:plan_genetic",
        'Plan by genetic search (thesis 2.2.3; page "The model", section 10).',
        "rollout",
    ),
    "exact": BuiltIn(
        "clamber.planning.exact.planner:plan_exact",
        "Find the best plan, or prove that there is none.",
        "explore_some",
    ),
    "beam": BuiltIn(
        "clamber.planning.beam:plan_beam",
        "Plan by beam search, with or without hangs: quick and near the shortest plan; it proves nothing.",
        "sprout",
    ),
    "hybrid": BuiltIn(
        "clamber.planning.hybrid:plan_hybrid",
        "Plan by genetic and exact search together: a plan soon, then how much shorter one may be, or that none is.",
        "rollout",
    ),
    "auto": BuiltIn(
        "clamber.planning.auto:plan_auto",
        "Choose a planner by the problem, say why, and go on with the next where one finds nothing.",
        "sprout",
    ),
    "route": BuiltIn(
        "clamber.planning.route:plan_route",
        "Find a plan over a board of any size; choose it where the way is long.",
        "search",
    ),
    "greedy": BuiltIn(
        "clamber.benchmarks.rivals:plan_greedy",
        "Go on from the stance with the most progress, never to a stance twice, until the first plan.",
        "greedy",
    ),
    "random": BuiltIn(
        "clamber.benchmarks.rivals:plan_random",
        "Walk at random, jump to where the best walk led, start again where none leads further; keep the shortest plan.",
        "burst",
    ),
    "mcts": BuiltIn(
        "clamber.benchmarks.mcts:plan_mcts",
        "Search a tree of stances by UCT, commit to the most visited action, and so on to the goal; start again till the budget ends.",
        "simulate",
    ),
}
"""Name -> planner, ours; `find_planner` knows those of other packages too."""

USUAL_PLANNER: Final = "auto"
"""Where none is asked for, in commands and in Python."""
PROVERS: Final = ("exact", "auto")
"""Planners that can prove that there is no plan."""
USUAL: Final = ("progress", "seconds", "seed", "threads")
"""Options that all our planners are given; another package's may do without."""


def first_loop(planner: str) -> str:
    """The compiled loop that a planner's first run needs; of another package's, that of the replay which proves its plan."""
    return PLANNERS[planner].first_loop if planner in PLANNERS else "replay"


def find_planner(name: str) -> Planner:
    """A planner by name, ours or another package's.

    Raises:
        UnknownNameError: If there is none.
        ExtensionError: If another package's cannot be loaded.
    """
    if name in PLANNERS:
        module, _, function = PLANNERS[name].path.partition(":")
        ours: Planner = getattr(import_module(module), function)
        return ours
    theirs = outside("planners")
    if name not in theirs:
        raise UnknownNameError("planner", name, (*PLANNERS, *theirs))
    return _guarded(name, load_outside("planners", name))


def accepts(planner: str, option: str) -> bool:
    """Whether a planner, ours or another package's, has such an option."""
    return option in signature(find_planner(planner)).parameters


def _guarded(name: str, planner: Callable[..., Any]) -> Planner:
    """Another package's planner; what goes wrong in it is its own, and what it answers is looked at."""
    if not callable(planner):
        raise failure("planners", name, f"is a {type(planner).__name__}; a planner is a function of a task")
    with blamed("planners", name):
        known = signature(planner).parameters

    from .result import PlanResult

    @wraps(planner)
    def plan(task: "Task", **options: Any) -> PlanResult:
        taken = {key: value for key, value in options.items() if key in known or key not in USUAL}
        with blamed("planners", name):
            result = planner(task, **taken)
        if not isinstance(result, PlanResult):
            raise failure("planners", name, f"answered a {type(result).__name__}; a planner answers a PlanResult")
        if result.has_plan and not result.check().ok:
            raise failure("planners", name, "its plan violates a hard check when it is carried out again")
        return result

    return plan


def plan_task(task: "Task", planner: str = USUAL_PLANNER, **options: Any) -> "PlanResult":
    """Plan with a planner by name, ours or another package's."""
    return find_planner(planner)(task, **options)
