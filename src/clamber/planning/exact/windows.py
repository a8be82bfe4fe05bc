"""Make a plan shorter by exact search between its own stances: windows that grow until none helps (the plan stays valid throughout)."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from ..problem.problem import CompiledProblem
from ..stance_table import rehash
from .window_kernels import search_window, stance_keys

Codes = npt.NDArray[np.int32]
SHORTEST: Final = 6
"""Actions of the smallest window."""
GROWTH: Final = 1.5
"""A window's length as a multiple of the one before."""


@dataclass(frozen=True, slots=True)
class Shortened:
    """A plan made shorter, and what that cost."""

    codes: Codes
    """The plan; the one given where nothing helped."""
    stances: int
    """Stances seen, all searches together."""
    checks: int
    """Actions judged."""
    complete: bool
    """Whether every search ended by itself, rather than by its limit."""
    interrupted: bool = False
    """Whether Ctrl-C ended it; the plan is the shortest up to then."""


class WindowSearch:
    """The memory of window searches, used again for each."""

    def __init__(self, problem: CompiledProblem, most: int) -> None:
        """Take memory for windows of at most `most` stances."""
        capacity = most + problem.branching
        self.keys = np.zeros((capacity, problem.key_words), np.int64)
        self.g = np.zeros(capacity, np.int32)
        self.closed = np.zeros(capacity, np.uint8)
        self.parent = np.zeros(capacity, np.int32)
        self.code = np.zeros(capacity, np.int32)
        self.entries = np.zeros(capacity, np.int32)
        self.following = np.zeros(capacity, np.int64)
        self.table = np.zeros(table_size(capacity), np.int32)
        self.codes = np.zeros(problem.branching, np.int32)
        self.stances = np.zeros(2, problem.start.dtype)
        self.margins = np.zeros(len(problem.checks))
        self.words = np.zeros(problem.key_words, np.int64)
        self.state = np.zeros(5, np.int64)
        self.seen = 0
        self.checks = 0
        self.complete = True

    def shorten(self, problem: CompiledProblem, codes: Codes, first: int, last: int) -> Codes:
        """The plan with a shorter way from its stance `first` on, or as it is.

        A window that ends where the plan does may end in any goal stance.

        Args:
            problem: The task.
            codes: A plan that holds; every hold named.
            first, last: The window.
        """
        replayed = problem.replay(codes)
        plan = replayed.stances
        to_goal = last == len(codes)
        near = problem if to_goal else problem.without_more_hangs(plan[first : first + 1])
        if not to_goal and near is not problem and plan["hangs"][last] != plan["hangs"][first]:
            near = problem
        params = near.params.record
        keys = np.zeros((len(plan), problem.key_words), np.int64)
        stance_keys(params, plan, keys)
        table = np.zeros(table_size(len(plan)), np.int32)
        table[:] = -1
        rehash(keys, len(plan), table)
        heads = np.zeros(len(plan) + 1, np.int64)
        search_window(
            params, plan, keys, table, first, last, to_goal, self.keys, self.g, self.closed, self.parent, self.code,
            self.entries, self.following, heads, self.table, self.codes, self.stances, self.margins, self.words,
            self.state,
        )  # fmt: skip
        nodes, judged, node, rejoined, saved = (int(value) for value in self.state)
        self.seen += nodes
        self.checks += judged
        self.complete &= nodes + problem.branching <= len(self.keys)
        if not saved:
            return codes
        way = trace(self.parent, self.code, node)
        shorter = np.concatenate([codes[:first], way, codes[rejoined:]]).astype(np.int32)
        return shorter if is_plan(problem, shorter) else codes


def shorten_by_windows(
    problem: CompiledProblem,
    codes: Codes,
    *,
    most: int = 20_000,
    effort: int = 1_000_000,
    seconds: float | None = None,
    tell: Callable[[int], None] | None = None,
) -> Shortened:
    """Make a plan shorter: windows of growing length slide over it until none saves an action.

    Args:
        problem: The task.
        codes: A plan that holds and reaches the goal; every hold named (`Problem.resolve`).
        most: Most stances of one window.
        effort: Most stances of all windows together; the last window may go beyond it.
        seconds: Most time [s].
        tell: Called with the length of the plan after each window.

    Returns:
        A plan that holds, reaches the goal, and is never longer.
    """
    started = time.monotonic()
    search = WindowSearch(problem, most)
    length, first = SHORTEST, 0
    try:
        while len(codes) > 1:
            if search.seen >= effort or (seconds is not None and time.monotonic() - started >= seconds):
                search.complete = False
                break
            length = min(length, len(codes))
            before = len(codes)
            codes = search.shorten(problem, codes, first, min(before, first + length))
            if tell is not None:
                tell(len(codes))
            if len(codes) < before:
                first = max(0, first - length // 2)
            elif first + length < before:
                first += max(1, length // 3)
            elif length < before:
                length, first = int(GROWTH * length), 0
            else:
                break
    except KeyboardInterrupt:
        return Shortened(codes, search.seen, search.checks, complete=False, interrupted=True)
    return Shortened(codes, search.seen, search.checks, search.complete)


def is_plan(problem: CompiledProblem, codes: Codes) -> bool:
    """Whether codes hold all the way and end in a goal stance."""
    replayed = problem.replay(codes)
    return replayed.ok and problem.is_done(replayed.stances[-1:])


def table_size(entries: int) -> int:
    """A power of two, at least twice as many as the entries."""
    return 1 << int(np.ceil(np.log2(2 * max(2, entries))))


def trace(parent: npt.NDArray[np.int32], code: npt.NDArray[np.int32], node: int) -> Codes:
    """Actions from node 0 to a node."""
    codes = []
    while node > 0:
        codes.append(int(code[node]))
        node = int(parent[node])
    return np.array(codes[::-1], np.int32)
