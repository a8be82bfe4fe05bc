"""Drive the greedy search: memory that grows to a stated limit, time, interrupts, and what came of it."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from ..problem.problem import CompiledProblem
from ..problem.ways import WayFields
from .kernels import BEST, EXHAUSTED, FOUND, FULL, GOAL, JUDGED, LOWEST, NODES, RUNNING, plant, rehash_rough, search

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
    """Check -> actions that it forbade."""


class _Nodes:
    """The arrays of a search; they double until `most` nodes."""

    def __init__(self, problem: CompiledProblem, most: int) -> None:
        words = problem.key_words
        self.capacity = 0
        self.heads = np.full(BUCKETS, -1, np.int32)
        self.keys = np.zeros((0, words), np.int64)
        self.g = np.zeros(0, np.int32)
        self.way = np.zeros(0, np.float32)
        self.parent = np.zeros(0, np.int32)
        self.code = np.zeros(0, np.int32)
        self.following = np.zeros(0, np.int32)
        self.table = np.zeros(0, np.int32)
        self.grow(min(most, max(FIRST, 2 * problem.branching)), 0)

    def grow(self, capacity: int, used: int) -> None:
        for name in ("keys", "g", "way", "parent", "code", "following"):
            old = getattr(self, name)
            new = np.zeros((capacity, *old.shape[1:]), old.dtype)
            new[: len(old)] = old
            setattr(self, name, new)
        self.capacity = capacity
        self.table = np.full(1 << int(np.ceil(np.log2(2 * capacity))), -1, np.int32)
        rehash_rough(self.keys, used, self.table)


def climb(
    problem: CompiledProblem,
    fields: WayFields,
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
    started = time.monotonic()
    nodes = _Nodes(problem, most_stances)
    params = problem.params.record
    state = np.zeros(6, np.int64)
    state[NODES], state[GOAL] = 1, -1
    codes = np.zeros(problem.branching, np.int32)
    stances = np.zeros(2, problem.start.dtype)
    margins, tally = np.zeros(len(problem.checks)), np.zeros(len(problem.checks), np.int64)
    words = np.zeros(problem.key_words, np.int64)
    visits = np.zeros(fields.fields.shape[1:], np.int32)
    guide = (fields.fields, fields.frame, fields.hold_fields, fields.after, share, weight)
    state[LOWEST] = plant(
        params, problem.start, nodes.keys, nodes.g, nodes.way, nodes.parent, nodes.code, nodes.following, nodes.heads,
        nodes.table, *guide,
    )  # fmt: skip
    if problem.is_done(problem.start):
        state[GOAL] = 0
    status, interrupted = FOUND if state[GOAL] == 0 else RUNNING, False
    try:
        while status in (RUNNING, FULL) and (seconds is None or time.monotonic() - started < seconds):
            if status == FULL:
                if nodes.capacity >= most_stances:
                    break
                nodes.grow(min(most_stances, 2 * nodes.capacity), int(state[NODES]))
            status = search(
                params, nodes.keys, nodes.g, nodes.way, nodes.parent, nodes.code, nodes.following, nodes.heads,
                nodes.table, state, codes, stances, margins, words, tally, *guide, visits, crowding, QUOTA,
            )  # fmt: skip
            if tell is not None:
                best = int(state[BEST])
                tell(int(state[NODES]), int(nodes.g[best]), float(nodes.way[best]), float(nodes.way[0]))
    except KeyboardInterrupt:
        interrupted = True
    goal = int(state[GOAL]) if status == FOUND else int(state[BEST])
    return Climb(
        found=status == FOUND,
        exhausted=status == EXHAUSTED,
        interrupted=interrupted,
        codes=_trace(nodes, goal),
        stances=int(state[NODES]),
        checks=int(state[JUDGED]),
        left=float(nodes.way[int(state[BEST])]),
        forbidden={name: int(n) for name, n in zip(problem.checks, tally, strict=True) if n},
    )


def _trace(nodes: _Nodes, node: int) -> npt.NDArray[np.int32]:
    """Actions from the start to a node."""
    codes = []
    while nodes.parent[node] >= 0:
        codes.append(int(nodes.code[node]))
        node = int(nodes.parent[node])
    return np.array(codes[::-1], np.int32)
