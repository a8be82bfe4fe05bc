"""Monte-Carlo tree search as kernels: selection by UCB1, expansion, a random walk as simulation, backup; nodes are stances by key."""

import math
from typing import NamedTuple

import numpy as np

from ..compiled import inlined, kernel
from ..planning.problem.family_kernels import candidates, key, restore, step
from ..planning.problem.randoms import below, draw
from ..planning.stance_table import slot_of
from ..types import Floats, Ints
from .rival_kernels import random_walk

NODES, EDGES, CHECKS, NUMBER = 0, 1, 2, 3
"""Places in the state: nodes, edges, actions judged, simulations so far."""
LEAF, DEAD = -1, -2
"""In `first`: not expanded yet; nothing holds there."""
TABU = -1
"""In `mark`: a node on the way from the start to the root, which no simulation goes back to."""


Keys = np.ndarray[tuple[int, ...], np.dtype[np.int64]]


class Tree(NamedTuple):
    """Stances as nodes, and actions as edges between them."""

    keys: Keys
    visits: Ints
    total: Floats
    """Sum of the values of every node ..."""
    top: Floats
    """... and the largest."""
    first: Ints
    """First edge of every node, or LEAF, or DEAD."""
    edges: Ints
    """Its number of edges."""
    mark: Keys
    """For every node the last simulation whose way led through it, or TABU."""
    child_of: Ints
    """Node that every edge leads to."""
    code_of: Ints
    """Its action."""
    table: Ints
    """Hash table of the nodes."""


class Manner(NamedTuple):
    """How simulations are made."""

    explore: float
    """Exploration constant of UCB1, for values scaled to 0..1."""
    boldness: float
    """Share of a node's best value, against its mean."""
    again: float
    """Probability of a walk to do the same as before."""
    horizon: int
    """Most actions of a random walk."""
    longest: int
    """Most actions from the start."""
    most_visits: int
    """Of the root."""
    most_checks: int
    """Most actions to judge."""
    seed: int
    """Of the random numbers."""


class Lines(NamedTuple):
    """Ways, and two numbers for each tree."""

    path: Ints
    """Scratch, edges on the way."""
    tried: Ints
    """Scratch, candidates beside those of a walk."""
    trail: Ints
    """Scratch of a walk."""
    plan: Ints
    """Output: the actions from the root to the goal."""
    scale: Floats
    """Smallest and largest value seen since the root was taken, updated in place."""


@kernel
def enter(p, s, tree, words, state):
    """The node of a stance, made if there is none."""
    keys, visits, total, top, first, count, mark, _, _, table = tree
    key(p, s, words)
    slot = slot_of(words, table, keys)
    if table[slot] >= 0:
        return table[slot]
    node = state[NODES]
    state[NODES] += 1
    table[slot] = node
    for i in range(words.shape[0]):
        keys[node, i] = words[i]
    visits[node] = 0
    mark[node] = 0
    total[node] = 0.0
    top[node] = -math.inf
    first[node] = LEAF
    count[node] = 0
    return node


@inlined
def choose(node, tree, here, scale, how, bits):
    """The edge of a node with the largest upper bound, children on the way here and dead ones left out; -1: none.

    UCB1 with the statistics of the child node, whichever way they were gathered (UCT1 of Childs, Brodeur and Kocsis 2008), values scaled
    to 0..1 by the range seen, and the mean mixed with the best, as fits a game for one (Schadd et al. 2008).
    """
    _, visits, total, top, first, count, mark, child_of, _, _ = tree
    low, high = scale[0], scale[1]
    best = -math.inf
    chosen = -1
    n = count[node]
    turn = below(bits, n) if n > 0 else 0
    spread = high - low if high > low else 1.0
    grown = math.log(visits[node] + 1.0)
    for k in range(n):
        edge = first[node] + (k + turn) % n
        child = child_of[edge]
        if mark[child] == here or mark[child] == TABU or first[child] == DEAD:
            continue
        if visits[child] == 0:
            return edge
        mean = (total[child] / visits[child] - low) / spread
        most = (top[child] - low) / spread
        bound = (1.0 - how.boldness) * mean + how.boldness * most + how.explore * math.sqrt(grown / visits[child])
        if bound > best:
            best = bound
            chosen = edge
    return chosen


@kernel
def simulate(p, weights, tree, room, state, at, how, lines):
    """Simulate from the root until it has been visited often enough, the budget or memory ends, or a plan reaches the goal.

    Args:
        p: A family's parameters.
        weights: Weights of the features: what a simulation is worth is that of the best stance that it saw.
        tree: Updated in place.
        room: Scratch, of three stances and one more.
        state: See the top; int64, shape (4,), updated in place.
        at: Node to simulate from, and actions from the start to it.
        how: How, and how long.
        lines: Scratch, and what comes out.

    Returns:
        Actions from the root to the goal; -1: none was found.
    """
    visits, total, top, first, count = tree.visits, tree.total, tree.top, tree.first, tree.edges
    keys, mark, child_of, code_of = tree.keys, tree.mark, tree.child_of, tree.code_of
    codes, stances, margins, words, _ = room
    path, tried, trail, plan, scale = lines
    longest, most_checks, seed = how.longest, how.most_checks, how.seed
    root, depth = at
    while visits[root] < how.most_visits and state[CHECKS] < most_checks and first[root] != DEAD:
        if state[NODES] + codes.shape[0] > keys.shape[0] or state[EDGES] + codes.shape[0] > child_of.shape[0]:
            return -1
        state[NUMBER] += 1
        number = state[NUMBER]
        node = root
        steps = 0
        while first[node] >= 0 and depth + steps < longest:
            bits = draw(seed, number, steps, 0)
            edge = choose(node, tree, number, scale, how, bits)
            if edge < 0:
                break
            path[steps] = edge
            steps += 1
            node = child_of[edge]
            mark[node] = number
        restore(p, keys[node], stances[0])
        if first[node] == LEAF and (visits[node] > 0 or node == root) and depth + steps < longest:
            grown = 0
            begin = state[EDGES]
            stances[3] = stances[0]
            for c in range(candidates(p, stances[3], tried)):
                state[CHECKS] += 1
                if step(p, stances[3], tried[c], stances[1], margins) >= 0:
                    continue
                child = enter(p, stances[1], tree, words, state)
                child_of[begin + grown] = child
                code_of[begin + grown] = tried[c]
                grown += 1
            state[EDGES] += grown
            first[node] = begin if grown else DEAD
            count[node] = grown
            if grown:
                path[steps] = begin + below(draw(seed, number, steps, 1), grown)
                node = child_of[path[steps]]
                steps += 1
                restore(p, keys[node], stances[0])
        limits = (min(how.horizon, longest - depth - steps), most_checks - state[CHECKS])
        actions, value, judged, reached = random_walk(p, room, weights, how.again, limits, (seed, number, -1), trail)
        state[CHECKS] += judged
        scale[0] = min(scale[0], value)
        scale[1] = max(scale[1], value)
        visits[root] += 1
        total[root] += value
        top[root] = max(top[root], value)
        for k in range(steps):
            node = child_of[path[k]]
            visits[node] += 1
            total[node] += value
            top[node] = max(top[node], value)
        if reached:
            for k in range(steps):
                plan[k] = code_of[path[k]]
            for k in range(actions):
                plan[steps + k] = trail[k]
            return steps + actions
    return -1
