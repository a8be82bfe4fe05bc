"""Greedy best-first search over stances as one kernel, led by fields of the way that is left over the wall."""

import math
from typing import NamedTuple

import numpy as np

from ..compiled import inlined, kernel
from ..types import Floats, Ints
from .problem.family_kernels import candidates, done, draft, key, restore, step
from .stance_table import slot_of

RUNNING, FOUND, EXHAUSTED, FULL = 0, 1, 2, 3
NONE = -1
NODES, LOWEST, EXPANDED, JUDGED, GOAL, BEST = range(6)
"""Entries of a search's `state`."""
ROUGH = 18
"""Poses are told apart to 2^18 ticks, a quarter of a step: off the lattice, after hangs, there is no end of poses that hardly differ."""


class Nodes(NamedTuple):
    """Stances seen, and the open list."""

    keys: np.ndarray[tuple[int, ...], np.dtype[np.int64]]
    g: Ints
    """Actions so far."""
    way: np.ndarray[tuple[int, ...], np.dtype[np.float32]]
    """Way left."""
    parent: Ints
    code: Ints
    """The action that led there."""
    following: Ints
    """Next node in the same bucket."""
    heads: Ints
    """First node of each bucket."""
    table: Ints
    """Hash table; its size is a power of two."""


class Guide(NamedTuple):
    """What tells of the way that is left."""

    fields: Floats
    """Steps to each goal from every place, shape (goals, rows, columns)."""
    frame: Floats
    """Lower left place of the fields and their grain [m], shape (3,)."""
    hold_fields: Floats
    """The same at every hold, shape (goals, holds)."""
    after: Floats
    """Steps from each goal through the later ones, shape (goals,)."""
    share: float
    """Weight of the limbs' way."""
    weight: float
    """How much a step of way left counts beside an action made."""
    visits: Ints
    """Stances expanded at every place, shape (rows, columns)."""
    crowding: float
    """By how much each of them makes the way left longer [steps]."""


@inlined
def place_of(s, fields, frame):
    """Row and column of the map's place that the body is at."""
    column = min(max(int(math.floor((s.x - frame[0]) / frame[2] + 0.5)), 0), fields.shape[2] - 1)
    row = min(max(int(math.floor((s.y - frame[1]) / frame[2] + 0.5)), 0), fields.shape[1] - 1)
    return row, column


@inlined
def way_left(p, s, guide):
    """About how many steps are left from a stance: the body's way, and a share of the mean way of its limbs."""
    fields, hold_fields = guide.fields, guide.hold_fields
    if s.stage >= fields.shape[0]:
        return 0.0
    row, column = place_of(s, fields, guide.frame)
    body = fields[s.stage, row, column]
    tips = 0.0
    for i in range(p.n_limbs):
        tips += hold_fields[s.stage, s.hold[i]] if s.hold[i] >= 0 else body
    return body + guide.share * tips / p.n_limbs + guide.after[s.stage]


@inlined
def bucket_of(cost, way, weight, buckets):
    """Which bucket of the open list a stance belongs in."""
    return min(np.int64(cost + weight * way), buckets - 1)


@kernel
def plant(p, start, nodes, guide):
    """Put the start stance into an empty search; returns its bucket."""
    keys, g, way, parent, code, following, heads, table = nodes
    key(p, start[0], keys[0])
    g[0] = 0
    way[0] = way_left(p, start[0], guide)
    parent[0] = NONE
    code[0] = 0
    following[0] = NONE
    f = bucket_of(0, way[0], guide.weight, heads.shape[0])
    heads[f] = 0
    table[slot_of(keys[0], table, keys, ROUGH)] = 0
    return f


@kernel
def search(p, nodes, guide, state, room, tally, quota):
    """Expand stances in order of cost + weight * way left until a goal, the end of the open list or of the arrays, or a quota.

    The way left from a place grows with every stance that was expanded there, so that a dead end fills up and the search leaves it (as in
    Korf's learning real-time A*, 1990); a stance whose turn comes with a way that has grown since goes back into the open list.

    A stance counts as it is first reached, and is expanded once: the way left misleads anyhow, and the plan is checked, not proved.
    Among equals the newest goes first.

    Args:
        p: A family's parameters.
        nodes: Stances seen; updated in place.
        guide: The way that is left; its visits are updated in place.
        state: Nodes, lowest bucket, expanded, actions judged, goal node (-1: none), node with the least way left; updated in place.
        room: Scratch.
        tally: How often each check forbade an action.
        quota: Most stances to expand in this call.

    Returns:
        FOUND, EXHAUSTED, FULL or RUNNING.
    """
    keys, g, way, parent, code, following, heads, table = nodes
    fields, frame, weight = guide.fields, guide.frame, guide.weight
    visits, crowding = guide.visits, guide.crowding
    codes, stances, margins, words, _ = room
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
            late = draft(p, stances[0], codes[c], stances[1])
            if late > 0:
                key(p, stances[1], words)
                if table[slot_of(words, table, keys, ROUGH)] >= 0:
                    continue
            if late < 0:
                continue
            state[JUDGED] += 1
            reason = step(p, stances[0], codes[c], stances[1], margins)
            if reason >= 0:
                tally[reason] += 1
                continue
            key(p, stances[1], words)
            slot = slot_of(words, table, keys, ROUGH)
            if table[slot] >= 0:
                continue
            child = state[NODES]
            state[NODES] += 1
            table[slot] = child
            for i in range(words.shape[0]):
                keys[child, i] = words[i]
            g[child] = g[node] + 1
            way[child] = way_left(p, stances[1], guide)
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
