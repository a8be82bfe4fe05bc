"""A hash table of stances by their keys, for every search that must know where it has been, and room to look at stances in."""

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..compiled import inlined, kernel
from ..types import Floats, Ints, Records
from .problem.randoms import scramble

if TYPE_CHECKING:
    from .problem.problem import CompiledProblem

POSE = 3
"""The first words of a key: place and angle of the body, in ticks."""


class Scratch(NamedTuple):
    """Where a search looks at stances and their children."""

    codes: Ints
    """For candidates."""
    stances: Records
    margins: Floats
    """For the family's checks."""
    words: "np.ndarray[tuple[int, ...], np.dtype[np.int64]]"
    """For a key, or several."""
    row: Floats
    """For features."""


def scratch_for(problem: "CompiledProblem", stances: int = 2, *, keys: int | None = None) -> Scratch:
    """Room for so many stances and one key, or a list of `keys`."""
    words = problem.key_words
    return Scratch(
        codes=np.zeros(problem.branching, np.int32),
        stances=np.zeros(stances, problem.start.dtype),
        margins=np.zeros(len(problem.checks)),
        words=np.zeros(words if keys is None else (keys, words), np.int64),
        row=np.zeros(len(problem.features)),
    )


@inlined
def _word(words, i, grain):
    """A word of a key as it is told apart: places and angles of the body, in ticks, to 2^grain of them."""
    return (words[i] + (1 << (grain - 1))) >> grain if grain and i < POSE else words[i]


@inlined
def slot_of(words, table, keys, grain=0):
    """Where a key is in the hash table, or the empty slot where it belongs (whole keys are compared, never hashes alone)."""
    value = np.uint64(0)
    for i in range(words.shape[0]):
        value = scramble(value ^ np.uint64(_word(words, i, grain)))
    slot = np.int64(value & np.uint64(table.shape[0] - 1))
    while table[slot] >= 0:
        node = table[slot]
        same = True
        for i in range(words.shape[0]):
            if _word(keys[node], i, grain) != _word(words, i, grain):
                same = False
                break
        if same:
            return slot
        slot = (slot + 1) & (table.shape[0] - 1)
    return slot


@kernel
def rehash(keys, n, table, grain=0):
    """Fill an empty hash table with the first n keys."""
    for node in range(n):
        table[slot_of(keys[node], table, keys, grain)] = node


def table_size(entries: int) -> int:
    """A power of two, at least twice as many as the entries."""
    return 1 << int(np.ceil(np.log2(2 * max(2, entries))))


def path_to(parent: Ints, code: Ints, node: int) -> Ints:
    """Actions from the root, whose parent is no node above 0, to a node."""
    codes = []
    while node > 0:
        codes.append(int(code[node]))
        node = int(parent[node])
    return np.array(codes[::-1], np.int32)
