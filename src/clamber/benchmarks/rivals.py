"""Comparators for the planners: greedy best-first search, random walks, and the budget and answer that all share."""

from dataclasses import dataclass, field
from typing import Final

import numpy as np

from ..interrupts import Interruptible
from ..planning.problem.plan import Plan
from ..planning.problem.problem import CompiledProblem
from ..planning.problem.problems import listed_problem, plan_family
from ..planning.progress import Clock, Listener, Trying
from ..planning.result import PlanResult, Status, furthest_of
from ..planning.stance_table import path_to, scratch_for, table_size
from ..tasks import Task
from ..types import Floats, Ints
from .rival_kernels import (
    BEST,
    CHECKS,
    EXHAUSTED,
    FOUND,
    FULL,
    GOAL,
    NODES,
    OPEN,
    RUNNING,
    Nodes,
    burst,
    greedy,
    plant_root,
)

WEIGHTS: Final = {"body": 1.0, "limbs": 0.1, "stages": 0.5}
"""Feature -> weight, as in the genetic planner's profile `default`: per metre, per metre, per goal."""


def guidance(problem: CompiledProblem) -> Floats:
    """The weights in the order of the family's features; a feature that a family lacks weighs nothing."""
    return np.array([WEIGHTS.get(name, 0.0) for name in problem.features])


MAX_CHECKS: Final = 2_000_000
"""Actions judged unless told otherwise: a second or two."""
LONGEST: Final = 400
"""Most actions of a plan, as in the genetic planner's profiles."""


@dataclass(slots=True)
class SearchBudget(Interruptible):
    """A rival at work: what it has spent and the best that it has."""

    planner: str
    task: Task
    seed: int
    max_checks: int
    seconds: float | None
    listener: Listener | None
    problem: CompiledProblem = field(init=False)
    clock: Clock = field(init=False)
    checks: int = 0
    codes: Ints = field(default_factory=lambda: np.zeros(0, np.int32))
    """The shortest plan; without one, the way to the stance that is worth most."""
    value: float = -np.inf
    """What that stance is worth."""
    found: bool = False
    first_length: int | None = None
    first_checks: int | None = None

    def __post_init__(self) -> None:
        self.clock = Clock(self.seconds)
        self.problem = listed_problem(self.task, self.planner, threads=1)
        if self.problem.is_done(self.problem.start):
            self.take(self.codes, 0.0, found=True)

    @property
    def is_over(self) -> bool:
        """Whether the budget is spent, or no shorter plan can be."""
        return self.clock.is_over or self.checks >= self.max_checks or self.longest <= 0

    @property
    def longest(self) -> int:
        """Most actions of a plan that would be news."""
        return len(self.codes) - 1 if self.found else LONGEST

    def take(self, codes: Ints, value: float, *, found: bool) -> None:
        """Keep a plan if it is better than what there is: it reaches the goal, with fewer actions, or leads further."""
        if found and self.first_length is None:
            self.first_length, self.first_checks = len(codes), self.checks
        better = (
            len(codes) < len(self.codes) if found and self.found else found or (not self.found and value > self.value)
        )
        if better:
            self.codes, self.value, self.found = codes.copy(), value, found

    def tell(self) -> None:
        """Tell where the search is."""
        if self.listener is not None:
            self.listener(Trying(self.checks, self.value, len(self.codes) if self.found else None))

    def result(self, *, exhausted: int | None = None, spent: str = "the budget ran out") -> PlanResult:
        """The answer.

        Args:
            exhausted: Stances of the whole reachable space, if the search saw it all and there is no plan.
            spent: Why it stopped without a plan.
        """
        family = plan_family(self.task)
        status: Status = "found" if self.found else "stopped" if exhausted is None else "infeasible"
        if self.found:
            reason = f"reached every goal after {self.first_checks} actions judged"
        elif exhausted is not None:
            reason = f"all {exhausted} reachable stances were seen and none meets the goal"
        else:
            how = "interrupted" if self.interrupted else spent
            reason = f"{how} after {self.checks} actions judged without reaching the goal; this search proves nothing"
        replayed = self.problem.replay(self.codes)
        assert replayed.ok, "a rival's plan does not hold"
        return PlanResult(
            status=status,
            plan=Plan.of_codes(self.task, self.codes, seed=self.seed, planner=self.planner),
            task=self.task,
            reason=reason,
            evaluations=0,
            checks=self.checks,
            seconds=self.clock.spent,
            seed=self.seed,
            planner=self.planner,
            max_torque=float(np.max([family.torque(stance) for stance in replayed.stances[1:]], initial=0.0)),
            furthest=None if self.found else furthest_of(self.task, self.problem, self.codes),
            stances=exhausted,
            model="" if exhausted is None else family.model(self.task),
            first_length=self.first_length,
            first_checks=self.first_checks,
        )


MAX_STANCES: Final = 2_000_000
"""Stances kept unless told otherwise: about 115 bytes each for the climber."""
QUOTA: Final = 5000
"""Stances expanded between looks at the clock."""


def plan_greedy(
    task: Task,
    *,
    seed: int = 0,
    seconds: float | None = None,
    threads: int | None = None,
    max_checks: int = MAX_CHECKS,
    max_stances: int = MAX_STANCES,
    progress: Listener | None = None,
) -> PlanResult:
    """Go on from the stance with the most progress, never to a stance twice, until the first plan.

    It knows no length, so its plans are long; where goals lie behind detours it floods the space. Seeing the whole of it
    is a proof that there is no plan.

    Args:
        task: What to plan.
        seed: Only written down: nothing here is drawn at random.
        seconds: Most time [s].
        threads: The search runs on one.
        max_checks: Most actions to judge; a stance being expanded is finished.
        max_stances: Memory: most stances kept.
        progress: Called now and then.

    Returns:
        "found", "infeasible", or "stopped" with the furthest stance.

    Raises:
        PlannerError: If the task allows actions that can't be listed one by one.
    """
    hunt = SearchBudget("greedy", task, seed, max_checks, seconds, progress)
    problem = hunt.problem
    params, weights = problem.params.record, guidance(problem)
    capacity = min(max_stances, max_checks + 1) + problem.branching
    nodes, room = (
        Nodes(
            keys=np.zeros((capacity, problem.key_words), np.int64),
            value=np.zeros(capacity),
            parent=np.zeros(capacity, np.int32),
            code=np.zeros(capacity, np.int32),
            heap=np.zeros(capacity, np.int32),
            table=np.full(table_size(capacity), -1, np.int32),
        ),
        scratch_for(problem),
    )
    state = np.zeros(6, np.int64)
    state[NODES] = state[OPEN] = 1
    nodes.parent[0] = state[GOAL] = -1
    plant_root(params, problem.start, weights, nodes, room.row)
    status = FOUND if hunt.found else RUNNING
    with hunt:
        while status == RUNNING and not hunt.is_over:
            status = greedy(params, weights, nodes, state, room, max_checks, QUOTA)
            hunt.checks = int(state[CHECKS])
            hunt.value = float(nodes.value[state[BEST]])
            hunt.tell()
    end = max(0, int(state[GOAL])) if status == FOUND else int(state[BEST])
    hunt.value = -np.inf
    hunt.take(path_to(nodes.parent, nodes.code, end), float(nodes.value[end]), found=status == FOUND)
    full = status == FULL and hunt.checks < max_checks
    return hunt.result(
        exhausted=int(state[NODES]) if status == EXHAUSTED else None,
        spent="memory was full" if full else "the budget ran out",
    )


@dataclass(frozen=True, slots=True)
class Bursts:
    """How the walks of the planner `random` are made."""

    walks: int = 50
    """Walks of a burst."""
    length: int = 6
    """Most actions of a walk; twice as many after a burst that came no further."""
    patience: int = 5
    """Bursts that come no further, before the search starts again from the start."""
    again: float = 0.5
    """Probability of a walk to do the same as before, where it can: runs of body moves, as in the genetic planner's fresh tails."""


def plan_random(
    task: Task,
    *,
    seed: int = 0,
    seconds: float | None = None,
    threads: int | None = None,
    max_checks: int = MAX_CHECKS,
    progress: Listener | None = None,
    bursts: Bursts | None = None,
) -> PlanResult:
    """Walk at random, jump to where the best walk led, start again where none leads further; keep the shortest plan.

    Args:
        task: What to plan.
        seed: Same seed, same plan.
        seconds: Most time [s].
        threads: The search runs on one.
        max_checks: Most actions to judge.
        progress: Called now and then.
        bursts: How its walks are made.

    Returns:
        "found", or "stopped" with the furthest stance.

    Raises:
        PlannerError: If the task allows actions that can't be listed one by one.
    """
    hunt, made = SearchBudget("random", task, seed, max_checks, seconds, progress), bursts or Bursts()
    problem = hunt.problem
    params, weights = problem.params.record, guidance(problem)
    room = scratch_for(problem, 3)
    here = np.zeros(2, problem.start.dtype)
    trail, best = (np.zeros(max(1, hunt.longest), np.int32) for _ in range(2))
    number = 0
    with hunt:
        before = -1
        while not hunt.is_over and hunt.checks > before:
            before = hunt.checks
            here[:] = problem.start[0]
            way, value, stale, reached = np.zeros(0, np.int32), -np.inf, 0, False
            while not reached and stale < made.patience and not hunt.is_over:
                most = min(made.length << stale, hunt.longest - len(way))
                if most < 0:
                    break
                how = (made.again, made.walks, most, max_checks - hunt.checks)
                actions, value, judged, reached = burst(
                    params, here, room, weights, how, (seed, number), (trail, best), value
                )
                number += 1
                hunt.checks += int(judged)
                stale = 0 if actions > 0 else stale + 1
                way = np.concatenate([way, best[: max(0, actions)]])
                hunt.take(way, value, found=reached)
            hunt.tell()
    return hunt.result()
