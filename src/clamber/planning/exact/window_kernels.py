"""A shorter way between two stances of a plan: A* as one kernel, that rejoins the plan wherever that saves the most."""

import math

from ...compiled import inlined, kernel
from ..problem.family_kernels import bound, candidates, done, key, restore, step, toward
from ..stance_table import slot_of
from .records import NONE


@kernel
def stance_keys(p, stances, keys):
    """Keys of stances."""
    for i in range(stances.shape[0]):
        key(p, stances[i], keys[i])


@inlined
def left(p, s, target, to_goal):
    """Actions from a stance to the window's end at least: to the key of `target`, or to the goal."""
    return math.ceil(bound(p, s) if to_goal else toward(p, s, target))


@kernel
def search_window(
    p, plan, plan_keys, plan_table, first, last, to_goal, keys, g, closed, parent, code, entries, following, heads, table, codes,
    stances, margins, words, state,
):  # fmt: skip
    """Search from stance `first` of a plan to its stance `last` for a way with fewer actions than the plan takes.

    Ways that come back to the plan anywhere after `first`, or reach the goal, count too: what they save is known at once, and only ways
    that could save more are followed from then on. With a consistent bound the result saves the most that any way to `last` can.

    Args:
        p: A family's parameters.
        plan: Stances of the plan, start included; `plan_keys` their keys, `plan_table` the hash table of these.
        first, last: The window.
        to_goal: Whether the window may end in any goal stance, not only in stance `last`.
        keys, g, closed, parent, code: Nodes, as in `kernels.search`; their number bounds the effort.
        entries, following, heads: The open list, as there.
        table: Hash table of the nodes.
        codes, stances, margins, words: Scratch.
        state: Output: nodes, actions judged, node that rejoins, stance of the plan where it does, actions saved.
    """
    end = plan.shape[0] - 1
    length = last - first
    table[:] = NONE
    heads[: length + 1] = NONE
    for i in range(words.shape[0]):
        keys[0, i] = plan_keys[first, i]
    g[0] = 0
    closed[0] = 0
    parent[0] = NONE
    table[slot_of(keys[0], table, keys)] = 0
    nodes, used, judged, saved = 1, 1, 0, 0
    state[2], state[3] = NONE, NONE
    lowest = int(left(p, plan[first], plan[last], to_goal))
    if lowest < length:
        entries[0] = 0
        following[0] = NONE
        heads[lowest] = 0
    while True:
        while lowest < length - saved and heads[lowest] < 0:
            lowest += 1
        if lowest >= length - saved or max(nodes, used) + codes.shape[0] > keys.shape[0]:
            break
        node = entries[heads[lowest]]
        heads[lowest] = following[heads[lowest]]
        if closed[node]:
            continue
        closed[node] = 1
        restore(p, keys[node], stances[0])
        for c in range(candidates(p, stances[0], codes)):
            judged += 1
            if step(p, stances[0], codes[c], stances[1], margins) >= 0:
                continue
            key(p, stances[1], words)
            cost = g[node] + 1
            slot = slot_of(words, table, keys)
            child = table[slot]
            if child >= 0 and (closed[child] or g[child] <= cost):
                continue
            f = cost + int(left(p, stances[1], plan[last], to_goal))
            at = plan_table[slot_of(words, plan_table, plan_keys)]
            if done(p, stances[1]):
                at = end
            gain = at - first - cost
            if f >= length - saved and gain <= saved:
                continue
            if child < 0:
                child = nodes
                nodes += 1
                table[slot] = child
                closed[child] = 0
                for i in range(words.shape[0]):
                    keys[child, i] = words[i]
            g[child] = cost
            parent[child] = node
            code[child] = codes[c]
            if at > first and gain > saved:
                saved = gain
                state[2] = child
                state[3] = at
            if f < length - saved:
                lowest = min(lowest, f)
                entries[used] = child
                following[used] = heads[f]
                heads[f] = used
                used += 1
    state[0], state[1], state[4] = nodes, judged, saved
