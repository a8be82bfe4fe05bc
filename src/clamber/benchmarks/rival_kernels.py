"""Random walks, bursts of them, and greedy best-first search as kernels."""

from typing import NamedTuple

import numpy as np

from ..compiled import inlined, kernel
from ..planning.problem.family_kernels import candidates, done, key, measure, restore, step
from ..planning.problem.randoms import below, draw, unit
from ..planning.stance_table import slot_of
from ..types import Floats, Ints


class Nodes(NamedTuple):
    """Stances seen, shape (capacity, ...), and those that are open."""

    keys: np.ndarray[tuple[int, ...], np.dtype[np.int64]]
    value: Floats
    """What they are worth."""
    parent: Ints
    code: Ints
    """The action that led there."""
    heap: Ints
    """Open ones."""
    table: Ints
    """Hash table; its size is a power of two."""


@inlined
def worth(p, s, weights, row):
    """What a stance is worth to a search: its features, weighted."""
    measure(p, s, row)
    value = 0.0
    for i in range(row.shape[0]):
        value += weights[i] * row[i]
    return value


@kernel
def random_walk(p, room, weights, again, limits, counters, trail):
    """One random walk: every action is drawn from those that hold, and what the walk is worth is its best prefix.

    Args:
        p: A family's parameters.
        room: Scratch; the walk begins at its first stance, which it overwrites. The third is its best stance.
        weights: Weights of the features.
        again: Probability of doing the same as before, where that is among the candidates.
        limits: Most actions, and most actions to judge.
        counters: Three, of the random numbers.
        trail: Output: the actions, `most` of them at most.

    Returns:
        Actions of the best prefix, what it is worth, actions judged, and whether it meets the goal.
    """
    codes, stances, margins, _, row = room
    most, most_checks = limits
    seed, a, b = counters
    now = 0
    stances[2] = stances[0]
    best = worth(p, stances[0], weights, row)
    best_at = 0
    checks = 0
    last = -1
    drawn = 0
    if done(p, stances[0]):
        return 0, best, 0, True
    for at in range(most):
        n = candidates(p, stances[now], codes)
        moved = False
        while n > 0 and checks < most_checks:
            pick = below(draw(seed, a, b, drawn), n)
            if last >= 0 and unit(draw(seed, a, b, drawn + 1)) < again:
                for c in range(n):
                    if codes[c] == last:
                        pick = c
            drawn += 2
            chosen = codes[pick]
            codes[pick] = codes[n - 1]
            n -= 1
            checks += 1
            if step(p, stances[now], chosen, stances[1 - now], margins) >= 0:
                continue
            now = 1 - now
            trail[at] = chosen
            last = chosen
            moved = True
            break
        if not moved:
            break
        if done(p, stances[now]):
            stances[2] = stances[now]
            return at + 1, worth(p, stances[now], weights, row), checks, True
        value = worth(p, stances[now], weights, row)
        if value > best:
            best = value
            best_at = at + 1
            stances[2] = stances[now]
    return best_at, best, checks, False


@kernel
def burst(p, here, room, weights, how, counters, lines, found):
    """Walk at random from a stance, many times, and keep the walk that is worth most; a goal ends the burst.

    Args:
        p: A family's parameters.
        here: Where the walks begin, array of one record; the best walk's end on return.
        room, weights: As in `random_walk`.
        how: The probability `again` of `random_walk`, how many walks, most actions of one, and most actions to judge.
        counters: Two, of the random numbers.
        lines: Scratch for the actions of a walk; output: those of the best walk.
        found: Worth to be exceeded.

    Returns:
        Actions of the best walk (-1: none exceeds `found`), what it is worth, actions judged, and whether it meets the goal.
    """
    again, walks, most, most_checks = how
    seed, number = counters
    trail, best = lines
    stances = room.stances
    length = -1
    checks = 0
    for walk in range(walks):
        if checks >= most_checks:
            break
        stances[0] = here[0]
        limits = (most, most_checks - checks)
        actions, value, judged, reached = random_walk(p, room, weights, again, limits, (seed, number, walk), trail)
        checks += judged
        if reached or value > found:
            found = value
            length = actions
            for i in range(actions):
                best[i] = trail[i]
            here[1] = stances[2]
        if reached:
            here[0] = here[1]
            return length, found, checks, True
    if length >= 0:
        here[0] = here[1]
    return length, found, checks, False


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
def greedy(p, weights, nodes, state, room, most_checks, quota):
    """Expand the stance that is worth most until the goal, the end of the space, of memory, of the budget, or a quota.

    A stance is entered once, by the way that came first, so the search never goes in circles. The start is node 0, put in by the caller.

    Args:
        p: A family's parameters.
        weights: Weights of the features.
        nodes: Stances seen; updated in place.
        state: Nodes, open ones, expanded ones, actions judged, goal, node that is worth most; int64, shape (6,), updated in place.
        room: Scratch.
        most_checks: Most actions to judge.
        quota: Most stances to expand in this call.

    Returns:
        FOUND, EXHAUSTED, FULL (memory or budget) or RUNNING.
    """
    keys, value, parent, code, heap, table = nodes
    codes, stances, margins, words, row = room
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
def plant_root(p, start, weights, nodes, row):
    """Enter the start stance (array of one record) as node 0."""
    key(p, start[0], nodes.keys[0])
    nodes.value[0] = worth(p, start[0], weights, row)
    nodes.table[slot_of(nodes.keys[0], nodes.table, nodes.keys)] = 0
