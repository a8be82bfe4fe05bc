"""Best-first search over stances as one kernel: keys in a hash table, open nodes in buckets, children by the family's `step`."""

import math

import numpy as np

from ...actions.family import bound, candidates, done, key, measure, restore, step
from ...actions.randoms import scramble
from ...compiled import inlined, kernel

RUNNING, FOUND, EXHAUSTED, FULL = 0, 1, 2, 3
NONE = -1


@inlined
def slot_of(words, table, keys):
    """Where a key is in the hash table, or the empty slot where it belongs (whole keys are compared, never hashes alone)."""
    value = np.uint64(0)
    for i in range(words.shape[0]):
        value = scramble(value ^ np.uint64(words[i]))
    slot = np.int64(value & np.uint64(table.shape[0] - 1))
    while table[slot] >= 0:
        node = table[slot]
        same = True
        for i in range(words.shape[0]):
            if keys[node, i] != words[i]:
                same = False
                break
        if same:
            return slot
        slot = (slot + 1) & (table.shape[0] - 1)
    return slot


@kernel
def rehash(keys, n, table):
    """Fill an empty hash table with the first n keys."""
    for node in range(n):
        table[slot_of(keys[node], table, keys)] = node


@kernel
def plant(p, start, keys, g, parent, code, entries, following, heads, table):
    """Put the start stance into an empty search; returns its bucket."""
    key(p, start[0], keys[0])
    g[0] = 0
    parent[0] = NONE
    code[0] = 0
    f = np.int64(math.ceil(bound(p, start[0])))
    entries[0] = 0
    following[0] = NONE
    heads[f] = 0
    table[slot_of(keys[0], table, keys)] = 0
    return f


@kernel
def search(
    p, keys, g, closed, parent, code, entries, following, heads, table, state, codes, stances, margins, words, tally, quota
):  # fmt: skip
    """Expand stances in order of g + bound until the goal, the end of the space, the end of the arrays, or a quota.

    Cost is the number of actions; a consistent bound means that a stance is expanded once. Among equals the deeper goes first, because
    the newest does. `state` is (nodes, lowest bucket, expanded, actions judged, goal node, entries); it is updated in place.

    Args:
        p: A family's parameters.
        keys: Key of every node, shape (capacity, words).
        g, closed, parent, code: Cost, whether expanded, parent, action of every node.
        entries, following, heads: The open list: node of each entry, next entry in its bucket, first entry of each bucket. A node that is
            reached more cheaply gets a second entry; the dearer one is passed over when its turn comes.
        table: Hash table of the nodes; its size is a power of two.
        state: See above, int64, shape (6,).
        codes: Scratch for candidates.
        stances: Scratch, two records.
        margins: Scratch of the family's checks.
        words: Scratch for a key.
        tally: How often each check forbade an action.
        quota: Most stances to expand in this call.

    Returns:
        FOUND, EXHAUSTED, FULL or RUNNING.
    """
    for _ in range(quota):
        while state[1] < heads.shape[0] and heads[state[1]] < 0:
            state[1] += 1
        if state[1] >= heads.shape[0]:
            return EXHAUSTED
        if max(state[0], state[5]) + codes.shape[0] > keys.shape[0]:
            return FULL
        node = entries[heads[state[1]]]
        heads[state[1]] = following[heads[state[1]]]
        if closed[node]:
            continue
        closed[node] = 1
        restore(p, keys[node], stances[0])
        if done(p, stances[0]):
            state[4] = node
            return FOUND
        state[2] += 1
        for c in range(candidates(p, stances[0], codes)):
            state[3] += 1
            reason = step(p, stances[0], codes[c], stances[1], margins)
            if reason >= 0:
                tally[reason] += 1
                continue
            key(p, stances[1], words)
            slot = slot_of(words, table, keys)
            child = table[slot]
            cost = g[node] + 1
            if child >= 0 and (closed[child] or g[child] <= cost):
                continue
            if child < 0:
                child = state[0]
                state[0] += 1
                table[slot] = child
                closed[child] = 0
                for i in range(words.shape[0]):
                    keys[child, i] = words[i]
            g[child] = cost
            parent[child] = node
            code[child] = codes[c]
            f = cost + np.int64(math.ceil(bound(p, stances[1])))
            if f < state[1]:
                state[1] = f
            entries[state[5]] = child
            following[state[5]] = heads[f]
            heads[f] = state[5]
            state[5] += 1
    return RUNNING


@kernel
def furthest(p, keys, n, stances, row, column):
    """The node with the largest value of one feature."""
    best = -math.inf
    best_node = 0
    for node in range(n):
        restore(p, keys[node], stances[0])
        measure(p, stances[0], row)
        if row[column] > best:
            best = row[column]
            best_node = node
    return best_node
