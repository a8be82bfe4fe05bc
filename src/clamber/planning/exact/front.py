"""Every plan that no other beats in both of two costs."""

import json
from dataclasses import dataclass
from operator import attrgetter
from pathlib import Path
from typing import Annotated, Literal

from ...files import write_atomically
from ...json_form import HIDDEN, Count, Jsonable, Key, in_json
from ...shown_units import units_of
from ...tasks import Task
from ..problem.plan import Plan
from ..problem.problems import PlannedAction, listed_problem, plan_family, spent
from ..progress import Clock, Exploring, Listener
from .costs import COSTS, Aim, check_costs
from .explore import CostedPlan, Exploration, inform
from .planner import MOST_STANCES, UNDER, Minimizer


@dataclass(frozen=True, slots=True)
class Trade(Jsonable):
    """One plan of a front."""

    plan: Annotated[
        Plan,
        Key("codes", get=Plan.numbers, kind=list[int] | None, after="costs"),
        Key("actions", get=attrgetter("actions"), kind=tuple[PlannedAction, ...], after="codes"),
    ]
    costs: dict[str, float]
    """Length [actions] and every cost of the family, in SI units."""

    @property
    def length(self) -> int:
        """Actions of the plan."""
        return len(self.plan.actions)


@dataclass(frozen=True, slots=True, kw_only=True)
class Front(Jsonable):
    """The plans that no other beats in both costs, from the least of the first to the least of the second."""

    task: Annotated[Task, Key(get=attrgetter("name"), kind=str)]
    costs: tuple[str, str]
    """The two."""
    trades: tuple[Trade, ...]
    """From the least of the first cost to the least of the second."""
    complete: Annotated[bool, HIDDEN]
    """Proved: there are no others."""
    infeasible: Annotated[bool, HIDDEN]
    """Proved: there is no plan at all."""
    reason: str
    stances: Count
    checks: Count
    seconds: float
    model: str

    @property
    @in_json(after="costs")
    def status(self) -> Literal["optimal", "infeasible", "bounded"]:
        """optimal: proved that there are no others."""
        return "infeasible" if self.infeasible else "optimal" if self.complete else "bounded"

    def save(self, path: Path) -> None:
        """Write the front with its plans as JSON, whole or not at all."""
        write_atomically(path, json.dumps(self.to_json(), indent=2, allow_nan=False) + "\n")


def plan_front(
    task: Task,
    costs: tuple[str, str],
    *,
    seconds: float | None = None,
    threads: int | None = None,
    max_stances: int = MOST_STANCES,
    progress: Listener | None = None,
) -> Front:
    """Find every plan that no other beats in both costs (one plan for each pair of values).

    Args:
        task: What to plan.
        costs: Two of "length" and the costs of the robot's family.
        seconds: Most time [s].
        threads: As for `plan_exact`.
        max_stances: Memory; running out leaves the front incomplete, and says so.
        progress: Called now and then.

    Raises:
        PlannerError: If the task allows actions that exact search can't list one by one.
        CostError: If the family has no such cost.
    """
    clock = Clock(seconds)
    check_costs("costs", costs, task)
    problem, seconds = inform(listed_problem(task, "exact", threads=threads), seconds)

    def tell(stances: int, bound: float, cost: str) -> None:
        if progress is not None:
            progress(Exploring(stances, bound, cost, units_of(task.document).torque))

    searches = Minimizer(problem, most_stances=max_stances, seconds=seconds, tell=tell)
    names = set(costs)
    if "length" in names:
        (other,) = names - {"length"}
        seen = searches.run(Aim(second=other, front=True))
        ways, complete, infeasible = list(seen.ways), seen.found or seen.exhausted, seen.exhausted
    else:
        ways, complete, infeasible = _by_falling_limit(searches, *sorted(names, key=lambda name: COSTS[name] == "peak"))
    family = plan_family(task)
    trades = []
    for way in ways:
        worth = {"length": float(len(way.codes))}
        worth |= spent(problem, family.costs(task), problem.replay(way.codes).stances)
        trades.append(Trade(Plan.of_codes(task, way.codes, planner="exact"), worth))
    trades.sort(key=lambda trade: trade.costs[costs[0]])
    return Front(
        task=task,
        costs=costs,
        trades=tuple(trades),
        complete=complete,
        infeasible=infeasible,
        reason=_reason(len(trades), complete, infeasible, searches.stances),
        stances=searches.stances,
        checks=searches.checks,
        seconds=clock.spent,
        model=family.model(task),
    )


def _by_falling_limit(searches: Minimizer, summed: str, peak: str) -> tuple[list[CostedPlan], bool, bool]:
    """The front of a summed cost and a largest value: least of the first under a limit of the second that falls until no plan is left."""
    ways: list[CostedPlan] = []
    limit: float | None = None
    while True:
        seen: Exploration = searches.run(Aim(first=summed, second=peak, most_peak=limit))
        if not seen.found:
            return ways, seen.exhausted, seen.exhausted and not ways
        ways.append(seen.ways[0])
        limit = seen.ways[0].second * UNDER


def _reason(trades: int, complete: bool, infeasible: bool, stances: int) -> str:
    if infeasible:
        return f"there is no plan ({stances} stances seen)"
    if complete:
        return f"no plan beats one of these {trades} in both costs ({stances} stances seen)"
    return f"out of time or memory after {stances} stances: these {trades} are on the front, more may be"
