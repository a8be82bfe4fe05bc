"""Make a plan shorter by the shortest way through the stances about it: finds detours that are nowhere wrong by a window alone."""

import time
from collections.abc import Callable
from typing import Final

import numpy as np

from ..problem.problem import CompiledProblem
from .corridor_kernels import collect, shortest
from .windows import Codes, Shortened, is_plan, table_size, trace

FIRST: Final = 10_000
"""Stances of the first corridor."""
GROWTH: Final = 4
"""Stances of a corridor as a multiple of those of the one before, when that held nothing shorter."""
EDGES: Final = 12
"""Ways on per stance that memory is taken for; where there are more, the corridor gets narrower."""


def shorten_in_corridor(
    problem: CompiledProblem,
    codes: Codes,
    *,
    most: int = 200_000,
    effort: int = 1_000_000,
    seconds: float | None = None,
    tell: Callable[[int], None] | None = None,
) -> Shortened:
    """Make a plan shorter: the shortest plan among all stances near it, again and again, in corridors that widen until none helps.

    The neighbourhood graph of Nakhost and Mueller (Action elimination and plan neighborhood graph search, ICAPS 2010), without the
    stances that no shorter plan can visit.

    Args:
        problem: The task.
        codes: A plan that holds and reaches the goal; every hold named (`Problem.resolve`).
        most: Most stances of one corridor: memory, about 100 bytes and a key each.
        effort: Most stances of all corridors together; the last corridor may go beyond it.
        seconds: Most time [s].
        tell: Called with the length of the plan after each corridor.

    Returns:
        A plan that holds, reaches the goal, and is never longer; `complete` if no plan of the task is shorter.
    """
    started = time.monotonic()
    size, seen, checks, complete = min(FIRST, most), 0, 0, False
    try:
        while not complete and seen < effort and (seconds is None or time.monotonic() - started < seconds):
            before = len(codes)
            codes, nodes, judged, complete = _through(problem, codes, size)
            seen += nodes
            checks += judged
            if tell is not None:
                tell(len(codes))
            if len(codes) < before:
                continue
            if size >= most:
                break
            size = min(most, GROWTH * size)
    except KeyboardInterrupt:
        return Shortened(codes, seen, checks, complete=False, interrupted=True)
    return Shortened(codes, seen, checks, complete)


def _through(problem: CompiledProblem, codes: Codes, size: int) -> tuple[Codes, int, int, bool]:
    """The shortest plan in a corridor; stances and actions that it took; whether every stance that matters was in it."""
    plan = problem.replay(codes).stances
    room = size + len(plan) + problem.branching
    keys = np.zeros((room, problem.key_words), np.int64)
    leads = np.zeros(room, np.uint8)
    table = np.full(table_size(room), -1, np.int32)
    first_edge = np.zeros(room + 1, np.int64)
    edge_to = np.zeros(EDGES * room, np.int32)
    edge_code = np.zeros(EDGES * room, np.int32)
    state = np.zeros(3, np.int64)
    collect(
        problem.params.record, plan, keys, leads, table, first_edge, edge_to, edge_code, np.zeros(problem.branching, np.int32),
        np.zeros(2, plan.dtype), np.zeros(len(problem.checks)), np.zeros(problem.key_words, np.int64), state,
    )  # fmt: skip
    nodes, expanded, judged = (int(value) for value in state)
    parent = np.zeros(nodes, np.int32)
    code = np.zeros(nodes, np.int32)
    goal = shortest(expanded, leads, first_edge, edge_to, edge_code, parent, code, np.zeros(nodes, np.int32))
    complete = expanded == nodes
    if goal < 0:
        return codes, nodes, judged, complete
    way = trace(parent, code, goal)
    better = len(way) < len(codes) and is_plan(problem, way)
    return way if better else codes, nodes, judged, complete
