"""Drive the greedy search: memory that grows to a stated limit, time, interrupts, and what came of it."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from ..errors import PlannerError
from ..interrupts import Interruptible
from ..tasks import Task
from .problem.arrays import CostToGoMap, with_room
from .problem.plan import Plan
from .problem.problem import CompiledProblem
from .problem.problems import listed_problem, plan_family
from .progress import Clock, Listener, Routing
from .result import PlanResult, furthest_of
from .route_kernels import (
    BEST,
    EXHAUSTED,
    FOUND,
    FULL,
    GOAL,
    JUDGED,
    LOWEST,
    NODES,
    ROUGH,
    RUNNING,
    Guide,
    Nodes,
    plant,
    search,
)
from .stance_table import path_to, rehash, scratch_for, table_size

QUOTA: Final = 5000
"""Stances expanded between looks at the clock."""
BUCKETS: Final = 1 << 18
"""Largest cost plus weighted way left that the open list tells apart [actions]."""
FIRST: Final = 1 << 14
"""Nodes that memory is taken for at first."""


@dataclass(frozen=True, slots=True)
class Climb:
    """What a greedy search came to."""

    found: bool
    exhausted: bool
    """Every stance that it can tell apart was seen."""
    interrupted: bool
    codes: npt.NDArray[np.int32]
    """The plan; without one, the way to the stance with the least way left."""
    stances: int
    """Stances seen."""
    checks: int
    """Actions judged."""
    left: float
    """Least way left that a stance had [steps]."""
    forbidden: dict[str, int]
    """Check -> actions it forbade."""


class _Memory:
    """The arrays of a search; they double until `most` nodes."""

    def __init__(self, problem: CompiledProblem, most: int) -> None:
        self.all = Nodes(
            keys=np.zeros((0, problem.key_words), np.int64),
            g=np.zeros(0, np.int32),
            way=np.zeros(0, np.float32),
            parent=np.zeros(0, np.int32),
            code=np.zeros(0, np.int32),
            following=np.zeros(0, np.int32),
            heads=np.full(BUCKETS, -1, np.int32),
            table=np.zeros(0, np.int32),
        )
        self.grow(min(most, max(FIRST, 2 * problem.branching)), 0)

    @property
    def capacity(self) -> int:
        return len(self.all.keys)

    def grow(self, capacity: int, used: int) -> None:
        names = ("keys", "g", "way", "parent", "code", "following")
        longer = {name: with_room(getattr(self.all, name), capacity) for name in names}
        self.all = self.all._replace(table=np.full(table_size(capacity), -1, np.int32), **longer)
        rehash(self.all.keys, used, self.all.table, ROUGH)


def climb(
    problem: CompiledProblem,
    fields: CostToGoMap,
    *,
    weight: float,
    share: float,
    crowding: float,
    most_stances: int,
    seconds: float | None = None,
    tell: Callable[[int, int, float, float], None] | None = None,
) -> Climb:
    """Search greedily from the problem's start to its last goal.

    Args:
        problem: The task.
        fields: The map of ways.
        weight: How much a step of way left counts beside an action made: large is fast, small makes shorter plans.
        share: Weight of the limbs' way beside the body's.
        crowding: By how much a stance expanded at a place makes the way left from there longer [steps].
        most_stances: Memory: most stances kept.
        seconds: Most time [s].
        tell: Called now and then with stances seen, actions of the best stance, its way left and that of the start [steps].

    Returns:
        The plan, or how far it came; Ctrl-C, time and memory end it.
    """
    clock = Clock(seconds)
    nodes = _Memory(problem, most_stances)
    params = problem.params.record
    state = np.zeros(6, np.int64)
    state[NODES], state[GOAL] = 1, -1
    room, tally = scratch_for(problem), np.zeros(len(problem.checks), np.int64)
    visits = np.zeros(fields.fields.shape[1:], np.int32)
    guide = Guide(fields.fields, fields.frame, fields.hold_fields, fields.after, share, weight, visits, crowding)
    state[LOWEST] = plant(params, problem.start, nodes.all, guide)
    if problem.is_done(problem.start):
        state[GOAL] = 0
    status = FOUND if state[GOAL] == 0 else RUNNING
    with Interruptible() as block:
        while status in (RUNNING, FULL) and not clock.is_over:
            if status == FULL:
                if nodes.capacity >= most_stances:
                    break
                nodes.grow(min(most_stances, 2 * nodes.capacity), int(state[NODES]))
            status = search(params, nodes.all, guide, state, room, tally, QUOTA)
            if tell is not None:
                best = int(state[BEST])
                tell(int(state[NODES]), int(nodes.all.g[best]), float(nodes.all.way[best]), float(nodes.all.way[0]))
    goal = int(state[GOAL]) if status == FOUND else int(state[BEST])
    return Climb(
        found=status == FOUND,
        exhausted=status == EXHAUSTED,
        interrupted=block.interrupted,
        codes=path_to(nodes.all.parent, nodes.all.code, goal),
        stances=int(state[NODES]),
        checks=int(state[JUDGED]),
        left=float(nodes.all.way[int(state[BEST])]),
        forbidden={name: int(n) for name, n in zip(problem.checks, tally, strict=True) if n},
    )


WEIGHTS: Final = (8.0, 3.0, 1.5)
"""How much the way left counts, search by search: the first finds a plan, the others look for shorter ones."""
SHARE: Final = 0.2
"""Weight of the limbs' way beside the body's [-]."""
CROWDING: Final = 0.2
"""By how much a stance expanded at a place makes the way left from there longer [steps]: dead ends fill up and are left."""
MOST_STANCES: Final = 4_000_000
"""Stances kept unless told otherwise: about half a GB; half as much again while it grows."""
EFFORT: Final = 5
"""A search for a shorter plan may see so many times the stances of the first."""


def plan_route(
    task: Task,
    *,
    seed: int = 0,
    seconds: float | None = None,
    threads: int | None = None,
    max_stances: int = MOST_STANCES,
    progress: Listener | None = None,
) -> PlanResult:
    """Find a plan over a board of any size; choose it where the way is long.

    A map of the wall says how far each place is from each goal, over places with holds in reach. Stances are then expanded in the order of
    actions made plus the weighted way left; the more stances of a place have been expanded, the longer its way counts, so that the search
    leaves dead ends. Its time grows with the length of the way and with the dead ends on it, not with the board.

    Args:
        task: What to plan.
        seed: Only written down: nothing here is drawn at random.
        seconds: Most time [s].
        threads: The search itself runs on one; replays take as many as given.
        max_stances: Memory: most stances kept. Running out is a result ("stopped").
        progress: Called now and then.

    Returns:
        "found", or "stopped" with the furthest stance; it proves nothing.

    Raises:
        PlannerError: If the task has no board of holds, or allows actions that can't be listed one by one.
    """
    clock = Clock(seconds)
    problem = listed_problem(task, "route", threads=threads)
    fields = problem.ways()
    if fields is None:
        raise PlannerError("route", task.name, "its world has no holds; take the genetic or the exact planner")

    def tell(stances: int, actions: int, left: float, whole: float) -> None:
        if progress is not None:
            progress(Routing(stances, actions, 1.0 - left / whole if whole > 0.0 else 1.0))

    best, checks, stances, first_length, first_checks = None, 0, 0, None, None
    for weight in WEIGHTS:
        left = clock.left
        most = max_stances if best is None else min(max_stances, EFFORT * best.stances)
        seen = climb(
            problem, fields, weight=weight, share=SHARE, crowding=CROWDING, most_stances=most, seconds=left, tell=tell
        )
        checks, stances = checks + seen.checks, stances + seen.stances
        if best is None or (seen.found and len(seen.codes) < len(best.codes)):
            best = seen
        if seen.found and first_length is None:
            first_length, first_checks = len(seen.codes), checks
        if not best.found or seen.interrupted or clock.is_over:
            break
    assert best is not None
    family = plan_family(task)
    replayed = problem.replay(best.codes)
    return PlanResult(
        status="found" if best.found else "stopped",
        plan=Plan.of_codes(task, best.codes, seed=seed, planner="route"),
        task=task,
        reason=_reason(best, stances),
        evaluations=0,
        checks=checks,
        seconds=clock.spent,
        seed=seed,
        planner="route",
        max_torque=float(np.max([family.torque(stance) for stance in replayed.stances[1:]], initial=0.0)),
        furthest=None if best.found else furthest_of(task, problem, best.codes),
        stances=stances,
        first_length=first_length,
        first_checks=first_checks,
    )


def _reason(best: Climb, stances: int) -> str:
    if best.found:
        return (
            f"reached every goal after {stances} stances" if len(best.codes) else "the start meets every goal already"
        )
    closed = ", ".join(f"{name} {n}" for name, n in sorted(best.forbidden.items(), key=lambda item: -item[1])[:3])
    if best.exhausted:
        why = f"all {stances} stances that differ by a quarter of a step or a hold were seen, and none meets the goal"
        return f"{why}; this search proves nothing; actions forbidden: {closed}"
    why = "interrupted" if best.interrupted else "out of time or memory"
    return f"{why} after {stances} stances, about {best.left:.0f} steps from the goal; actions forbidden: {closed}"
