"""A flood over stances as kernels: children of a layer in any number of threads, stances and their costs noted in one order."""

import math
from typing import NamedTuple

import numpy as np

from ...compiled import inlined, kernel
from ...types import Floats, Ints, Records
from ..problem.check import TICKS
from ..problem.codes import MOVE, NONE, pack_code, unpack
from ..problem.family_kernels import body_pose, candidates, key, restore, satisfies_goal, stance_cost, step
from ..problem.problems import NOTHING_LIMITS
from ..stance_table import slot_of

STANCES, WEIGHED, POSES = 0, 1, 2
"""Places in the state of an exploration: stances seen, stances noted on the map, poses on it."""
COLUMNS = 4
"""Most `stance_cost`s of a family."""
CHECKS = 16
"""Most checks of a family."""
POSE = np.dtype(
    [
        ("stances", "i8"),  # 0: nobody gets there, but somebody tried
        ("low", "f8", (COLUMNS,)),  # least and most of each stance_cost
        ("high", "f8", (COLUMNS,)),
        ("room", "f8"),  # largest smallest relative margin
        ("depth", "i4"),  # actions of the shortest way
        ("closest", "i4"),  # the check with the smallest relative margin in the stance with the most room; -1: none
        ("forbidden", "i4", (CHECKS,)),  # body moves there that each check forbids
    ],
    align=True,
)
"""What is known of one pose of the body."""
Long = np.ndarray[tuple[int, ...], np.dtype[np.int64]]


class Scratch(NamedTuple):
    """Arrays that kernels write over."""

    codes: Ints
    """For candidates."""
    stances: Records
    """Three records."""
    margins: Floats
    spare: Floats
    """Of the family's checks, like `margins`."""


class Children(NamedTuple):
    """What the stances of a piece lead to."""

    keys: Long
    """In the order of parents and actions; one may be there twice, shape (n, words)."""
    tries: Long
    """Poses on the lattice that a forbidden body move would have led to, and the check, shape (n, axes + 1); scratch behind."""
    tally: Long
    """How often each check forbade an action; added to."""


class Sizes(NamedTuple):
    """What poses and margins are measured by."""

    period: Ints
    """Steps of a turn about each axis of the body's pose, 0 for none, shape (axes,)."""
    hard: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]
    """Whether each check forbids, shape (n_checks,)."""
    margins: Floats
    """What each margin is a share of, 0 for none, shape (n_checks,)."""


class Judged(NamedTuple):
    """Stances as they stand."""

    poses: Long
    """Pose on the lattice, then holds, shape (n, words)."""
    costs: Floats
    """What the family's kernel `stance_cost` writes, shape (n, costs)."""
    room: Floats
    """Smallest margin of a hard check as a share of its size, at most 1, shape (n,)."""
    closest: Ints
    """That check, -1 for none, shape (n,)."""
    aimed: np.ndarray[tuple[int, ...], np.dtype[np.uint8]]
    """Whether the stance is where each goal asks for, shape (n, goals)."""


class PoseMap(NamedTuple):
    """The poses seen, with room for those of a piece, and who uses which hold and goal."""

    keys: Long
    """Poses on the lattice, shape (capacity, axes)."""
    rows: Records
    """Records of `POSE`."""
    table: Ints
    """Hash table of the poses."""
    used: Long
    """Stances with limb i on hold h, shape (limbs, holds)."""
    first_used: Long
    """Depth of the first of them."""
    met: Long
    """Stances that meet each goal, shape (goals,)."""
    first_met: Long


@inlined
def to_lattice(words, period):
    """Turn a pose in ticks into the nearest point of the lattice of steps; axes with a period, of angles, stay within it."""
    for i in range(period.shape[0]):
        words[i] = (words[i] + TICKS // 2) // TICKS
        if period[i] > 0:
            words[i] %= period[i]


@kernel
def plant(p, start, children):
    """Write the key of the start."""
    key(p, start[0], children[0])


@kernel
def spread(p, known, first, end, period, scratch, out):
    """The children of stances `first` to `end` that were not known when the layer began.

    Args:
        p: A family's parameters, those of a robot without goals.
        known: Keys of the stances, shape (capacity, words), and their hash table; only read.
        first, end: Which stances.
        period: As in `Sizes`.
        scratch: Scratch.
        out: `Children`.

    Returns:
        Number of children, of tries, and of actions judged.
    """
    keys, table = known
    codes, stances, margins, _ = scratch
    children, tries, tally = out
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
                body_pose(p, stances[1], tries[tried])
                to_lattice(tries[tried], period)
                tries[tried, period.shape[0]] = reason
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
def weigh(p, keys, first, end, sizes, scratch, out):
    """Judge stances `first` to `end` as they stand: where they are, what they cost, which check is the nearest to failing.

    Args:
        p, keys, first, end: As in `spread`.
        sizes: `Sizes`.
        scratch: Scratch.
        out: `Judged`.
    """
    _, stances, margins, spare = scratch
    still = pack_code(NONE, 0, 0)
    for node in range(first, end):
        at = node - first
        restore(p, keys[node], stances[0])
        step(p, stances[0], still, stances[1], margins)
        body_pose(p, stances[1], out.poses[at])
        to_lattice(out.poses[at], sizes.period)
        for k in range(out.aimed.shape[1]):
            out.aimed[at, k] = satisfies_goal(p, stances[1], k)
        least = 1.0
        check = -1
        for i in range(sizes.margins.shape[0]):
            if sizes.hard[i] and sizes.margins[i] > 0.0 and abs(margins[i]) < NOTHING_LIMITS:
                share = min(margins[i] / sizes.margins[i], 1.0)
                if check < 0 or share < least:
                    least = share
                    check = i
        out.room[at] = least
        out.closest[at] = check
        stance_cost(p, stances[1], stances[2], spare, out.costs[at])


@inlined
def pose_of(words, seen, state):
    """Number of a pose, a new one if it is not known."""
    slot = slot_of(words, seen.table, seen.keys)
    if seen.table[slot] < 0:
        number = state[POSES]
        state[POSES] = number + 1
        seen.table[slot] = number
        for i in range(seen.keys.shape[1]):
            seen.keys[number, i] = words[i]
        poses = seen.rows
        poses[number].stances = 0
        for i in range(COLUMNS):
            poses[number].low[i] = math.inf
            poses[number].high[i] = -math.inf
        poses[number].room = -math.inf
        poses[number].depth = -1
        poses[number].closest = -1
        for i in range(CHECKS):
            poses[number].forbidden[i] = 0
    return seen.table[slot]


@kernel
def note(judged, n, depth, seen, state):
    """Note n judged stances on the map: what is least and most at each pose, who uses which hold, which goals are met.

    Args:
        judged: `Judged`.
        n: How many.
        depth: Actions of the shortest way to them.
        seen: `PoseMap`, with room for n more poses.
        state: See above.
    """
    axes = seen.keys.shape[1]
    for at in range(n):
        pose = seen.rows[pose_of(judged.poses[at, :axes], seen, state)]
        if pose.stances == 0:
            pose.depth = depth
        pose.stances += 1
        for i in range(judged.costs.shape[1]):
            if judged.costs[at, i] < pose.low[i]:
                pose.low[i] = judged.costs[at, i]
            if judged.costs[at, i] > pose.high[i]:
                pose.high[i] = judged.costs[at, i]
        if judged.room[at] > pose.room:
            pose.room = judged.room[at]
            pose.closest = judged.closest[at]
        for i in range(seen.used.shape[0]):
            hold = judged.poses[at, axes + i]
            if hold >= 0:
                if seen.used[i, hold] == 0:
                    seen.first_used[i, hold] = depth
                seen.used[i, hold] += 1
        for k in range(judged.aimed.shape[1]):
            if judged.aimed[at, k]:
                if seen.met[k] == 0:
                    seen.first_met[k] = depth
                seen.met[k] += 1
    state[WEIGHED] += n


@kernel
def note_tries(tries, n, seen, state):
    """Note n poses that a check kept the body from."""
    axes = seen.keys.shape[1]
    for i in range(n):
        number = pose_of(tries[i, :axes], seen, state)
        seen.rows[number].forbidden[tries[i, axes]] += 1
