"""Greedy best-first search as one kernel: keys in a hash table, open stances in a heap, the one that is worth most first."""

from ...compiled import inlined, kernel
from ..problem.family_kernels import candidates, done, key, restore, step
from ..stance_table import slot_of
from .walks import worth


@inlined
def before(value, a, b):
    """Whether entry a comes out before entry b."""
    return value[a] > value[b] or (value[a] == value[b] and a < b)


@inlined
def push(heap, n, value, entry):
    """Put an entry in; returns the new size."""
    at = n
    while at > 0:
        above = (at - 1) // 2
        if not before(value, entry, heap[above]):
            break
        heap[at] = heap[above]
        at = above
    heap[at] = entry
    return n + 1


@inlined
def pop(heap, n, value):
    """Take the first entry out; returns it, and the new size."""
    first = heap[0]
    n -= 1
    last = heap[n]
    at = 0
    while True:
        below = 2 * at + 1
        if below >= n:
            break
        if below + 1 < n and before(value, heap[below + 1], heap[below]):
            below += 1
        if not before(value, heap[below], last):
            break
        heap[at] = heap[below]
        at = below
    heap[at] = last
    return first, n


RUNNING, FOUND, EXHAUSTED, FULL = 0, 1, 2, 3
NODES, OPEN, EXPANDED, CHECKS, GOAL, BEST = 0, 1, 2, 3, 4, 5
"""Places in the state."""


@kernel
def greedy(
    p, weights, keys, value, parent, code, heap, table, state, codes, stances, margins, row, words, most_checks, quota
):  # fmt: skip
    """Expand the stance that is worth most until the goal, the end of the space, of memory, of the budget, or a quota.

    A stance is entered once, by the way that came first, so the search never goes in circles. The start is node 0, put in by the caller.

    Args:
        p: A family's parameters.
        weights: Weights of the features.
        keys, value, parent, code: Key, worth, parent and action of every node, shape (capacity, ...).
        heap: Open nodes.
        table: Hash table of the nodes; its size is a power of two.
        state: Nodes, open ones, expanded ones, actions judged, goal, node that is worth most; int64, shape (6,), updated in place.
        codes, stances, margins, row, words: Scratch for candidates, two stances, checks, features and a key.
        most_checks: Most actions to judge.
        quota: Most stances to expand in this call.

    Returns:
        FOUND, EXHAUSTED, FULL (memory or budget) or RUNNING.
    """
    for _ in range(quota):
        if state[OPEN] == 0:
            return EXHAUSTED
        if state[NODES] + codes.shape[0] > keys.shape[0] or state[CHECKS] >= most_checks:
            return FULL
        node, state[OPEN] = pop(heap, state[OPEN], value)
        restore(p, keys[node], stances[0])
        state[EXPANDED] += 1
        for c in range(candidates(p, stances[0], codes)):
            state[CHECKS] += 1
            if step(p, stances[0], codes[c], stances[1], margins) >= 0:
                continue
            key(p, stances[1], words)
            slot = slot_of(words, table, keys)
            if table[slot] >= 0:
                continue
            child = state[NODES]
            state[NODES] += 1
            table[slot] = child
            for i in range(words.shape[0]):
                keys[child, i] = words[i]
            parent[child] = node
            code[child] = codes[c]
            value[child] = worth(p, stances[1], weights, row)
            if value[child] > value[state[BEST]]:
                state[BEST] = child
            if done(p, stances[1]):
                state[GOAL] = child
                return FOUND
            state[OPEN] = push(heap, state[OPEN], value, child)
    return RUNNING


@kernel
def plant_root(p, start, weights, keys, value, table, row):
    """Enter the start stance (array of one record) as node 0."""
    key(p, start[0], keys[0])
    value[0] = worth(p, start[0], weights, row)
    table[slot_of(keys[0], table, keys)] = 0
