"""Greedy best-first search over stances as one kernel, led by fields of the way that is left over the wall."""

import math

import numpy as np

from ..compiled import inlined, kernel
from .problem.family_kernels import candidates, done, key, restore, step
from .problem.randoms import scramble

RUNNING, FOUND, EXHAUSTED, FULL = 0, 1, 2, 3
NONE = -1
NODES, LOWEST, EXPANDED, JUDGED, GOAL, BEST = range(6)
"""Entries of a search's `state`."""
POSE = 3
"""The first words of a key: place and angle of the body, in ticks."""
ROUGH = 18
"""Poses are told apart to 2^18 ticks, a quarter of a step: off the lattice, after hangs, there is no end of poses that hardly differ."""


@inlined
def rough(words, i):
    """A word of a key as the search compares it."""
    return (words[i] + (1 << (ROUGH - 1))) >> ROUGH if i < POSE else words[i]


@inlined
def rough_slot(words, table, keys):
    """Where a stance is in the hash table, or the empty slot where it belongs; keys are compared whole, but for the grain of poses."""
    value = np.uint64(0)
    for i in range(words.shape[0]):
        value = scramble(value ^ np.uint64(rough(words, i)))
    slot = np.int64(value & np.uint64(table.shape[0] - 1))
    while table[slot] >= 0:
        node = table[slot]
        same = True
        for i in range(words.shape[0]):
            if rough(keys[node], i) != rough(words, i):
                same = False
                break
        if same:
            return slot
        slot = (slot + 1) & (table.shape[0] - 1)
    return slot


@kernel
def rehash_rough(keys, n, table):
    """Fill an empty hash table with the first n keys."""
    for node in range(n):
        table[rough_slot(keys[node], table, keys)] = node


@inlined
def place_of(s, fields, frame):
    """Row and column of the map's place that the body is at."""
    column = min(max(int(math.floor((s.x - frame[0]) / frame[2] + 0.5)), 0), fields.shape[2] - 1)
    row = min(max(int(math.floor((s.y - frame[1]) / frame[2] + 0.5)), 0), fields.shape[1] - 1)
    return row, column


@inlined
def way_left(p, s, fields, frame, hold_fields, after, share):
    """About how many steps are left from a stance: the body's way, and a share of the mean way of its limbs.

    Args:
        p, s: Parameters and stance.
        fields: Steps to each goal from every place, shape (goals, rows, columns).
        frame: Lower left place of the fields and their grain [m], shape (3,).
        hold_fields: The same at every hold, shape (goals, holds).
        after: Steps from each goal through the later ones, shape (goals,).
        share: Weight of the limbs' way.
    """
    if s.stage >= fields.shape[0]:
        return 0.0
    row, column = place_of(s, fields, frame)
    body = fields[s.stage, row, column]
    tips = 0.0
    for i in range(p.n_limbs):
        tips += hold_fields[s.stage, s.hold[i]] if s.hold[i] >= 0 else body
    return body + share * tips / p.n_limbs + after[s.stage]


@inlined
def bucket_of(cost, way, weight, buckets):
    """Which bucket of the open list a stance belongs in."""
    return min(np.int64(cost + weight * way), buckets - 1)


@kernel
def plant(
    p, start, keys, g, way, parent, code, following, heads, table, fields, frame, hold_fields, after, share, weight
):
    """Put the start stance into an empty search; returns its bucket."""
    key(p, start[0], keys[0])
    g[0] = 0
    way[0] = way_left(p, start[0], fields, frame, hold_fields, after, share)
    parent[0] = NONE
    code[0] = 0
    following[0] = NONE
    f = bucket_of(0, way[0], weight, heads.shape[0])
    heads[f] = 0
    table[rough_slot(keys[0], table, keys)] = 0
    return f


@kernel
def search(
    p, keys, g, way, parent, code, following, heads, table, state, codes, stances, margins, words, tally,
    fields, frame, hold_fields, after, share, weight, visits, crowding, quota,
):  # fmt: skip
    """Expand stances in order of cost + weight * way left until a goal, the end of the open list or of the arrays, or a quota.

    The way left from a place grows with every stance that was expanded there, so that a dead end fills up and the search leaves it (as in
    Korf's learning real-time A*, 1990); a stance whose turn comes with a way that has grown since goes back into the open list.

    A stance counts as it is first reached, and is expanded once: the way left misleads anyhow, and the plan is checked, not proved.
    Among equals the newest goes first.

    Args:
        p: A family's parameters.
        keys: Key of every node, shape (capacity, words).
        g, way, parent, code: Actions so far, way left, parent, action of every node.
        following, heads: The open list: next node in the same bucket, first node of each bucket.
        table: Hash table of the nodes; its size is a power of two.
        state: Nodes, lowest bucket, expanded, actions judged, goal node (-1: none), node with the least way left; updated in place.
        codes, stances, margins, words: Scratch: candidates, two records, checks, a key.
        tally: How often each check forbade an action.
        fields, frame, hold_fields, after, share: See `way_left`.
        weight: How much a step of way left counts beside an action made.
        visits: Stances expanded at every place, shape (rows, columns); updated in place.
        crowding: By how much each of them makes the way left longer [steps].
        quota: Most stances to expand in this call.

    Returns:
        FOUND, EXHAUSTED, FULL or RUNNING.
    """
    for _ in range(quota):
        while state[LOWEST] < heads.shape[0] and heads[state[LOWEST]] < 0:
            state[LOWEST] += 1
        if state[LOWEST] >= heads.shape[0]:
            return EXHAUSTED
        if state[NODES] + codes.shape[0] > keys.shape[0]:
            return FULL
        node = heads[state[LOWEST]]
        heads[state[LOWEST]] = following[node]
        restore(p, keys[node], stances[0])
        row, column = place_of(stances[0], fields, frame)
        f = bucket_of(g[node], way[node] + crowding * visits[row, column], weight, heads.shape[0])
        if f > state[LOWEST]:
            following[node] = heads[f]
            heads[f] = node
            continue
        visits[row, column] += 1
        state[EXPANDED] += 1
        for c in range(candidates(p, stances[0], codes)):
            state[JUDGED] += 1
            reason = step(p, stances[0], codes[c], stances[1], margins)
            if reason >= 0:
                tally[reason] += 1
                continue
            key(p, stances[1], words)
            slot = rough_slot(words, table, keys)
            if table[slot] >= 0:
                continue
            child = state[NODES]
            state[NODES] += 1
            table[slot] = child
            for i in range(words.shape[0]):
                keys[child, i] = words[i]
            g[child] = g[node] + 1
            way[child] = way_left(p, stances[1], fields, frame, hold_fields, after, share)
            parent[child] = node
            code[child] = codes[c]
            if way[child] < way[state[BEST]]:
                state[BEST] = child
            if done(p, stances[1]):
                state[GOAL] = child
                return FOUND
            row, column = place_of(stances[1], fields, frame)
            f = bucket_of(g[child], way[child] + crowding * visits[row, column], weight, heads.shape[0])
            state[LOWEST] = min(state[LOWEST], f)
            following[child] = heads[f]
            heads[f] = child
    return RUNNING
