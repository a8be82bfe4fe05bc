"""What a flood keeps: the stances seen, the map of them, and the scratch of each piece of a layer."""

from typing import Final

import numpy as np
import numpy.typing as npt

from ..problem.problem import CompiledProblem
from ..problem.yardsticks import Yardsticks
from ..stance_table import rehash
from .kernels import POSE, POSES, STANCES, absorb, note, note_tries, spread, weigh

FIRST: Final = 1 << 14
"""Stances that memory is taken for at first."""

Long = npt.NDArray[np.int64]


class Store:
    """Keys, their hash table, and a record for each where a type is given."""

    def __init__(self, words: int, capacity: int, dtype: np.dtype[np.void] | None = None) -> None:
        self.keys = np.zeros((0, words), np.int64)
        self.rows = None if dtype is None else np.zeros(0, dtype)
        self.grow(capacity, 0)

    def grow(self, capacity: int, used: int) -> None:
        """Make room for `capacity` keys and keep the first `used`."""
        keys = np.zeros((capacity, self.keys.shape[1]), np.int64)
        keys[:used] = self.keys[:used]
        self.keys = keys
        if self.rows is not None:
            rows = np.zeros(capacity, self.rows.dtype)
            rows[:used] = self.rows[:used]
            self.rows = rows
        self.table = np.full(1 << int(np.ceil(np.log2(2 * capacity))), -1, np.int32)
        rehash(self.keys, used, self.table)


class Piece:
    """A piece of a layer: its parameters and scratch, and what came of it."""

    def __init__(self, problem: CompiledProblem, most: int) -> None:
        self.params, _ = problem.wander()
        branching, checks = problem.branching, len(problem.checks)
        self.codes = np.zeros(branching, np.int32)
        self.stances = np.zeros(3, problem.start.dtype)
        self.margins, self.spare = np.zeros(checks), np.zeros(checks)
        self.children = np.zeros((most * branching, problem.key_words), np.int64)
        self.tries = np.zeros((most * branching, 4 + problem.spot_words), np.int64)
        self.tally = np.zeros(checks, np.int64)
        self.spots = np.zeros((most, problem.spot_words), np.int64)
        self.burdens = np.zeros((most, len(problem.burdens)))
        self.room, self.closest = np.zeros(most), np.zeros(most, np.int32)
        self.aimed = np.zeros((most, problem.goals), np.uint8)
        self.first = self.end = self.born = self.tried = self.judged = 0


class Sea:
    """The stances seen so far, and the map of them."""

    def __init__(self, problem: CompiledProblem, yardsticks: Yardsticks, holds: int, most: int) -> None:
        names = [check.name for check in yardsticks.checks]
        self.hard = np.array([name in yardsticks.hard for name in names])
        self.sizes = np.array([yardsticks.sizes.get(name, 0.0) for name in names])
        self.most = most
        self.state = np.zeros(3, np.int64)
        self.stances = Store(problem.key_words, min(most, FIRST))
        self.poses = Store(3, FIRST, POSE)
        limbs = problem.spot_words - 3
        self.used, self.first_used = np.zeros((limbs, holds), np.int64), np.full((limbs, holds), -1, np.int64)
        self.met, self.first_met = np.zeros(problem.goals, np.int64), np.full(problem.goals, -1, np.int64)

    @property
    def seen(self) -> int:
        """Stances seen."""
        return int(self.state[STANCES])

    def weigh(self, piece: Piece) -> None:
        """Judge a piece's stances as they stand."""
        weigh(
            piece.params.record, self.stances.keys, piece.first, piece.end, self.hard, self.sizes, piece.stances,
            piece.margins, piece.spare, piece.spots, piece.burdens, piece.room, piece.closest, piece.aimed,
        )  # fmt: skip

    def visit(self, piece: Piece) -> None:
        """Judge a piece's stances as they stand, and find their children."""
        self.weigh(piece)
        piece.tally[:] = 0
        piece.born, piece.tried, piece.judged = spread(
            piece.params.record, self.stances.keys, self.stances.table, piece.first, piece.end, piece.codes,
            piece.stances, piece.margins, piece.children, piece.tries, piece.tally,
        )  # fmt: skip

    def note(self, piece: Piece, depth: int) -> None:
        """Put a piece's stances on the map."""
        count = piece.end - piece.first
        while self.state[POSES] + count + piece.tried > len(self.poses.keys):
            self.poses.grow(2 * len(self.poses.keys), int(self.state[POSES]))
        note(
            piece.spots, piece.burdens, piece.room, piece.closest, piece.aimed, count, depth, self.poses.keys,
            self.poses.rows, self.poses.table, self.used, self.first_used, self.met, self.first_met, self.state,
        )  # fmt: skip
        note_tries(piece.tries, piece.tried, self.poses.keys, self.poses.rows, self.poses.table, self.state)

    def absorb(self, piece: Piece) -> bool:
        """Take in a piece's children; returns whether the memory sufficed."""
        taken = 0
        while True:
            taken = absorb(piece.children, taken, piece.born, self.stances.keys, self.stances.table, self.state)
            if taken == piece.born:
                return True
            if len(self.stances.keys) >= self.most:
                return False
            self.stances.grow(min(self.most, 2 * len(self.stances.keys)), self.seen)
