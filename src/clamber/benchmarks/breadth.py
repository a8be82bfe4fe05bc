"""Plain breadth-first search over the same kernels, for comparison with the exact planner: no bound, no dominance."""

from dataclasses import dataclass

import numpy as np

from ..compiled import kernel
from ..planning.problem.family_kernels import candidates, done, key, restore, step
from ..planning.problem.problem import CompiledProblem
from ..planning.stance_table import scratch_for, slot_of, table_size

FOUND, EXHAUSTED, FULL = 0, 1, 2


@dataclass(frozen=True, slots=True)
class Breadth:
    """What a breadth-first search came to."""

    length: int | None
    """Actions of a shortest plan; None without one."""
    complete: bool
    """Every reachable stance was seen, or a plan found."""
    stances: int
    checks: int


@kernel
def breadth(p, start, keys, depth, table, room, state):
    """Look at every stance in the order in which it was reached, until one has met every goal.

    Args:
        p, start: Parameters and start stance (array of one record).
        keys, depth: Output, key and depth of every stance seen.
        table: Hash table, all -1, its size a power of two.
        room: Scratch.
        state: Output: stances, actions judged, depth of the goal.
    """
    codes, stances, margins, words, _ = room
    key(p, start[0], keys[0])
    table[slot_of(keys[0], table, keys)] = 0
    depth[0] = 0
    n = 1
    at = 0
    while at < n:
        restore(p, keys[at], stances[0])
        if done(p, stances[0]):
            state[0] = n
            state[2] = depth[at]
            return FOUND
        if n + codes.shape[0] > keys.shape[0]:
            state[0] = n
            return FULL
        for c in range(candidates(p, stances[0], codes)):
            state[1] += 1
            if step(p, stances[0], codes[c], stances[1], margins) >= 0:
                continue
            key(p, stances[1], words)
            slot = slot_of(words, table, keys)
            if table[slot] < 0:
                table[slot] = n
                depth[n] = depth[at] + 1
                for i in range(words.shape[0]):
                    keys[n, i] = words[i]
                n += 1
        at += 1
    state[0] = n
    return EXHAUSTED


def breadth_first(problem: CompiledProblem, *, most_stances: int = 4_000_000) -> Breadth:
    """A shortest plan's length by plain breadth-first search.

    Args:
        problem: The task.
        most_stances: Memory.
    """
    most = most_stances + problem.branching
    keys = np.zeros((most, problem.key_words), np.int64)
    depth, table = np.zeros(most, np.int32), np.full(table_size(most), -1, np.int32)
    state = np.zeros(3, np.int64)
    end = breadth(problem.params.record, problem.start, keys, depth, table, scratch_for(problem), state)
    return Breadth(
        length=int(state[2]) if end == FOUND else None,
        complete=end != FULL,
        stances=int(state[0]),
        checks=int(state[1]),
    )
