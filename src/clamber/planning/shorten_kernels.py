"""Shorter ways between stances of a plan as kernels: A* through a window, and the shortest way through the stances about it."""

import math
from typing import NamedTuple

import numpy as np

from ..compiled import inlined, kernel
from ..types import Ints, Records
from .exact.records import NONE
from .problem.family_kernels import bound, candidates, done, draft, heuristic_between, key, restore, step
from .stance_table import slot_of

Keys = np.ndarray[tuple[int, ...], np.dtype[np.int64]]


class Line(NamedTuple):
    """A plan's stances, start included, with their keys and the hash table of these."""

    stances: Records
    keys: Keys
    table: Ints


class Tree(NamedTuple):
    """Nodes of a search, their number bounds its effort; its open list; and its hash table."""

    keys: Keys
    g: Ints
    closed: np.ndarray[tuple[int, ...], np.dtype[np.uint8]]
    parent: Ints
    code: Ints
    entries: Ints
    following: Ints
    heads: Keys
    table: Ints


class Graph(NamedTuple):
    """Nodes with the ways on from them."""

    keys: Keys
    leads: np.ndarray[tuple[int, ...], np.dtype[np.uint8]]
    """Whether a node meets the goal."""
    table: Ints
    first_edge: Keys
    """First edge of every node, and the end; nodes that were not expanded have none."""
    edge_to: Ints
    """Node that an edge leads to."""
    edge_code: Ints
    """Its action."""


@kernel
def stance_keys(p, stances, keys):
    """Keys of stances."""
    for i in range(stances.shape[0]):
        key(p, stances[i], keys[i])


@inlined
def left(p, s, target, to_goal):
    """Actions from a stance to the window's end at least: to the key of `target`, or to the goal."""
    return math.ceil(bound(p, s) if to_goal else heuristic_between(p, s, target))


@kernel
def search_window(p, line, window, to_goal, tree, room, state):
    """Search from stance `first` of a plan to its stance `last` for a way with fewer actions than the plan takes.

    Ways that come back to the plan anywhere after `first`, or reach the goal, count too: what they save is known at once, and only ways
    that could save more are followed from then on. With a consistent bound the result saves the most that any way to `last` can.

    Args:
        p: A family's parameters.
        line: The plan.
        window: Its first and last stance.
        to_goal: Whether the window may end in any goal stance, not only in its last one.
        tree: Filled.
        room: Scratch.
        state: Output: nodes, actions judged, node that rejoins, stance of the plan where it does, actions saved.
    """
    plan, plan_keys, plan_table = line
    first, last = window
    keys, g, closed, parent, code, entries, following, heads, table = tree
    codes, stances, margins, words, _ = room
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
            late = draft(p, stances[0], codes[c], stances[1])
            if late < 0:
                continue
            if late == 0:
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
            if late > 0:
                judged += 1
                if step(p, stances[0], codes[c], stances[1], margins) >= 0:
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


@kernel
def collect(p, plan, graph, room, state):
    """Expand the stances of a plan, then their children, and so on, layer by layer, until the arrays are full or the space ends.

    A stance from which no plan shorter than the given one can lead to the goal is left out: its fewest actions from the start and to the
    goal are bounded by the family's `heuristic_between` and `bound`.

    Args:
        p: A family's parameters.
        plan: Stances of the plan, start included; the last meets the goal.
        graph: Output, the plan's stances first; its hash table is empty.
        room: Scratch.
        state: Output: nodes, nodes expanded, actions judged.
    """
    keys, leads, table, first_edge, edge_to, edge_code = graph
    codes, stances, margins, words, _ = room
    length = plan.shape[0] - 1
    nodes = 0
    for i in range(plan.shape[0]):
        key(p, plan[i], words)
        slot = slot_of(words, table, keys)
        if table[slot] < 0:
            for w in range(words.shape[0]):
                keys[nodes, w] = words[w]
            leads[nodes] = 1 if done(p, plan[i]) else 0
            table[slot] = nodes
            nodes += 1
    node, edges, judged = 0, 0, 0
    while node < nodes and nodes + codes.shape[0] <= keys.shape[0] and edges + codes.shape[0] <= edge_to.shape[0]:
        first_edge[node] = edges
        if not leads[node]:
            restore(p, keys[node], stances[0])
            for c in range(candidates(p, stances[0], codes)):
                judged += 1
                if step(p, stances[0], codes[c], stances[1], margins) >= 0:
                    continue
                key(p, stances[1], words)
                slot = slot_of(words, table, keys)
                child = table[slot]
                if child < 0:
                    if math.ceil(heuristic_between(p, plan[0], stances[1])) + math.ceil(bound(p, stances[1])) >= length:
                        continue
                    child = nodes
                    nodes += 1
                    table[slot] = child
                    leads[child] = 1 if done(p, stances[1]) else 0
                    for w in range(words.shape[0]):
                        keys[child, w] = words[w]
                edge_to[edges] = child
                edge_code[edges] = codes[c]
                edges += 1
        node += 1
    first_edge[node] = edges
    state[0], state[1], state[2] = nodes, node, judged


@kernel
def shortest(expanded, graph, parent, code, queue):
    """Breadth-first search from node 0 of a collected graph.

    Args:
        expanded: Nodes with edges.
        graph: As `collect` wrote it.
        parent, code: Output: where each node was reached from, and by which action.
        queue: Scratch, one entry per node.

    Returns:
        The goal node with the fewest actions, or -1.
    """
    leads, first_edge = graph.leads, graph.first_edge
    edge_to, edge_code = graph.edge_to, graph.edge_code
    parent[:] = NONE
    if leads[0]:
        return 0
    queue[0] = 0
    parent[0] = 0
    head, tail = 0, 1
    while head < tail:
        node = queue[head]
        head += 1
        if node >= expanded:
            continue
        for e in range(first_edge[node], first_edge[node + 1]):
            child = edge_to[e]
            if parent[child] >= 0:
                continue
            parent[child] = node
            code[child] = edge_code[e]
            if leads[child]:
                return child
            queue[tail] = child
            tail += 1
    return NONE
