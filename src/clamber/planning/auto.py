"""The planner that chooses a planner, by what can be known of a problem before it is searched, and says why."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Final

from ..tasks import Task
from .beam import plan_beam
from .exact.planner import plan_exact
from .genetic.planner import plan_genetic
from .problem.problem import CompiledProblem
from .problem.problems import pose_problem
from .progress import Clock, Listener
from .result import PlanResult
from .route import plan_route

SMALL: Final = 1.0e8
"""Estimated stances up to which exact search is tried first: the five boards without hangs have up to 1.2e7 (docs/planning.md)."""
MEMORY: Final = 2_000_000
"""Stances that exact search may keep before the next planner has its turn."""
MANY: Final = 1000
"""Holds from which a route over the board is planned first."""
TRIED: Final[dict[str, Callable[..., PlanResult]]] = {
    "genetic": plan_genetic,
    "exact": plan_exact,
    "beam": plan_beam,
    "route": plan_route,
}
"""Planners that are chosen from, by name."""


@dataclass(frozen=True, slots=True)
class Choice:
    """Planners in the order in which they are tried, and why that order."""

    planners: tuple[str, ...]
    reason: str


def choose(problem: CompiledProblem) -> Choice:
    """Which planners to try, the first first."""
    if problem.incomplete is not None:
        return Choice(("genetic",), "only genetic search takes rules.allowed with single grabs or releases")
    stances = problem.estimated_stances
    # Where actions are scored before they are judged, a beam costs as much on any board.
    if problem.landmarks >= MANY and not problem.foreseen:
        return Choice(("route", "beam", "genetic"), f"{problem.landmarks} holds are too many for one search")
    if math.isinf(stances):
        return Choice(("beam", "genetic"), "the space of stances is open (hangs, or poses of two bodies)")
    if stances <= SMALL:
        return Choice(("exact", "beam", "genetic"), f"at most about {stances:.0e} stances: small enough to prove")
    return Choice(("beam", "genetic"), f"about {stances:.0e} stances are too many to prove")


def plan_auto(
    task: Task,
    *,
    seed: int = 0,
    seconds: float | None = None,
    threads: int | None = None,
    progress: Listener | None = None,
) -> PlanResult:
    """Choose a planner by the problem, say why, and go on with the next where one finds nothing.

    Repeatable for the same seed unless `seconds` cuts in.

    Args:
        task: What to plan.
        seed: Handed to every planner.
        seconds: Most time [s], all planners together.
        threads: Threads; None for one a core.
        progress: Called now and then.

    Returns:
        The answer of the first planner that finds or proves something, else of the last; its reason says which were tried.
    """
    clock = Clock(seconds)
    problem = pose_problem(task, threads=threads).problem
    choice = choose(problem)
    result: PlanResult | None = None
    bound: int | None = None
    model = ""
    tried = []
    for name in choice.planners:
        left = clock.left
        if result is not None and left == 0.0:
            break
        options: dict[str, Any] = {"max_stances": MEMORY} if name == "exact" else {}
        result = TRIED[name](task, seed=seed, seconds=left, threads=threads, progress=progress, **options)
        tried.append(name)
        bound, model = (result.lower_bound, result.model) if name == "exact" else (bound, model)
        if result.has_plan or result.status == "infeasible" or "interrupted" in result.reason:
            break
    assert result is not None
    then = "".join(f", then {name}" for name in tried[1:])
    reason = f"{choice.reason}: {tried[0]}{then}; {result.reason}"
    return replace(
        result,
        reason=reason,
        planner=f"auto/{result.planner}",
        lower_bound=result.lower_bound if result.lower_bound is not None else bound,
        model=result.model or model,
        seconds=clock.spent,
    )
