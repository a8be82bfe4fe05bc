"""What actions do to a shuttle: a body on a line of rungs with two feet, each on a rung or lifted."""

import math

import numpy as np

from clamber.compiled import carray, inlined, kernel, pointer
from clamber.planning.problem.check import TICKS, TOLERANCE, UNLIMITED
from clamber.planning.problem.codes import HOLD, MOVE, RELEASE, pack_code, unpack
from clamber.planning.problem.family_kernels import family_kernels

REACH, SUPPORT = 0, 1
PARAMS = np.dtype([
    ("step", "f8"), ("reach", "f8"), ("origin", "f8"), ("base", "f8"), ("hard", "i4"), ("n_goals", "i4"), ("n_limbs", "i4"),
    ("kinds", "i4", (8,)),
    ("goals_at", "i8"), ("rungs_at", "i8"), ("n_rungs", "i8"),
], align=True)  # fmt: skip
GOAL = np.dtype([("x_min", "f8"), ("x_max", "f8")], align=True)
STANCE = np.dtype([
    ("ticks", "i8"), ("hold", "i4", (2,)), ("stage", "i4"), ("count", "i4"), ("x", "f8"), ("y", "f8"),
], align=True)  # fmt: skip


@inlined
def rungs(p):
    """Places of the rungs [m], shape (n_rungs,)."""
    return carray(pointer(p.rungs_at), p.n_rungs, np.float64)


@inlined
def goals(p):
    """Goals in order."""
    return carray(pointer(p.goals_at), p.n_goals, GOAL)


@inlined
def copy(s, t):
    """Copy a stance."""
    t.ticks, t.stage, t.count, t.x, t.y = s.ticks, s.stage, s.count, s.x, s.y
    for f in range(2):
        t.hold[f] = s.hold[f]


@inlined
def meets(s, goal):
    """Whether the body is where a goal asks for."""
    return goal.x_min - 1e-9 <= s.x <= goal.x_max + 1e-9


@inlined
def missing(s, goal):
    """How far the body is from a goal [m]."""
    return max(0.0, goal.x_min - s.x, s.x - goal.x_max)


@kernel
def step(p, before, code, after, margins):
    """Carry out one action and judge where it leads; a foot steps only while the other stands, and takes a rung only when it is lifted."""
    copy(before, after)
    after.count = before.count + 1
    kind, foot, argument = unpack(code)
    margins[SUPPORT] = 0.0
    if kind == MOVE:
        after.ticks += 1 - 2 * (argument & 1)
    if kind in (RELEASE, HOLD):
        unready = kind == HOLD and after.hold[foot] >= 0
        margins[SUPPORT] = -1.0 if after.hold[1 - foot] < 0 or unready else 0.0
        after.hold[foot] = argument if kind == HOLD else -1
    after.x = p.origin + p.step * after.ticks
    margins[REACH] = UNLIMITED
    for f in range(2):
        if after.hold[f] >= 0:
            margins[REACH] = min(margins[REACH], p.reach - abs(rungs(p)[after.hold[f]] - after.x))
    for check in range(2):
        if p.hard >> check & 1 and margins[check] < -TOLERANCE:
            return check
    while after.stage < p.n_goals and meets(after, goals(p)[after.stage]):
        after.stage += 1
    return -1


@kernel
def candidates(p, s, codes):
    """Two moves, and for each foot: lift it, or put it on each rung."""
    n = 0
    for axis in range(2):
        codes[n] = pack_code(MOVE, 0, axis)
        n += 1
    for f in range(2):
        if s.hold[f] >= 0:
            codes[n] = pack_code(RELEASE, f, 0)
            n += 1
            continue
        for rung in range(p.n_rungs):
            codes[n] = pack_code(HOLD, f, rung)
            n += 1
    return n


@kernel
def key(p, s, words):
    """Place, feet and stage."""
    words[0], words[1], words[2] = s.ticks * TICKS, 0, 0
    words[3] = (s.hold[0] + 1) | (s.hold[1] + 1) << 16 | s.stage << 32


@kernel
def restore(p, words, s):
    """The stance of a key."""
    s.ticks = words[0] // TICKS
    s.hold[0] = (words[3] & 0xFFFF) - 1
    s.hold[1] = (words[3] >> 16 & 0xFFFF) - 1
    s.stage = words[3] >> 32
    s.x = p.origin + p.step * s.ticks


@kernel
def measure(p, s, row):
    """Progress of body and feet [m], one action, goals met, length; nothing is unstable or strained."""
    goal = goals(p)[min(s.stage, p.n_goals - 1)]
    row[0] = p.base - missing(s, goal)
    row[1] = row[0]
    row[2] = row[4] = 1.0
    row[3] = s.stage
    row[5] = row[6] = 0.0


@kernel
def bound(p, s):
    """Moves that the body needs at least."""
    return 0.0 if s.stage >= p.n_goals else math.ceil(missing(s, goals(p)[s.stage]) / p.step - 1e-6)


@kernel
def heuristic_between(p, s, t):
    """Moves between two places."""
    return float(abs(t.ticks - s.ticks))


@kernel
def done(p, s):
    """Whether every goal has been met."""
    return s.stage >= p.n_goals


@kernel
def cell(p, s):
    """Its place, for niching."""
    return s.stage * 1000003 + s.ticks


@kernel
def body_pose(p, s, words):
    """Its place and feet."""
    words[0], words[1] = s.ticks * TICKS, 0
    for f in range(2):
        words[2 + f] = s.hold[f]


@kernel
def satisfies_goal(p, s, k):
    """Whether it is where goal k asks for."""
    return meets(s, goals(p)[k])


family_kernels(
    PARAMS, step=step, candidates=candidates, key=key, restore=restore, measure=measure, bound=bound, heuristic_between=heuristic_between,
    done=done, cell=cell, body_pose=body_pose, satisfies_goal=satisfies_goal,
)  # fmt: skip
