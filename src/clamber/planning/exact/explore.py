"""Drive the exact search: memory that grows to a stated limit, time, interrupts, and what came of it."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from ...actions.problem import CompiledProblem
from .kernels import EXHAUSTED, FOUND, FULL, RUNNING, furthest, plant, rehash, search

QUOTA: Final = 20_000
"""Stances expanded between looks at the clock."""
BUCKETS: Final = 1 << 16
"""Largest cost plus bound [actions]."""
FIRST: Final = 1 << 14
"""Nodes that memory is taken for at first."""


@dataclass(frozen=True, slots=True)
class Exploration:
    """What an exact search found, or how the space ended."""

    found: bool
    exhausted: bool
    """The whole reachable space was seen: there is no plan."""
    interrupted: bool
    codes: npt.NDArray[np.int32]
    """The shortest plan; without one, the way to the furthest stance."""
    stances: int
    """Different stances seen."""
    expanded: int
    checks: int
    """Actions judged."""
    lower_bound: int
    """No plan has fewer actions."""
    forbidden: dict[str, int]
    """Check -> actions that it forbade."""


class _Memory:
    """The arrays of a search; they double until `most` nodes."""

    def __init__(self, problem: CompiledProblem, most: int) -> None:
        self.most = most
        self.words = problem.key_words
        self.capacity = 0
        self.heads = np.full(BUCKETS, -1, np.int64)
        self.keys = np.zeros((0, self.words), np.int64)
        self.g = np.zeros(0, np.int32)
        self.closed = np.zeros(0, np.uint8)
        self.parent = np.zeros(0, np.int32)
        self.code = np.zeros(0, np.int32)
        self.entries = np.zeros(0, np.int32)
        self.following = np.zeros(0, np.int64)
        self.table = np.zeros(0, np.int32)
        self.grow(min(most, max(FIRST, 2 * problem.branching)), 0)

    def grow(self, capacity: int, used: int) -> None:
        for name in ("keys", "g", "closed", "parent", "code", "entries", "following"):
            old = getattr(self, name)
            new = np.zeros((capacity, *old.shape[1:]), old.dtype)
            new[: len(old)] = old
            setattr(self, name, new)
        self.capacity = capacity
        self.table = np.full(1 << int(np.ceil(np.log2(2 * capacity))), -1, np.int32)
        rehash(self.keys, used, self.table)


def explore(
    problem: CompiledProblem,
    *,
    most_stances: int,
    seconds: float | None = None,
    tell: Callable[[int, int], None] | None = None,
) -> Exploration:
    """Find a plan with the fewest actions, or see the whole reachable space.

    A* with unit costs and the family's consistent bound; a stance is expanded once, so the first goal stance taken from the open list
    ends a shortest plan.

    Args:
        problem: The task.
        most_stances: Memory: most stances kept (about 40 bytes and a key each, half as much again while memory grows).
        seconds: Most time [s].
        tell: Called now and then with stances seen and the lower bound.

    Returns:
        The exploration; Ctrl-C, time and memory end it with a lower bound.
    """
    started = time.monotonic()
    memory = _Memory(problem, most_stances)
    params = problem.params.record
    state = np.zeros(6, np.int64)
    state[0] = state[5] = 1
    state[4] = -1
    codes = np.zeros(problem.branching, np.int32)
    stances = np.zeros(2, problem.start.dtype)
    margins = np.zeros(len(problem.checks))
    words = np.zeros(memory.words, np.int64)
    tally = np.zeros(len(problem.checks), np.int64)
    state[1] = plant(
        params, problem.start, memory.keys, memory.g, memory.parent, memory.code, memory.entries, memory.following,
        memory.heads, memory.table,
    )  # fmt: skip
    status, interrupted = RUNNING, False
    try:
        while status in (RUNNING, FULL) and (seconds is None or time.monotonic() - started < seconds):
            if status == FULL:
                if memory.capacity >= most_stances:
                    break
                memory.grow(min(most_stances, 2 * memory.capacity), int(state[0]))
            status = search(
                params, memory.keys, memory.g, memory.closed, memory.parent, memory.code, memory.entries,
                memory.following, memory.heads, memory.table, state, codes, stances, margins, words, tally, QUOTA,
            )  # fmt: skip
            if tell is not None:
                tell(int(state[0]), int(state[1]))
    except KeyboardInterrupt:
        interrupted = True
    goal = int(state[4])
    if goal < 0:
        row = np.zeros(len(problem.features))
        goal = furthest(params, memory.keys, int(state[0]), stances, row, problem.features.index("body"))
    return Exploration(
        found=status == FOUND,
        exhausted=status == EXHAUSTED,
        interrupted=interrupted,
        codes=_trace(memory, goal),
        stances=int(state[0]),
        expanded=int(state[2]),
        checks=int(state[3]),
        lower_bound=min(int(state[1]), BUCKETS),
        forbidden={name: int(n) for name, n in zip(problem.checks, tally, strict=True) if n},
    )


def _trace(memory: _Memory, node: int) -> npt.NDArray[np.int32]:
    """Actions from the start to a node."""
    codes = []
    while memory.parent[node] >= 0:
        codes.append(int(memory.code[node]))
        node = int(memory.parent[node])
    return np.array(codes[::-1], np.int32)
