"""A flood over stances as kernels: children of a layer in any number of threads, stances and their costs noted in one order."""

import math

import numpy as np

from ...compiled import inlined, kernel
from ..problem.check import TICKS
from ..problem.codes import MOVE, NONE, pack_code, unpack
from ..problem.family_kernels import aims, burden, candidates, key, restore, spot, step
from ..problem.problems import NOTHING_LIMITS
from ..stance_table import slot_of

STANCES, WEIGHED, POSES = 0, 1, 2
"""Places in the state of a flood: stances seen, stances noted on the map, poses on it."""
COLUMNS = 4
"""Most burdens of a family."""
CHECKS = 16
"""Most checks of a family."""
POSE = np.dtype(
    [
        ("stances", "i8"),  # 0: nobody gets there, but somebody tried
        ("low", "f8", (COLUMNS,)),  # least and most of each burden
        ("high", "f8", (COLUMNS,)),
        ("room", "f8"),  # largest smallest relative margin
        ("depth", "i4"),  # actions of the shortest way
        ("closest", "i4"),  # the check with the smallest relative margin in the stance with the most room; -1: none
        ("forbidden", "i4", (CHECKS,)),  # body moves there that each check forbids
    ],
    align=True,
)
"""What is known of one pose of the body."""


@inlined
def to_lattice(p, words):
    """Turn a pose in ticks into the nearest point of the lattice of steps; the angle stays within a turn."""
    words[0] = (words[0] + TICKS // 2) // TICKS
    words[1] = (words[1] + TICKS // 2) // TICKS
    words[2] = (words[2] + TICKS // 2) // TICKS % (p.turn_ticks // TICKS)


@kernel
def plant(p, start, children):
    """Write the key of the start."""
    key(p, start[0], children[0])


@kernel
def spread(p, keys, table, first, end, codes, stances, margins, children, tries, tally):
    """The children of stances `first` to `end` that were not known when the layer began.

    Args:
        p: A family's parameters, those of a robot that wanders.
        keys: Keys of the stances, shape (capacity, words).
        table: Their hash table; only read.
        first, end: Which stances.
        codes: Scratch for candidates.
        stances: Scratch, two records.
        margins: Scratch of the family's checks.
        children: Output: keys, in the order of parents and actions; one may be there twice. Shape (n, words).
        tries: Output: poses on the lattice that a forbidden body move would have led to, and the check, shape (n, 4).
        tally: Added to: how often each check forbade an action.

    Returns:
        Number of children, of tries, and of actions judged.
    """
    n = 0
    tried = 0
    judged = 0
    for node in range(first, end):
        restore(p, keys[node], stances[0])
        for c in range(candidates(p, stances[0], codes)):
            judged += 1
            reason = step(p, stances[0], codes[c], stances[1], margins)
            if reason < 0:
                key(p, stances[1], children[n])
                if table[slot_of(children[n], table, keys)] < 0:
                    n += 1
                continue
            tally[reason] += 1
            kind, _, _ = unpack(codes[c])
            if kind == MOVE:
                spot(p, stances[1], tries[tried, 4:])
                to_lattice(p, tries[tried, 4:])
                for i in range(3):
                    tries[tried, i] = tries[tried, 4 + i]
                tries[tried, 3] = reason
                tried += 1
    return n, tried, judged


@kernel
def absorb(children, first, n, keys, table, state):
    """Add children that are new; returns how many were looked at before the memory was full."""
    for i in range(first, n):
        slot = slot_of(children[i], table, keys)
        if table[slot] >= 0:
            continue
        node = state[STANCES]
        if node >= keys.shape[0]:
            return i
        for w in range(keys.shape[1]):
            keys[node, w] = children[i, w]
        table[slot] = node
        state[STANCES] = node + 1
    return n


@kernel
def weigh(p, keys, first, end, hard, sizes, stances, margins, spare, spots, burdens, room, closest, aimed):
    """Judge stances `first` to `end` as they stand: where they are, what they cost, which check is the nearest to failing.

    Args:
        p, keys, first, end: As in `spread`.
        hard: Whether each check forbids, shape (n_checks,).
        sizes: What each margin is a share of, 0 for none, shape (n_checks,).
        stances: Scratch, three records.
        margins, spare: Scratch of the family's checks.
        spots: Output: pose on the lattice, then holds, shape (n, words).
        burdens: Output: the family's burdens, shape (n, burdens).
        room: Output: smallest margin of a hard check as a share of its size, at most 1, shape (n,).
        closest: Output: that check, -1 for none, shape (n,).
        aimed: Output: whether the stance is where each goal asks for, shape (n, goals).
    """
    still = pack_code(NONE, 0, 0)
    for node in range(first, end):
        at = node - first
        restore(p, keys[node], stances[0])
        step(p, stances[0], still, stances[1], margins)
        spot(p, stances[1], spots[at])
        to_lattice(p, spots[at])
        for k in range(aimed.shape[1]):
            aimed[at, k] = aims(p, stances[1], k)
        least = 1.0
        check = -1
        for i in range(sizes.shape[0]):
            if hard[i] and sizes[i] > 0.0 and abs(margins[i]) < NOTHING_LIMITS:
                share = min(margins[i] / sizes[i], 1.0)
                if check < 0 or share < least:
                    least = share
                    check = i
        room[at] = least
        closest[at] = check
        burden(p, stances[1], stances[2], spare, burdens[at])


@inlined
def pose_of(words, pose_keys, poses, table, state):
    """Number of a pose, a new one if it is not known."""
    slot = slot_of(words, table, pose_keys)
    if table[slot] < 0:
        number = state[POSES]
        state[POSES] = number + 1
        table[slot] = number
        for i in range(3):
            pose_keys[number, i] = words[i]
        poses[number].stances = 0
        for i in range(COLUMNS):
            poses[number].low[i] = math.inf
            poses[number].high[i] = -math.inf
        poses[number].room = -math.inf
        poses[number].depth = -1
        poses[number].closest = -1
        for i in range(CHECKS):
            poses[number].forbidden[i] = 0
    return table[slot]


@kernel
def note(
    spots, burdens, room, closest, aimed, n, depth, pose_keys, poses, table, used, first_used, met, first_met, state
):
    """Note n weighed stances on the map: what is least and most at each pose, who uses which hold, which goals are met.

    Args:
        spots, burdens, room, closest, aimed: As `weigh` wrote them.
        n: How many.
        depth: Actions of the shortest way to them.
        pose_keys, poses, table: The map, with room for n more poses.
        used, first_used: Stances with limb i on hold h, and the depth of the first, shape (limbs, holds).
        met, first_met: The same for goals, shape (goals,).
        state: See above.
    """
    for at in range(n):
        number = pose_of(spots[at, :3], pose_keys, poses, table, state)
        pose = poses[number]
        if pose.stances == 0:
            pose.depth = depth
        pose.stances += 1
        for i in range(burdens.shape[1]):
            if burdens[at, i] < pose.low[i]:
                pose.low[i] = burdens[at, i]
            if burdens[at, i] > pose.high[i]:
                pose.high[i] = burdens[at, i]
        if room[at] > pose.room:
            pose.room = room[at]
            pose.closest = closest[at]
        for i in range(used.shape[0]):
            hold = spots[at, 3 + i]
            if hold >= 0:
                if used[i, hold] == 0:
                    first_used[i, hold] = depth
                used[i, hold] += 1
        for k in range(aimed.shape[1]):
            if aimed[at, k]:
                if met[k] == 0:
                    first_met[k] = depth
                met[k] += 1
    state[WEIGHED] += n


@kernel
def note_tries(tries, n, pose_keys, poses, table, state):
    """Note n poses that a check kept the body from."""
    for i in range(n):
        number = pose_of(tries[i, :3], pose_keys, poses, table, state)
        poses[number].forbidden[tries[i, 3]] += 1
