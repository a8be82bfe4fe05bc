"""Drive an exploration over every reachable stance: layers, threads, memory that grows to a stated limit, interrupts."""

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Final

import numpy as np

from ...interrupts import Interruptible
from ..problem.arrays import with_room
from ..problem.body_pose import PoseLattice
from ..problem.problem import CompiledProblem, Records
from ..problem.problems import Normalisation
from ..progress import Clock
from ..stance_table import rehash, table_size
from .kernels import (
    POSE,
    POSES,
    STANCES,
    WEIGHED,
    Children,
    Judged,
    Long,
    PoseMap,
    Scratch,
    Sizes,
    absorb,
    note,
    note_tries,
    plant,
    spread,
    weigh,
)

FIRST: Final = 1 << 14
"""Stances that memory is taken for at first."""


class Store:
    """Keys, their hash table, and a record for each where a type is given."""

    def __init__(self, words: int, capacity: int, dtype: np.dtype[np.void] | None = None) -> None:
        self.keys = np.zeros((0, words), np.int64)
        self.rows = None if dtype is None else np.zeros(0, dtype)
        self.grow(capacity, 0)

    def grow(self, capacity: int, used: int) -> None:
        """Make room for `capacity` keys and keep the first `used`."""
        self.keys = with_room(self.keys, capacity)
        if self.rows is not None:
            self.rows = with_room(self.rows, capacity)
        self.table = np.full(table_size(capacity), -1, np.int32)
        rehash(self.keys, used, self.table)


class Piece:
    """A piece of a layer: its parameters and scratch, and what came of it."""

    def __init__(self, problem: CompiledProblem, axes: int, most: int) -> None:
        self.params, _ = problem.without_goals()
        branching, checks, words = problem.branching, len(problem.checks), problem.pose_words
        codes, stances = np.zeros(branching, np.int32), np.zeros(3, problem.start.dtype)
        self.scratch = Scratch(codes, stances, np.zeros(checks), np.zeros(checks))
        self.children = Children(
            keys=np.zeros((most * branching, problem.key_words), np.int64),
            tries=np.zeros((most * branching, max(words, axes + 1)), np.int64),
            tally=np.zeros(checks, np.int64),
        )
        self.judged = Judged(
            poses=np.zeros((most, words), np.int64),
            costs=np.zeros((most, len(problem.stance_costs))),
            room=np.zeros(most),
            closest=np.zeros(most, np.int32),
            aimed=np.zeros((most, problem.goals), np.uint8),
        )
        self.first = self.end = self.born = self.tried = self.actions = 0


class ReachabilityState:
    """The stances seen so far, and the map of them."""

    def __init__(
        self, problem: CompiledProblem, normalisation: Normalisation, lattice: PoseLattice, holds: int, most: int
    ) -> None:
        names = [check.name for check in normalisation.checks]
        self.sizes = Sizes(
            period=lattice.period,
            hard=np.array([name in normalisation.hard for name in names]),
            margins=np.array([normalisation.sizes.get(name, 0.0) for name in names]),
        )
        self.most = most
        self.state = np.zeros(3, np.int64)
        self.stances = Store(problem.key_words, min(most, FIRST))
        self.poses = Store(len(lattice.axes), FIRST, POSE)
        limbs = problem.pose_words - len(lattice.axes)
        self.used, self.first_used = np.zeros((limbs, holds), np.int64), np.full((limbs, holds), -1, np.int64)
        self.met, self.first_met = np.zeros(problem.goals, np.int64), np.full(problem.goals, -1, np.int64)

    @property
    def seen(self) -> int:
        """Stances seen."""
        return int(self.state[STANCES])

    def weigh(self, piece: Piece) -> None:
        """Judge a piece's stances as they stand."""
        record, keys = piece.params.record, self.stances.keys
        weigh(record, keys, piece.first, piece.end, self.sizes, piece.scratch, piece.judged)

    def visit(self, piece: Piece) -> None:
        """Judge a piece's stances as they stand, and find their children."""
        self.weigh(piece)
        piece.children.tally[:] = 0
        known, span = (self.stances.keys, self.stances.table), (piece.first, piece.end)
        piece.born, piece.tried, piece.actions = spread(
            piece.params.record, known, *span, self.sizes.period, piece.scratch, piece.children
        )

    def note(self, piece: Piece, depth: int) -> None:
        """Put a piece's stances on the map."""
        count = piece.end - piece.first
        while self.state[POSES] + count + piece.tried > len(self.poses.keys):
            self.poses.grow(2 * len(self.poses.keys), int(self.state[POSES]))
        assert self.poses.rows is not None
        seen = PoseMap(
            self.poses.keys, self.poses.rows, self.poses.table, self.used, self.first_used, self.met, self.first_met
        )
        note(piece.judged, count, depth, seen, self.state)
        note_tries(piece.children.tries, piece.tried, seen, self.state)

    def absorb(self, piece: Piece) -> bool:
        """Take in a piece's children; returns whether the memory sufficed."""
        taken = 0
        while True:
            taken = absorb(piece.children.keys, taken, piece.born, self.stances.keys, self.stances.table, self.state)
            if taken == piece.born:
                return True
            if len(self.stances.keys) >= self.most:
                return False
            self.stances.grow(min(self.most, 2 * len(self.stances.keys)), self.seen)


CHILDREN: Final = 10_000
"""Children that a piece of a layer has room for, unless one stance has more."""
LATE: Final = 0.5
"""For so long what was seen is judged after Ctrl-C [s]."""
PIECES: Final = 2
"""Pieces per thread between looks at the clock."""


@dataclass(frozen=True, slots=True)
class Exploration:
    """What an exploration saw."""

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
    """Poses of the body as steps from the start along each axis; those without stances were only tried, shape (n, axes)."""
    notes: Records
    """Records of `kernels.POSE`, shape (n,)."""
    used: Long
    """Stances with each limb on each hold, shape (limbs, holds)."""
    first_used: Long
    """Actions of the shortest way to the first of them, -1 for none."""
    met: Long
    """Stances that are where each goal asks for, shape (goals,)."""
    first_met: Long


def explore_breadth_first(
    problem: CompiledProblem,
    normalisation: Normalisation,
    lattice: PoseLattice,
    *,
    holds: int,
    most_stances: int,
    seconds: float | None = None,
    threads: int | None = None,
    tell: Callable[[int, int, int], None] | None = None,
) -> Exploration:
    """See every stance that can be reached from the start, whatever the goals, and note what it costs to be there.

    Breadth first: a layer holds the stances that take equally many actions. Its pieces are expanded in threads, which only read; what
    they find is taken in in the order of the layer, so the answer doesn't depend on the number of threads.

    Args:
        problem: The task.
        yardsticks: What its margins are measured against.
        lattice: The lattice of its body's poses.
        holds: Number of the board's holds; 0 where there are none.
        most_stances: Memory: most stances kept, a key and 8 to 16 bytes each, half as much again while memory grows.
        seconds: Most time [s].
        threads: Threads; None for one a core.
        tell: Called now and then with stances, poses and depth.

    Returns:
        The exploration; memory, time and Ctrl-C end it, and then it judges and tells what was seen so far, which takes a while longer;
        after Ctrl-C that ends within `LATE`, and what was seen and is not judged then is on no map.
    """
    clock = Clock(seconds)
    threads = max(1, threads if threads is not None else (os.cpu_count() or 1))
    size = max(1, CHILDREN // problem.branching)
    axes = len(lattice.axes)
    pieces = [Piece(problem, axes, size) for _ in range(PIECES * threads if threads > 1 else 1)]
    reached = ReachabilityState(problem, normalisation, lattice, holds, most_stances)
    plant(pieces[0].params.record, problem.without_goals()[1], pieces[0].children.keys)
    pieces[0].born = 1
    reached.absorb(pieces[0])
    depth, done, layer_end, judged, ended = 0, 0, 1, 0, ""
    forbidden = np.zeros(len(problem.checks), np.int64)
    pool = _pool(threads)
    with Interruptible() as block:
        while done < reached.seen and not ended:
            if done == layer_end:
                depth, layer_end = depth + 1, reached.seen
            for piece in _share(pool, pieces, reached.visit, range(done, layer_end, size), layer_end):
                reached.note(piece, depth)
                judged += piece.actions
                forbidden += piece.children.tally
                if not reached.absorb(piece):
                    ended = "memory"
                    break
                done = piece.end
            if tell is not None:
                tell(reached.seen, int(reached.state[POSES]), depth)
            if clock.is_over and done < reached.seen:
                ended = ended or "time"
    if block.interrupted:
        ended = "interrupt"
    if pool is not None:
        pool.shutdown(cancel_futures=True)  # waits, so that nobody writes into the pieces any more
    pool, late = _pool(threads), Clock(LATE if block.interrupted else None)
    for end, layer in ((layer_end, depth), (reached.seen, depth + 1)):  # what was seen, but is not on the map yet
        while (first := int(reached.state[WEIGHED])) < end and not late.is_over:
            for piece in _share(pool, pieces, reached.weigh, range(first, end, size), end):
                reached.note(piece, layer)
    if pool is not None:
        pool.shutdown()
    count = int(reached.state[POSES])
    assert reached.poses.rows is not None
    return Exploration(
        ended=ended,
        stances=reached.seen,
        depth=depth if reached.seen == layer_end else depth + 1,
        judged=judged,
        forbidden=forbidden,
        poses=reached.poses.keys[:count],
        notes=reached.poses.rows[:count],
        used=reached.used,
        first_used=reached.first_used,
        met=reached.met,
        first_met=reached.first_met,
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
