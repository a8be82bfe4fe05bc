"""Best-first search over stances as one kernel: children by the family's `step`, two costs, a bound, dominance, symmetry."""

import math

import numpy as np

from ...compiled import inlined, kernel
from ..problem.family_kernels import bound, candidates, dominating, done, draft, key, measure, reflect, restore, step
from ..problem.loops import LARGEST
from ..stance_table import slot_of
from .records import EQUAL, EXHAUSTED, FOUND, FULL, NEAREST, NONE, RUNNING, SHORTEST


@inlined
def lay(search, state, labels, steps, at, ahead):
    """Put a label into the bucket being emptied, at its level."""
    level = 0
    if search.order == SHORTEST:
        level = min(np.int64(labels[at].first), steps.shape[0] - 1)
    elif search.order == NEAREST:
        level = min(np.int64(ahead), steps.shape[0] - 1)
    labels[at].next = steps[level]
    steps[level] = at
    state.level = min(state.level, level)
    state.levels = max(state.levels, level + 1)


@inlined
def add_label(search, state, seen, node, costs, ahead, way):
    """Put a way to a stance into the open list.

    Args:
        search, state, seen: As in `explore_some`.
        node: The stance.
        costs: First and second.
        ahead: Bound on the actions still needed.
        way: The label before, the action, and whether the stance kept is the mirror image of the one that it led to.
    """
    labels, heads = seen.labels, seen.heads
    first, second = costs
    at = state.labels
    state.labels += 1
    label = labels[at]
    label.first = first
    label.second = second
    label.ahead = ahead
    label.node = node
    label.parent, label.code, label.flipped = way
    f = first + ahead if search.informed else first
    bucket = min(np.int64(f / search.width + EQUAL), heads.shape[0] - 1)
    if bucket <= state.lowest:
        lay(search, state, labels, seen.steps, at, ahead)
    else:
        label.next = heads[bucket]
        heads[bucket] = at


@inlined
def take_label(search, state, seen):
    """The next label, or -1: there is none in this bucket, and the next one that holds some is laid out."""
    labels, heads, steps = seen.labels, seen.heads, seen.steps
    while state.level < state.levels and steps[state.level] < 0:
        state.level += 1
    if state.level < state.levels:
        taken = steps[state.level]
        steps[state.level] = labels[taken].next
        return taken
    state.lowest += 1
    while state.lowest < heads.shape[0] and heads[state.lowest] < 0:
        state.lowest += 1
    state.level = steps.shape[0]
    state.levels = 0
    if state.lowest < heads.shape[0]:
        at = heads[state.lowest]
        heads[state.lowest] = NONE
        while at >= 0:
            following = labels[at].next
            lay(search, state, labels, steps, at, labels[at].ahead)
            at = following
    return NONE


@inlined
def keep(p, stances, at, words):
    """Key of stance `at`, or of its mirror image (written behind it) if that key comes first: `words[0]`; returns which was kept."""
    key(p, stances[at], words[0])
    if reflect(p, stances[at], stances[at + 1]):
        key(p, stances[at + 1], words[1])
        for i in range(words.shape[1]):
            if words[1, i] != words[0, i]:
                if words[1, i] > words[0, i]:
                    break
                for j in range(words.shape[1]):
                    words[0, j] = words[1, j]
                return at + 1
    return at


@inlined
def less(first, second, other_first, other_second):
    """Whether one pair of costs is less than another in lexicographic order, by more than rounding."""
    gap = EQUAL * abs(first)
    if first < other_first - gap:
        return True
    if first > other_first + gap:
        return False
    return second < other_second - EQUAL * abs(second)


@inlined
def grown(p, column, cost, row):
    """A cost after one more action: summed, or the largest, as the family says of the feature."""
    if column < 0:
        return 0.0
    return max(cost, row[column]) if p.kinds[column] == LARGEST else cost + row[column]


@inlined
def passed_over(p, search, s, costs, seen, words, freed):
    """Whether a dominating stance was reached at no more cost: whatever can be done from here can be done from there."""
    nodes, keys, table = seen.nodes, seen.keys, seen.table
    first, second = costs
    which = 0
    while dominating(p, s, which, freed):
        key(p, freed, words)
        other = table[slot_of(words, table, keys)]
        if other >= 0:
            if search.front:
                if nodes[other].closed <= second and nodes[other].closed_first <= first:
                    return True
            elif not less(first, second, nodes[other].first, nodes[other].second):
                return True
        which += 1
    return False


@kernel
def plant(p, search, state, start, seen, room):
    """Put the start stance into an empty search; False if the bound rules out every goal."""
    nodes, keys, table = seen.nodes, seen.keys, seen.table
    stances, words, row = room.stances, room.words, room.row
    ahead = bound(p, start[0])
    stances[1] = start[0]
    flipped = keep(p, stances, 1, words) - 1
    for i in range(words.shape[1]):
        keys[0, i] = words[0, i]
    state.nodes = 1
    table[slot_of(keys[0], table, keys)] = 0
    measure(p, start[0], row)
    first = row[search.first] if p.kinds[search.first] == LARGEST else 0.0
    second = 0.0
    if search.second >= 0 and p.kinds[search.second] == LARGEST:
        second = row[search.second]
    nodes[0].first = first
    nodes[0].second = second
    nodes[0].closed = math.inf
    state.goal = NONE
    state.goal_first = math.inf
    state.goal_second = math.inf
    if ahead == math.inf or (search.capped >= 0 and row[search.capped] > search.cap):
        return False
    state.lowest = NONE
    add_label(search, state, seen, 0, (first, second), ahead, (NONE, 0, flipped))
    return True


@kernel
def explore_some(p, search, state, seen, room, tally, quota):
    """Take labels in order of first cost + bound until the goal, the end of the space, the end of the arrays, or a quota.

    A stance is reached again where that is better by the lexicographic order of the two costs, so a label's costs are least as soon as
    its bucket is empty; the first goal that survives its bucket is the optimum. With `front`, labels are kept that are better in the
    second cost than every one taken before at their stance: with a consistent bound the first costs taken never fall, so what is dropped
    is no better in either (bi-objective A*, Hernandez Ulloa and others, 2020).

    Args:
        p: A family's parameters.
        search: What is minimized, record of `SEARCH`.
        state: Where the search is, record of `STATE`; updated in place.
        seen: What it knows.
        room: Scratch, of four stances and two keys.
        tally: How often each check forbade an action.
        quota: Most labels to take in this call.

    Returns:
        FOUND, EXHAUSTED, FULL or RUNNING.
    """
    nodes, labels, keys, heads, table = seen.nodes, seen.labels, seen.keys, seen.heads, seen.table
    codes, stances, margins, words, row = room
    simple = search.second < 0 and search.informed
    for _ in range(quota):
        if max(state.nodes + codes.shape[0] > keys.shape[0], state.labels + codes.shape[0] > labels.shape[0]):
            return FULL
        taken = take_label(search, state, seen)
        if taken < 0:
            if state.goal >= 0 and not search.front:
                return FOUND
            if state.lowest >= heads.shape[0]:
                return FOUND if state.goal >= 0 else EXHAUSTED
            continue
        node = labels[taken].node
        first = labels[taken].first
        second = labels[taken].second
        if search.front:
            if second >= nodes[node].closed or second >= state.goal_second:
                continue
            if first == nodes[node].first and second > nodes[node].second:
                continue  # a way of as many actions and less of the second cost waits
        elif (
            first != nodes[node].first
            or second != nodes[node].second
            or not less(first, second, state.goal_first, state.goal_second)
        ):
            continue
        nodes[node].closed = second
        nodes[node].closed_first = first
        restore(p, keys[node], stances[0])
        if done(p, stances[0]):
            labels[taken].next = state.goal  # the goals before, for a front
            state.goal = taken
            state.goal_first = first
            state.goal_second = second
            if simple:
                return FOUND
            continue
        state.expanded += 1
        for c in range(candidates(p, stances[0], codes)):
            late = draft(p, stances[0], codes[c], stances[1]) if simple and search.capped < 0 else 0
            if late < 0:
                continue
            if late == 0:
                state.checks += 1
                reason = step(p, stances[0], codes[c], stances[1], margins)
                if reason >= 0:
                    tally[reason] += 1
                    continue
            measure(p, stances[1], row)
            if search.capped >= 0 and row[search.capped] > search.cap:
                continue
            new_first = grown(p, search.first, first, row)
            new_second = grown(p, search.second, second, row)
            if search.front and new_second >= state.goal_second:
                continue
            kept = keep(p, stances, 1, words)
            slot = slot_of(words[0], table, keys)
            child = table[slot]
            if child >= 0:
                if search.front:
                    if new_second >= nodes[child].closed:
                        continue
                    if new_first == nodes[child].first and new_second >= nodes[child].second:
                        continue
                elif not less(new_first, new_second, nodes[child].first, nodes[child].second):
                    continue
            ahead = bound(p, stances[kept])
            if ahead == math.inf:
                state.dead += 1
                continue
            if new_first + (ahead if search.informed else 0.0) > search.at_most:
                continue
            costs = (new_first, new_second)
            if search.dominance and passed_over(p, search, stances[kept], costs, seen, words[1], stances[3]):
                state.dominated += 1
                continue
            if late > 0:
                state.checks += 1
                reason = step(p, stances[0], codes[c], stances[1], margins)
                if reason >= 0:
                    tally[reason] += 1
                    continue
            if child < 0:
                child = state.nodes
                state.nodes += 1
                table[slot] = child
                nodes[child].first = math.inf
                nodes[child].closed = math.inf
                for i in range(words.shape[1]):
                    keys[child, i] = words[0, i]
            nodes[child].first = new_first
            nodes[child].second = new_second
            add_label(search, state, seen, child, costs, ahead, (taken, codes[c], kept - 1))
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
