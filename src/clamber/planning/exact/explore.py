"""Drive one exact search: memory that grows to a stated limit, time, interrupts, and what came of it."""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from ...interrupts import Interruptible
from ...types import Ints
from ..problem.arrays import with_room
from ..problem.problem import CompiledProblem
from ..progress import Clock
from ..stance_table import rehash, scratch_for, table_size
from .costs import COSTS, Aim
from .kernels import explore_some, furthest, plant
from .records import EXHAUSTED, FOUND, FULL, LABEL, NEAREST, NEWEST, NODE, RUNNING, SEARCH, SHORTEST, STATE, Seen

BUCKETS: Final = 1 << 16
FIRST: Final = 1 << 14
"""Stances that memory is taken for at first."""
LABELS_PER_STANCE: Final = 4
"""Ways kept at most, per stance of the limit."""


class Memory:
    """What a search knows; doubles when it is full, until `most` stances."""

    def __init__(self, problem: CompiledProblem, most: int) -> None:
        self.most = most
        room = min(most, max(FIRST, 2 * problem.branching))
        self.heads = np.full(BUCKETS, -1, np.int32)
        self.steps = np.full(BUCKETS, -1, np.int32)
        self.keys = np.zeros((room, problem.key_words), np.int64)
        self.nodes = np.zeros(room, NODE)
        self.labels = np.zeros(2 * room, LABEL)
        self.state = np.zeros(1, STATE)
        self.state["goal"] = -1
        self.table = self._table()

    @property
    def seen(self) -> Seen:
        """As kernels take it."""
        return Seen(self.nodes, self.keys, self.labels, self.heads, self.steps, self.table)

    def _table(self) -> Ints:
        table = np.full(table_size(len(self.keys)), -1, np.int32)
        rehash(self.keys, int(self.state["nodes"][0]), table)
        return table

    def grow(self, branching: int) -> bool:
        """Make room; False if the limit is reached."""
        state = self.state[0]
        done = False
        if state["labels"] + branching > len(self.labels) and len(self.labels) < LABELS_PER_STANCE * self.most:
            self.labels = with_room(self.labels, min(LABELS_PER_STANCE * self.most, 2 * len(self.labels)))
            done = True
        if state["nodes"] + branching > len(self.keys) and len(self.keys) < self.most:
            room = min(self.most, 2 * len(self.keys))
            self.keys, self.nodes = with_room(self.keys, room), with_room(self.nodes, room)
            self.table = self._table()
            done = True
        return done

    def trace(self, problem: CompiledProblem, label: int) -> Ints:
        """Actions from the start along a label; those between a stance that was kept and the mirror image that is meant are mirrored."""
        line = []
        while label >= 0:
            line.append(label)
            label = int(self.labels["parent"][label])
        codes = []
        flipped = bool(self.labels["flipped"][line[-1]])
        for at in line[-2::-1]:
            code = int(self.labels["code"][at])
            codes.append(problem.mirrored(code) if flipped else code)
            flipped ^= bool(self.labels["flipped"][at])
        return np.array(codes, np.int32)

    def label_of(self, node: int) -> int:
        """A label of a stance: the first one made, which is no worse a way to be there than any other for who only looks."""
        return int(np.argmax(self.labels["node"][: int(self.state["labels"][0])] == node))


FIRST_QUOTA: Final = 64
"""Stances expanded before the first look at the clock."""
QUOTA: Final = 20_000
"""Most stances expanded between two looks at the clock."""
LOOK: Final = 0.2
"""Between two looks at the clock, about [s]; a stance of some robots takes a hundred times as long as one of others."""
FINENESS: Final = {"effort": 64, "peak": BUCKETS / 16}
"""Buckets per start stance's cost, where costs aren't whole."""
LEAST_ACTIONS: Final = Aim()


@dataclass(frozen=True, slots=True)
class CostedPlan:
    """A plan that an exact search found."""

    codes: Ints
    first: float
    """Its first cost, in the unit of its feature."""
    second: float
    """Its second cost; 0 without one."""


@dataclass(frozen=True, slots=True)
class Exploration:
    """What an exact search found, or how the space ended."""

    found: bool
    """The plan is proved to be the best; in a front, all of it is there."""
    exhausted: bool
    """The whole reachable space was seen: there is no plan (within `at_most`)."""
    interrupted: bool
    codes: Ints
    """The best plan known; without one, the way to the furthest stance."""
    ways: tuple[CostedPlan, ...]
    """Plans found, the shortest first; one, unless a front was asked for."""
    stances: int
    """Different stances seen."""
    expanded: int
    checks: int
    """Actions judged."""
    dead: int
    """Stances from which the relaxed problem rules out every goal."""
    dominated: int
    """Stances dropped because a dominating one was reached at no more cost."""
    lower_bound: float
    """No plan has less of the first cost."""
    forbidden: dict[str, int]
    """Check -> actions it forbade."""


def inform(problem: CompiledProblem, seconds: float | None) -> tuple[CompiledProblem, float | None]:
    """The problem with its family's best bound, as far as that can be worked out in `seconds`, and what is left of them [s]."""
    clock = Clock(seconds)

    return problem.informed(lambda: clock.is_over), clock.left


def explore(
    problem: CompiledProblem,
    *,
    most_stances: int,
    seconds: float | None = None,
    tell: Callable[[int, float], None] | None = None,
    aim: Aim = LEAST_ACTIONS,
    dominance: bool = True,
) -> Exploration:
    """Find the best plan, or see the whole reachable space.

    A* with the family's consistent bound where the first cost is the length; other costs are searched without a bound.

    Args:
        problem: The task; `problem.informed()` has the better bound.
        most_stances: Memory: most stances kept (about 150 bytes and a key each, half as much again while memory grows).
        seconds: Most time [s]; the first stances are expanded whatever it is, so that the bound at the start is known.
        tell: Called now and then with stances seen and the lower bound.
        aim: What is minimized.
        dominance: Drop stances for dominating ones (more goals met, fewer hangs used) reached at no more cost.

    Returns:
        The exploration; Ctrl-C, time and memory end it with a lower bound.
    """
    clock = Clock(seconds)
    memory = Memory(problem, most_stances)
    params, state = problem.params.record, memory.state
    room = scratch_for(problem, 4, keys=2)
    tally = np.zeros(len(problem.checks), np.int64)
    search = search_record(problem, aim, dominance=dominance)
    planted = plant(params, search, state[0], problem.start, memory.seen, room)
    status = RUNNING if planted else EXHAUSTED
    body = problem.features.index("body")
    furthest(params, memory.keys, int(planted), room.stances, room.row, body)  # after Ctrl-C nothing is compiled
    with Interruptible() as block:
        quota, looked = FIRST_QUOTA, time.monotonic()
        while status in (RUNNING, FULL):
            if status == FULL and not memory.grow(problem.branching):
                break
            status = explore_some(params, search, state[0], memory.seen, room, tally, quota)
            if tell is not None and status != EXHAUSTED:  # nothing is open any more, so there is no least cost of it
                tell(int(state["nodes"][0]), _reached(state, search))
            before, looked = looked, time.monotonic()
            if clock.is_over:
                break
            took = looked - before
            quota = min(QUOTA, 2 * quota) if took < LOOK / 2 else max(FIRST_QUOTA, quota // 2) if took > LOOK else quota
    ways = _ways(problem, memory)
    if ways:
        best = ways[0].codes
    else:
        n = int(state["nodes"][0])
        node = furthest(params, memory.keys, n, room.stances, room.row, body)
        best = memory.trace(problem, memory.label_of(node)) if planted else np.zeros(0, np.int32)
    return Exploration(
        found=status == FOUND,
        exhausted=status == EXHAUSTED,
        interrupted=block.interrupted,
        codes=best,
        ways=ways,
        stances=int(state["nodes"][0]),
        expanded=int(state["expanded"][0]),
        checks=int(state["checks"][0]),
        dead=int(state["dead"][0]),
        dominated=int(state["dominated"][0]),
        lower_bound=ways[0].first if status == FOUND else _reached(state, search),
        forbidden={name: int(n) for name, n in zip(problem.checks, tally, strict=True) if n},
    )


def search_record(problem: CompiledProblem, aim: Aim, *, dominance: bool) -> np.void:
    """An aim as the record that the kernel reads."""
    assert not aim.front or aim.first == "length", "a front is searched in order of length"
    search = np.zeros(1, SEARCH)
    row: np.void = search[0]
    row["first"] = problem.features.index(COSTS[aim.first])
    row["second"] = -1 if aim.second is None else problem.features.index(COSTS[aim.second])
    row["capped"] = -1 if aim.most_peak is None else problem.features.index("peak")
    row["cap"] = math.inf if aim.most_peak is None else aim.most_peak
    row["front"], row["informed"], row["dominance"] = aim.front, aim.first == "length", dominance
    row["order"] = NEAREST if COSTS[aim.first] == "peak" else NEWEST if aim.second is None else SHORTEST
    row["at_most"] = math.inf if aim.at_most is None else aim.at_most
    row["width"] = 1.0
    if aim.first != "length":  # any width gives the same answer; this one keeps buckets small and few
        row["width"] = (problem.measured(problem.start)[0, row["first"]] or 1.0) / FINENESS[COSTS[aim.first]]
    return row


def _reached(state: np.ndarray, search: np.void) -> int | float:
    """The lower bound on the first cost that the search has proved."""
    lowest = max(int(state["lowest"][0]), 0) * float(search["width"])  # below 0 until the search has begun
    return int(lowest) if search["informed"] else lowest


def _ways(problem: CompiledProblem, memory: Memory) -> tuple[CostedPlan, ...]:
    """The plans found, the shortest first; of equals in the first cost the last found, which has less of the second."""
    ways: list[CostedPlan] = []
    label = int(memory.state["goal"][0])
    while label >= 0:
        made = memory.labels[label]
        if not ways or made["first"] < ways[-1].first:
            ways.append(CostedPlan(memory.trace(problem, label), float(made["first"]), float(made["second"])))
        label = int(made["next"])
    return tuple(ways[::-1])
