"""The arrays of an exact search: stances, ways to them, hash table, buckets. They grow to a stated limit."""

from typing import Any, Final

import numpy as np

from ...types import Ints
from ..problem.problem import CompiledProblem
from ..stance_table import rehash
from .records import LABEL, NODE, STATE

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

    def _table(self) -> Ints:
        table = np.full(1 << int(np.ceil(np.log2(2 * len(self.keys)))), -1, np.int32)
        rehash(self.keys, int(self.state["nodes"][0]), table)
        return table

    def grow(self, branching: int) -> bool:
        """Make room; False if the limit is reached."""
        state = self.state[0]
        done = False
        if state["labels"] + branching > len(self.labels) and len(self.labels) < LABELS_PER_STANCE * self.most:
            self.labels = _longer(self.labels, min(LABELS_PER_STANCE * self.most, 2 * len(self.labels)))
            done = True
        if state["nodes"] + branching > len(self.keys) and len(self.keys) < self.most:
            room = min(self.most, 2 * len(self.keys))
            self.keys, self.nodes = _longer(self.keys, room), _longer(self.nodes, room)
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


def _longer(old: Any, room: int) -> Any:
    new = np.zeros((room, *old.shape[1:]), old.dtype)
    new[: len(old)] = old
    return new
