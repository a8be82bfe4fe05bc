"""The rival `greedy`: best-first search by progress alone (Doran and Michie 1966), with every stance seen remembered."""

from typing import Final

import numpy as np

from ...tasks import Task
from ...types import Ints
from ..progress import Listener
from ..result import PlanResult
from .answer import MAX_CHECKS, Hunt
from .greedy_kernels import BEST, CHECKS, EXHAUSTED, FOUND, FULL, GOAL, NODES, OPEN, RUNNING, greedy, plant_root
from .guidance import guidance

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
        seconds: Most wall-clock time [s].
        threads: The search runs on one.
        max_checks: Most actions to judge; a stance being expanded is finished.
        max_stances: Memory: most stances kept.
        progress: Called now and then.

    Returns:
        "found", "infeasible", or "stopped" with the furthest stance.

    Raises:
        PlannerError: If the task allows actions that can't be listed one by one.
    """
    hunt = Hunt("greedy", task, seed, max_checks, seconds, progress)
    problem = hunt.problem
    params, weights = problem.params.record, guidance(problem)
    capacity = min(max_stances, max_checks + 1) + problem.branching
    keys = np.zeros((capacity, problem.key_words), np.int64)
    value = np.zeros(capacity)
    parent, code, heap = (np.zeros(capacity, np.int32) for _ in range(3))
    table = np.full(1 << int(np.ceil(np.log2(2 * capacity))), -1, np.int32)
    codes, stances = np.zeros(problem.branching, np.int32), np.zeros(2, problem.start.dtype)
    margins, row = np.zeros(len(problem.checks)), np.zeros(len(problem.features))
    words = np.zeros(problem.key_words, np.int64)
    state = np.zeros(6, np.int64)
    state[NODES] = state[OPEN] = 1
    parent[0] = state[GOAL] = -1
    plant_root(params, problem.start, weights, keys, value, table, row)
    status = FOUND if hunt.found else RUNNING
    try:
        while status == RUNNING and not hunt.is_over:
            status = greedy(
                params, weights, keys, value, parent, code, heap, table, state, codes, stances, margins, row, words,
                max_checks, QUOTA,
            )  # fmt: skip
            hunt.checks = int(state[CHECKS])
            hunt.value = float(value[state[BEST]])
            hunt.tell()
    except KeyboardInterrupt:
        hunt.interrupted = True
    end = max(0, int(state[GOAL])) if status == FOUND else int(state[BEST])
    hunt.value = -np.inf
    hunt.take(_way_to(end, parent, code), float(value[end]), found=status == FOUND)
    full = status == FULL and hunt.checks < max_checks
    return hunt.result(
        exhausted=int(state[NODES]) if status == EXHAUSTED else None,
        spent="memory was full" if full else "the budget ran out",
    )


def _way_to(node: int, parent: Ints, code: Ints) -> Ints:
    codes = []
    while parent[node] >= 0:
        codes.append(int(code[node]))
        node = int(parent[node])
    return np.array(codes[::-1], np.int32)
