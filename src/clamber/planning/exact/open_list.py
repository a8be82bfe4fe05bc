"""The open list of an exact search: buckets of labels by cost, and levels within the bucket that is being emptied."""

import numpy as np

from ...compiled import inlined
from .records import EQUAL, NEAREST, NONE, SHORTEST


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
def add_label(search, state, labels, heads, steps, node, first, second, ahead, parent, code, flipped):
    """Put a way to a stance into the open list; `ahead` is the bound on its actions."""
    at = state.labels
    state.labels += 1
    label = labels[at]
    label.first = first
    label.second = second
    label.ahead = ahead
    label.node = node
    label.parent = parent
    label.code = code
    label.flipped = flipped
    f = first + ahead if search.informed else first
    bucket = min(np.int64(f / search.width + EQUAL), heads.shape[0] - 1)
    if bucket <= state.lowest:
        lay(search, state, labels, steps, at, ahead)
    else:
        label.next = heads[bucket]
        heads[bucket] = at


@inlined
def take_label(search, state, labels, heads, steps):
    """The next label, or -1: there is none in this bucket, and the next one that holds some is laid out."""
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
