"""Backward breadth-first search through the relaxed problem: all angles of a state at once, as the bits of a word."""

import math

import numpy as np

from ....compiled import inlined, kernel
from ..statics.records import goals
from .goals import meets
from .keys import GRABS, RELEASES
from .relaxed_places import (
    ALL_ANGLES,
    UNREACHED,
    all_states,
    bit_of,
    block_base,
    grip_at,
    grip_holds,
    grip_of,
    grips,
    left,
    on_one_hold,
    open_state,
    pair_state,
    put,
    triple_state,
)


@kernel
def mark_goals(p, s, stage, masks, values, members):
    """Write what is left of the later stages (0 at the last) at every state and angle that meets a goal; UNREACHED elsewhere.

    Args:
        p: Parameters.
        s: Scratch, one stance.
        stage: Which goal.
        masks: Angles at which each grip holds.
        values: Output, per lap, state and angle kept.
        members: Scratch, shape (3, 2).
    """
    goal = goals(p)[stage]
    for at in range(values.shape[0]):
        values[at] = UNREACHED
    states = all_states(p)
    later = (stage + 1) * values.shape[0]
    for where in range(p.places_nx * p.places_ny):
        put(p, s, where, 0)
        if s.x < goal.x_min - 1e-9 or s.x > goal.x_max + 1e-9 or s.y < goal.y_min - 1e-9 or s.y > goal.y_max + 1e-9:
            continue
        if p.circles:
            s.bearing = math.atan2(s.y - p.centre_y, s.x - p.centre_x)
        blocks = p.n_limbs * (p.n_limbs - 1) // 2 + 1
        for state in range(block_base(p, where, 0), block_base(p, where, blocks)):
            count = open_state(p, where, state, members)
            both = ALL_ANGLES
            for i in range(p.n_limbs):
                s.hold[i] = -1 if p.n_limbs == 3 else goal.hold[i]
            for k in range(count):
                grip = grip_at(p, where, members[k, 0], members[k, 1])
                s.hold[members[k, 0]] = grip_holds(p)[grip]
                both &= masks[grip]
            for k in range(1, count):
                for m in range(k):
                    if on_one_hold(p, where, members[m, 0], members[m, 1], members[k, 0], members[k, 1]):
                        both = np.uint64(0)
            for angle in range(p.angles):
                if not both & bit_of(p, angle):
                    continue
                put(p, s, where, angle)
                for lap in range(p.laps_most):
                    s.laps = p.laps_least + lap
                    if meets(p, s, goal):
                        at = (lap * states + state) * p.angles_kept + (angle if p.angles_kept > 1 else 0)
                        values[at] = 0 if stage == p.n_goals - 1 else min(values[at], left(p)[later + at])


@kernel
def sort_sources(values, first_of, order):
    """Sort the entries of `values` below UNREACHED by value: those of value v are order[first_of[v]:first_of[v + 1]]."""
    for at in range(values.shape[0]):
        if values[at] < UNREACHED:
            first_of[values[at] + 1] += 1
    for value in range(1, first_of.shape[0]):
        first_of[value] += first_of[value - 1]
    for at in range(values.shape[0]):
        if values[at] < UNREACHED:
            order[first_of[values[at]]] = at
            first_of[values[at]] += 1
    for value in range(first_of.shape[0] - 1, 0, -1):
        first_of[value] = first_of[value - 1]
    first_of[0] = 0


@inlined
def push(state, mask, seen, n):
    """Add angles to a state of the next layer, by `seen`: what is reached, what is pending, the queue; returns the queue's length."""
    reached, pending, queue = seen
    new = mask & ~reached[state]
    if new:
        if not pending[state]:
            queue[n] = state
            n += 1
        pending[state] |= new
    return n


@inlined
def spin(p, mask):
    """The angles from which one turn, either way if both are allowed, leads to those of a bit set."""
    out = np.uint64(0)
    last = np.uint64(p.angles - 1)
    one = np.uint64(1)
    within = ALL_ANGLES >> (np.uint64(63) - last)
    if p.allowed & (1 << 4):  # +theta leads here from the angle before
        out |= (mask >> one) | ((mask & one) << last)
    if p.allowed & (1 << 5):
        out |= ((mask << one) & within) | (mask >> last)
    return out


@inlined
def place_before(p, where, axis):
    """The place from which a body step along an axis leads to a place; -1 outside the box."""
    sign = 1 - 2 * (axis & 1)
    x = where % p.places_nx - (sign if axis < 2 else 0)
    y = where // p.places_nx - (0 if axis < 2 else sign)
    if x < 0 or y < 0 or x >= p.places_nx or y >= p.places_ny:
        return -1
    return y * p.places_nx + x


@kernel
def find_beside(p, beside):
    """For each grip and body step that leads here: its number at the place before, or -1; shape (grips, 4)."""
    for where in range(p.places_nx * p.places_ny):
        for i in range(p.n_limbs):
            for u in range(grips(p, where, i)):
                grip = grip_at(p, where, i, u)
                for axis in range(4):
                    other = place_before(p, where, axis)
                    beside[grip, axis] = -1 if other < 0 else grip_of(p, other, i, grip_holds(p)[grip])


@kernel
def push_moves(p, here, mask, masks, moves, seen, n):
    """The places from which a body step leads to a state; returns the queue's length.

    `here`: its place, lap, grips and their count; `moves`: `beside` and `cross` of `sweep_back`; `seen`: see `push`.
    """
    where, lap, members, count = here
    beside, cross = moves
    states = all_states(p)
    for axis in range(4):
        if not p.allowed & (1 << axis):
            continue
        other = place_before(p, where, axis)
        if other < 0:
            continue
        a = beside[grip_at(p, where, members[0, 0], members[0, 1]), axis]
        b = beside[grip_at(p, where, members[1, 0], members[1, 1]), axis]
        if a < 0 or b < 0:
            continue
        angles = mask & masks[grip_at(p, other, members[0, 0], a)] & masks[grip_at(p, other, members[1, 0], b)]
        if count == 3:
            c = beside[grip_at(p, where, members[2, 0], members[2, 1]), axis]
            if c < 0:
                continue
            angles &= masks[grip_at(p, other, members[2, 0], c)]
            state = triple_state(p, other, a, b, c)
        else:
            state = pair_state(p, other, members[0, 0], a, members[1, 0], b)
        if not angles:
            continue
        # a step over the branch cut changes the lap; at either end of the laps kept, all laps beyond count as one
        over = cross[other, axis]
        before = lap - over
        if 0 <= before < p.laps_most:
            n = push(before * states + state, angles, seen, n)
        if over and ((lap == 0 and over < 0) or (lap == p.laps_most - 1 and over > 0)):
            n = push(lap * states + state, angles, seen, n)
    return n


@kernel
def push_limbs(p, here, mask, masks, grabs, seen, n):
    """The states from which a release or a grab leads to a state; returns the queue's length. Arguments as in `push_moves`."""
    where, lap, members, count = here
    layer = lap * all_states(p)
    i = members[0, 0]
    u = members[0, 1]
    j = members[1, 0]
    v = members[1, 1]
    if count == 3:
        if not p.allowed & GRABS:
            return n
        for k in range(3):  # limb k was the one that grabbed: it was free, or held something else
            i = members[(k + 1) % 3, 0]
            j = members[(k + 2) % 3, 0]
            u = members[i, 1]
            v = members[j, 1]
            was = members[k, 1]
            angles = mask & grabs[grip_at(p, where, k, was)]
            if not angles:
                continue
            n = push(layer + pair_state(p, where, i, u, j, v), angles, seen, n)
            for c in range(grips(p, where, k)):
                if c != was and not on_one_hold(p, where, i, u, k, c) and not on_one_hold(p, where, j, v, k, c):
                    members[k, 1] = c
                    state = triple_state(p, where, members[0, 1], members[1, 1], members[2, 1])
                    n = push(layer + state, angles & masks[grip_at(p, where, k, c)], seen, n)
            members[k, 1] = was
        return n
    for k in range(p.n_limbs):
        if k in (i, j):
            continue
        for c in range(grips(p, where, k)):
            angles = mask & masks[grip_at(p, where, k, c)]
            if not angles or on_one_hold(p, where, i, u, k, c) or on_one_hold(p, where, j, v, k, c):
                continue
            if p.n_limbs == 3:
                if p.allowed & RELEASES:
                    members[2, 1] = c  # limb k let go
                    w0 = u if i == 0 else c
                    w1 = u if i == 1 else (v if j == 1 else c)
                    w2 = v if j == 2 else c
                    n = push(layer + triple_state(p, where, w0, w1, w2), angles, seen, n)
            elif p.allowed & GRABS:
                by_i = angles & grabs[grip_at(p, where, i, u)]
                n = push(layer + pair_state(p, where, j, v, k, c), by_i, seen, n)
                by_j = angles & grabs[grip_at(p, where, j, v)]
                n = push(layer + pair_state(p, where, i, u, k, c), by_j, seen, n)
    if p.atomic and p.allowed & GRABS:  # one of two holders may change its hold in one action
        for side in range(2):
            k = i if side == 0 else j
            was = u if side == 0 else v
            angles = mask & grabs[grip_at(p, where, k, was)]
            for c in range(grips(p, where, k)):
                if (
                    angles
                    and c != was
                    and not on_one_hold(p, where, j if side == 0 else i, v if side == 0 else u, k, c)
                ):
                    state = pair_state(p, where, i, c if side == 0 else u, j, v if side == 0 else c)
                    n = push(layer + state, angles & masks[grip_at(p, where, k, c)], seen, n)
    return n


@kernel
def sweep_back(p, angles, moves, place_of, values, sources, scratch, at_layer):
    """One layer of the search that fills `values` with the fewest relaxed actions from every state to the goal states marked in it.

    Args:
        p: Parameters.
        angles: At which each grip holds and can be grabbed.
        moves: Numbers of the grips at the places beside (`find_beside`), and the change of the lap of a body step from each place along
            +x, -x, +y, -y, shape (places, 4).
        place_of: Place of each state.
        values: In: as `mark_goals` left it. Out, after the last layer: fewest actions, UNREACHED where there is no way.
        sources: The marked entries by value (`sort_sources`).
        scratch: What is reached and what is pending, zeros, a word per lap and state; queues, shape (2, laps times states); what the
            present layer reaches, shape (laps times states,); grips, shape (3, 2).
        at_layer: Where the search is, updated: the layer that comes next, whose entries are final after it; entries of its queue; which of
            the two queues it is. Zeros at first.

    Returns:
        Whether there are more layers.
    """
    masks, grabs = angles
    first_of, order = sources
    reached, pending, queues, carried, members = scratch
    states = place_of.shape[0]
    free = p.angles_kept == 1
    layer = at_layer[0]
    n = at_layer[1]
    now = at_layer[2]
    seen, then = (reached, pending, queues[now]), (reached, pending, queues[1 - now])
    if n or layer + 1 < first_of.shape[0]:
        if layer + 1 < first_of.shape[0]:
            for at in range(first_of[layer], first_of[layer + 1]):
                entry = order[at]
                bit = ALL_ANGLES if free else np.uint64(1) << np.uint64(entry % p.angles_kept)
                n = push(entry // p.angles_kept, bit, seen, n)
        if layer + 1 >= UNREACHED:
            return False
        m = 0
        for at in range(n):
            state = queues[now, at]
            where = place_of[state % states]
            count = open_state(p, where, state % states, members)
            mask = pending[state] & ~reached[state]
            if free:
                mask = ALL_ANGLES
            for k in range(count):
                mask &= masks[grip_at(p, where, members[k, 0], members[k, 1])]
            pending[state] = 0
            carried[at] = mask
            reached[state] |= ALL_ANGLES if free else mask
            if free:
                values[state] = layer
            else:
                for angle in range(p.angles):
                    if mask & bit_of(p, angle):
                        values[state * p.angles_kept + angle] = layer
        for at in range(n):
            state = queues[now, at]
            where = place_of[state % states]
            lap = state // states
            count = open_state(p, where, state % states, members)
            mask = carried[at]
            if not free:
                near = spin(p, mask)
                for k in range(count):
                    near &= masks[grip_at(p, where, members[k, 0], members[k, 1])]
                m = push(state, near, then, m)
            here = where, lap, members, count
            m = push_moves(p, here, mask, masks, moves, then, m)
            m = push_limbs(p, here, mask, masks, grabs, then, m)
        at_layer[0] = layer + 1
        at_layer[1] = m
        at_layer[2] = 1 - now
        return True
    return False
