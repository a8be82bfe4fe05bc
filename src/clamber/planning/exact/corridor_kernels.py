"""The shortest plan near a plan: collect the stances about it with what leads from each to each, then search that graph alone."""

import math

from ...compiled import kernel
from ..problem.family_kernels import bound, candidates, done, key, restore, step, toward
from ..stance_table import slot_of
from .records import NONE


@kernel
def collect(p, plan, keys, leads, table, first_edge, edge_to, edge_code, codes, stances, margins, words, state):
    """Expand the stances of a plan, then their children, and so on, layer by layer, until the arrays are full or the space ends.

    A stance from which no plan shorter than the given one can lead to the goal is left out: its fewest actions from the start and to the
    goal are bounded by the family's `toward` and `bound`.

    Args:
        p: A family's parameters.
        plan: Stances of the plan, start included; the last meets the goal.
        keys: Output: key of every node, the plan's stances first.
        leads: Output, one byte per node: whether it meets the goal.
        table: Empty hash table of the nodes.
        first_edge: Output: first edge of every node, and the end; nodes that were not expanded have none.
        edge_to, edge_code: Output: node that an edge leads to, and the action.
        codes, stances, margins, words: Scratch.
        state: Output: nodes, nodes expanded, actions judged.
    """
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
                    if math.ceil(toward(p, plan[0], stances[1])) + math.ceil(bound(p, stances[1])) >= length:
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
def shortest(expanded, leads, first_edge, edge_to, edge_code, parent, code, queue):
    """Breadth-first search from node 0 of a collected graph.

    Args:
        expanded: Nodes with edges.
        leads, first_edge, edge_to, edge_code: As `collect` wrote them.
        parent, code: Output: where each node was reached from, and by which action.
        queue: Scratch, one entry per node.

    Returns:
        The goal node with the fewest actions, or -1.
    """
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
