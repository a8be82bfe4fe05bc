"""Drive a flood over every reachable stance: layers, threads, memory that grows to a stated limit, interrupts."""

import os
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Final

import numpy as np

from ..problem.problem import CompiledProblem, Records
from ..problem.yardsticks import Yardsticks
from .kernels import POSES, WEIGHED, plant
from .sea import Long, Piece, Sea

CHILDREN: Final = 10_000
"""Children that a piece of a layer has room for, unless one stance has more."""
PIECES: Final = 2
"""Pieces per thread between looks at the clock."""


@dataclass(frozen=True, slots=True)
class Flood:
    """What a flood saw."""

    ended: str
    """"" if every reachable stance was seen, else why not."""
    stances: int
    depth: int
    """Actions of the shortest way to the last stance."""
    judged: int
    """Actions tried."""
    forbidden: Long
    """How often each check forbade an action, shape (n_checks,)."""
    poses: Long
    """Poses of the body as steps from the start in x, y and angle; those without stances were only tried, shape (n, 3)."""
    notes: Records
    """Records of `kernels.POSE`, shape (n,)."""
    used: Long
    """Stances with each limb on each hold, shape (limbs, holds)."""
    first_used: Long
    """Actions of the shortest way to the first of them, -1 for none."""
    met: Long
    """Stances that are where each goal asks for, shape (goals,)."""
    first_met: Long


def flood(
    problem: CompiledProblem,
    yardsticks: Yardsticks,
    *,
    holds: int,
    most_stances: int,
    seconds: float | None = None,
    threads: int | None = None,
    tell: Callable[[int, int, int], None] | None = None,
) -> Flood:
    """See every stance that can be reached from the start, whatever the goals, and note what it costs to be there.

    Breadth first: a layer holds the stances that take equally many actions. Its pieces are expanded in threads, which only read; what
    they find is taken in in the order of the layer, so the answer doesn't depend on the number of threads.

    Args:
        problem: The task.
        yardsticks: What its margins are measured against.
        holds: Number of the board's holds; 0 where there are none.
        most_stances: Memory: most stances kept, a key and 8 to 16 bytes each, half as much again while memory grows.
        seconds: Most time [s].
        threads: Threads; None for one a core.
        tell: Called now and then with stances, poses and depth.

    Returns:
        The flood; memory, time and Ctrl-C end it, and then it judges and tells what was seen so far, which takes a while longer.
    """
    started = time.monotonic()
    threads = max(1, threads if threads is not None else (os.cpu_count() or 1))
    size = max(1, CHILDREN // problem.branching)
    pieces = [Piece(problem, size) for _ in range(PIECES * threads if threads > 1 else 1)]
    sea = Sea(problem, yardsticks, holds, most_stances)
    plant(pieces[0].params.record, problem.wander()[1], pieces[0].children)
    pieces[0].born = 1
    sea.absorb(pieces[0])
    depth, done, layer_end, judged, ended = 0, 0, 1, 0, ""
    forbidden = np.zeros(len(problem.checks), np.int64)
    pool = _pool(threads)
    try:
        while done < sea.seen and not ended:
            if done == layer_end:
                depth, layer_end = depth + 1, sea.seen
            for piece in _share(pool, pieces, sea.visit, range(done, layer_end, size), layer_end):
                sea.note(piece, depth)
                judged += piece.judged
                forbidden += piece.tally
                if not sea.absorb(piece):
                    ended = "memory"
                    break
                done = piece.end
            if tell is not None:
                tell(sea.seen, int(sea.state[POSES]), depth)
            if seconds is not None and time.monotonic() - started >= seconds and done < sea.seen:
                ended = ended or "time"
    except KeyboardInterrupt:
        ended = "interrupt"
    if pool is not None:
        pool.shutdown(cancel_futures=True)  # waits, so that nobody writes into the pieces any more
    pool = _pool(threads)
    for end, late in ((layer_end, depth), (sea.seen, depth + 1)):  # what was seen, but is not on the map yet
        while (first := int(sea.state[WEIGHED])) < end:
            for piece in _share(pool, pieces, sea.weigh, range(first, end, size), end):
                sea.note(piece, late)
    if pool is not None:
        pool.shutdown()
    count = int(sea.state[POSES])
    assert sea.poses.rows is not None
    return Flood(
        ended=ended,
        stances=sea.seen,
        depth=depth if sea.seen == layer_end else depth + 1,
        judged=judged,
        forbidden=forbidden,
        poses=sea.poses.keys[:count],
        notes=sea.poses.rows[:count],
        used=sea.used,
        first_used=sea.first_used,
        met=sea.met,
        first_met=sea.first_met,
    )


def _pool(threads: int) -> ThreadPoolExecutor | None:
    return ThreadPoolExecutor(threads, thread_name_prefix="clamber") if threads > 1 else None


def _share(
    pool: ThreadPoolExecutor | None,
    pieces: list[Piece],
    work: Callable[[Piece], None],
    firsts: range,
    end: int,
) -> list[Piece]:
    """Let each piece work on its share of some stances, as many as there are pieces; returns those that did."""
    busy = pieces[: len(firsts)]
    for piece, first in zip(busy, firsts, strict=False):
        piece.first, piece.end = first, min(first + firsts.step, end)
        piece.tried = piece.born = 0
    for _ in map(work, busy) if pool is None else pool.map(work, busy):
        pass
    return busy
