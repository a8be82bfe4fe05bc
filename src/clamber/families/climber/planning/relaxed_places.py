"""The relaxed problem of a limbed climber: which limb can hold what at each place and angle of the lattice, and how states are numbered.

Forces are left out; what stays is reach, joint limits, clearance and who holds what. A *grip* is a limb on a hold. At each place the
relaxed states are the pairs of grips of different limbs and, for a robot of three limbs, the triples. A robot of three limbs has nothing
else, so its releases count; with more limbs a pair says nothing of the others, which may hold or not.
"""

import math

import numpy as np

from ....compiled import carray, inlined, kernel, pointer
from ....planning.problem.check import TICKS, TOLERANCE
from ..statics.near import cells_about, cells_in_row, nearest_hold
from ..statics.pose import place, solve
from ..statics.records import cells, holds, limbs
from ..statics.stance import CLEARANCE, JOINT, REACH

SECTORS = 64
"""Angles are told apart as bits of one word; of finer angles several share a bit, and then rotation is free."""
ALL_ANGLES = np.uint64(0xFFFFFFFFFFFFFFFF)
UNREACHED = 65535
"""Entry of `left` from which no goal can be reached."""


@inlined
def grip_starts(p):
    """Where the grips of each place and limb start in `grip_holds`, and the end."""
    return carray(pointer(p.grip_starts_at), p.places_nx * p.places_ny * p.n_limbs + 1, np.int32)


@inlined
def grip_holds(p):
    """Hold of each grip, ascending per place and limb."""
    return carray(pointer(p.grip_holds_at), p.n_grip_holds, np.int32)


@inlined
def state_base(p):
    """First relaxed state of each block of each place, and the end."""
    return carray(pointer(p.state_base_at), p.n_state_base, np.int64)


@inlined
def left(p):
    """Fewest actions to the goal: per stage, per lap, per state, per angle (one entry where rotation is free)."""
    return carray(pointer(p.left_at), p.n_left, np.uint16)


@inlined
def grips(p, where, i):
    """Number of grips of limb i at a place."""
    at = where * p.n_limbs + i
    return grip_starts(p)[at + 1] - grip_starts(p)[at]


@inlined
def grip_of(p, where, i, hold):
    """Number of the grip of limb i on a hold among those at a place, or -1."""
    at = where * p.n_limbs + i
    for g in range(grip_starts(p)[at], grip_starts(p)[at + 1]):
        if grip_holds(p)[g] == hold:
            return g - grip_starts(p)[at]
    return -1


@inlined
def pair_number(p, i, j):
    """Number of the pair of limbs i < j."""
    return i * (2 * p.n_limbs - i - 1) // 2 + j - i - 1


@inlined
def block_base(p, where, block):
    """First state of a block of a place: the pairs of two limbs (`pair_number`), or the triples, which come last."""
    blocks = p.n_limbs * (p.n_limbs - 1) // 2 + 1
    return state_base(p)[where * blocks + block]


@inlined
def all_states(p):
    """Number of states."""
    return state_base(p)[p.n_state_base - 1]


@inlined
def pair_state(p, where, i, u, j, v):
    """Number of the pair of grip u of limb i and grip v of limb j."""
    if i > j:
        i, u, j, v = j, v, i, u
    return block_base(p, where, pair_number(p, i, j)) + u * grips(p, where, j) + v


@inlined
def triple_state(p, where, u, v, w):
    """Number of the triple of a three-limbed robot's grips."""
    return block_base(p, where, 3) + (u * grips(p, where, 1) + v) * grips(p, where, 2) + w


@inlined
def grip_at(p, where, i, u):
    """Place of a grip in the arrays."""
    return grip_starts(p)[where * p.n_limbs + i] + u


@inlined
def open_state(p, where, state, members):
    """The limbs and grips of a state of a place: `members` gets (limb, grip) in the order of the limbs; returns their number."""
    block = 0
    for i in range(p.n_limbs):
        for j in range(i + 1, p.n_limbs):
            block += 1
            if state < block_base(p, where, block):
                local = state - block_base(p, where, block - 1)
                members[0, 0] = i
                members[0, 1] = local // grips(p, where, j)
                members[1, 0] = j
                members[1, 1] = local % grips(p, where, j)
                return 2
    local = state - block_base(p, where, block)
    for i in range(2, -1, -1):
        members[i, 0] = i
        members[i, 1] = local % grips(p, where, i)
        local //= grips(p, where, i)
    return 3


@inlined
def on_one_hold(p, where, i, u, j, v):
    """Whether two grips that may not be used together are of one hold."""
    return not p.shares and grip_holds(p)[grip_at(p, where, i, u)] == grip_holds(p)[grip_at(p, where, j, v)]


@kernel
def number_states(p, base, most):
    """Fill `state_base`; returns the number of states, or -1 if they are more than `most`."""
    n = 0
    at = 0
    for where in range(p.places_nx * p.places_ny):
        for i in range(p.n_limbs):
            for j in range(i + 1, p.n_limbs):
                base[at] = n
                at += 1
                n += grips(p, where, i) * grips(p, where, j)
        base[at] = n
        at += 1
        if p.n_limbs == 3:
            n += grips(p, where, 0) * grips(p, where, 1) * grips(p, where, 2)
        if n > most:
            return -1
    base[at] = n
    return n


@inlined
def put(p, s, where, angle):
    """Pose a scratch stance at a place and an angle of the lattice."""
    s.ix = (p.places_x + where % p.places_nx) * TICKS
    s.iy = (p.places_y + where // p.places_nx) * TICKS
    s.ia = angle * TICKS
    place(p, s)


@inlined
def can_hold(p, s, i):
    """Whether limb i can stay on its hold, by the hard checks `reach` and `joint`."""
    solve(p, s, i)
    limit = limbs(p)[i].length - max(p.holding_offset, p.reach_offset if p.offset_while_holding else 0.0)
    if p.hard & (1 << REACH) and limit - s.solved[i, 0] < -TOLERANCE:
        return False
    return not p.hard & (1 << JOINT) or max(s.solved[i, 1], s.solved[i, 6]) >= -TOLERANCE


@kernel
def find_grips(p, s, places, n, starts, listed):
    """List the grips of some places, with the angles at which they can be held and grabbed, behind those of the places before.

    Args:
        p: Parameters with the box of places.
        s: Scratch, one stance.
        places: The first place and the one after the last; all before them are listed.
        n: Number of grips listed before.
        starts: Output, see `grip_starts`.
        listed: Output, the holds, as many as there is room for, and bit sets of the angles that hold and that grab, shape (room,) each.

    Returns:
        Number of grips listed by now, or -1 if there is no room.
    """
    first_place, end_place = places
    found, hold_masks, grab_masks = listed
    for where in range(first_place, end_place):
        put(p, s, where, 0)
        clear = not p.hard & (1 << CLEARANCE) or nearest_hold(p, s.x, s.y) - p.clearance >= -TOLERANCE
        for i in range(p.n_limbs):
            starts[where * p.n_limbs + i] = n
            if not clear:
                continue
            limb = limbs(p)[i]
            sight = limb.length + math.hypot(limb.port_x, limb.port_y) + 1e-6
            x0, x1, y0, y1 = cells_about(p, s.x, s.y, sight)
            for row in range(y0, y1 + 1):
                first, end = cells_in_row(p, row, x0, x1)
                for at in range(first, end):
                    h = cells(p)[at]
                    if math.hypot(holds(p)[h].x - s.x, holds(p)[h].y - s.y) > sight:
                        continue
                    if n >= found.shape[0]:
                        return -1
                    hold_masks[n], grab_masks[n] = masks_of(p, s, where, i, h)
                    if hold_masks[n]:
                        found[n] = h
                        n += 1
    starts[end_place * p.n_limbs] = n
    return n


@inlined
def bit_of(p, angle):
    """The bit that stands for an angle of the lattice."""
    return np.uint64(1) << np.uint64(angle if p.angles <= SECTORS else angle * SECTORS // p.angles)


@inlined
def masks_of(p, s, where, i, h):
    """Angles at which limb i can hold, and grab, hold h from a place: two bit sets."""
    hold_mask = np.uint64(0)
    grab_mask = np.uint64(0)
    s.hold[i] = h
    for angle in range(p.angles):
        put(p, s, where, angle)
        if can_hold(p, s, i):
            hold_mask |= bit_of(p, angle)
            near = limbs(p)[i].length - p.reach_offset - s.solved[i, 0] >= -TOLERANCE
            if near and (holds(p)[h].limbs >> i) & 1:
                grab_mask |= bit_of(p, angle)
    s.hold[i] = -1
    return hold_mask, grab_mask


@kernel
def actions_left(p, s, where, angle, lap):
    """The relaxed problem's fewest actions from a stance at a place of the lattice; infinity if no goal can be reached.

    The least over the states that the stance is one of: with three limbs its own state alone, with more the best pair of holders.
    """
    layer = (s.stage * p.laps_most + lap) * all_states(p)
    best = UNREACHED
    holders = 0
    for i in range(p.n_limbs):
        if s.hold[i] >= 0:
            holders += 1
            if grip_of(p, where, i, s.hold[i]) < 0:
                return math.inf
    if holders == 3 and p.n_limbs == 3:
        u = grip_of(p, where, 0, s.hold[0])
        v = grip_of(p, where, 1, s.hold[1])
        w = grip_of(p, where, 2, s.hold[2])
        best = left(p)[(layer + triple_state(p, where, u, v, w)) * p.angles_kept + angle]
    else:
        for i in range(p.n_limbs):
            for j in range(i + 1, p.n_limbs):
                if s.hold[i] >= 0 and s.hold[j] >= 0:
                    u = grip_of(p, where, i, s.hold[i])
                    v = grip_of(p, where, j, s.hold[j])
                    state = pair_state(p, where, i, u, j, v)
                    best = min(best, left(p)[(layer + state) * p.angles_kept + angle])
    return math.inf if best == UNREACHED else float(best)
