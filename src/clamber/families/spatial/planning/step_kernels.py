"""What actions do to a robot in space, and what each needs: moves of the body on its lattice, and limbs from hold to hold.

A limb that takes another hold is judged four times: without it where it was, along its lifted path, without it where it goes, and with it.
"""

import math

import numpy as np

from ....compiled import carray, inlined, kernel, pointer
from ....planning.problem.check import UNLIMITED
from ....planning.problem.codes import HOLD, MOVE, NEAREST, pack_code, unpack
from ..statics.records import LIMBS
from ..statics.seeds_kernels import scores, seed_index
from ..statics.stance_kernels import aim_limb
from .checks import SWING
from .judging_kernels import SCRATCH, copy, judge_stance, judge_taken, scratch_of
from .passing_kernels import judge_move, judge_swing
from .poses_kernels import (
    away_from,
    body_of,
    goals_of,
    holds_of,
    meets,
    place_body,
    robot_of,
    rules_of,
    seeds_of,
    work_of,
)
from .records import AXES, HEIGHT, PITCH, ROLL, YAW

NEAR = 2 * AXES
"""Moves of one step: along, across, height, yaw, pitch, roll, each forward, then back."""
MOVES = NEAR + 4
"""And the far ones: along and across."""
LEAST = 32
"""Where in the scratch the least margins of an action stand."""
RANKED = 64
"""Where in it the scores of a limb's nearest holds stand, and behind them their codes."""
BEHIND = 3.0
"""How much a limb's choice of holds counts a length of its own towards the goal, beside a posture's distance from the nominal one."""
NOWHERE = -1.0
"""Margin of an action that the lattice has not."""
assert RANKED + 64 + 32 <= SCRATCH


@inlined
def merge_margins(margins, least):
    """Take the smaller of two rows of margins, into `least`; what was not looked at stays out."""
    for k in range(SWING):
        if not least[k] <= margins[k]:
            least[k] = margins[k]


@kernel
def holds_near(p, s, limb, codes, ranked):
    """Write the actions that put a limb on each of the holds that suit it best, the best first; returns their number.

    Best is what has a posture near the nominal one and lies towards the goal; `ranked` is scratch as long as the number of holds to list.
    """
    robot, holds = robot_of(p), holds_of(p)
    seeds = seeds_of(p)
    goal = goals_of(p)[min(s.stage, p.n_goals - 1)]
    most, n = ranked.shape[0], 0
    body = body_of(p)
    work = work_of(p)
    for k in range(9):
        body.rotation[k] = s.turn[k]
    for k in range(3):
        body.place[k] = s.place[k]
    for h in range(p.n_holds):
        hold = holds[h]
        x = hold.place[0] - s.place[0]
        y = hold.place[1] - s.place[1]
        z = hold.place[2] - s.place[2]
        if x * x + y * y + z * z > p.reach * p.reach:
            continue
        taken = False
        for i in range(p.n_limbs):
            taken = taken or s.hold[i] == h
        if taken:
            continue
        aim_limb(body, hold.place, hold.normal, limb, work)
        index = seed_index(robot, seeds, limb, work)
        if index < 0:
            continue
        score = scores(seeds)[index] + BEHIND * away_from(hold.along, hold.across, goal) / robot.size
        at = n if n < most else most - 1
        if n == most and score >= ranked[at]:
            continue
        while at > 0 and ranked[at - 1] > score:
            ranked[at] = ranked[at - 1]
            codes[at] = codes[at - 1]
            at -= 1
        ranked[at] = score
        codes[at] = pack_code(HOLD, limb, h)
        n = min(most, n + 1)
    return n


@kernel
def take_hold(p, before, limb, after, margins):
    """Judge a limb that swings from its hold to another: without it, along its path, without it where it goes, and with it."""
    if not rules_of(p).exact:
        return judge_taken(p, before, after, limb, margins)
    least = scratch_of(p)[LEAST : LEAST + SWING + 1]
    for k in range(SWING + 1):
        least[k] = math.nan
    hold = after.hold[limb]
    after.hold[limb] = before.hold[limb]
    broken = judge_stance(p, before, after, limb, -1, margins)
    after.hold[limb] = hold
    merge_margins(margins, least)
    if broken < 0:
        broken = judge_swing(p, before, limb, hold, margins)
        merge_margins(margins, least)
        least[SWING] = margins[SWING]
    if broken < 0:
        broken = judge_stance(p, before, after, limb, limb, margins)
        merge_margins(margins, least)
    if broken < 0:
        broken = judge_stance(p, before, after, -1, limb, margins)
        merge_margins(margins, least)
    if broken < 0:
        for k in range(SWING + 1):
            margins[k] = least[k]
    return broken


@kernel
def shift(p, argument, pose):
    """Carry out a move of the body on a pose; False where the lattice has no such pose."""
    axis = (argument % NEAR) >> 1
    pose[axis] += (1 - 2 * (argument & 1)) * (1 if argument < NEAR else p.far)
    if axis == YAW:
        pose[YAW] = pose[YAW] % p.turns
    most = UNLIMITED
    if axis == HEIGHT:
        most = p.heights
    elif axis in (PITCH, ROLL):
        most = p.tilts if p.tilt > 0.0 else 0
    return abs(pose[axis]) <= most


@kernel
def draft(p, before, code, after):
    """Write what an action leads to, but for posture, forces and share, which judging tells: 1, or -1 if there is no such action."""
    copy(before, after)
    after.count = before.count + 1
    kind, limb, argument = unpack(code)
    if kind == MOVE:
        if not shift(p, argument, after.pose):
            return -1
        place_body(p, after, scratch_of(p))
    elif kind in (HOLD, NEAREST):
        hold = argument
        if kind == NEAREST:
            ranked = scratch_of(p)[RANKED : RANKED + p.nearest]
            codes = carray(pointer(p.work_at + 8 * (RANKED + 64)), 64, np.int32)
            if argument >= holds_near(p, before, limb, codes, ranked):
                return -1
            _, _, hold = unpack(codes[argument])
        for i in range(p.n_limbs):
            if before.hold[i] == hold:
                return -1
        after.hold[limb] = hold
    while after.stage < p.n_goals and meets(p, after, goals_of(p)[after.stage]):
        after.stage += 1
    return 1


@kernel
def step(p, before, code, after, margins):
    """Carry out one action and judge it."""
    for k in range(margins.shape[0]):
        margins[k] = math.nan
    if draft(p, before, code, after) < 0:
        margins[0] = NOWHERE
        return 0
    kind, limb, _ = unpack(code)
    if kind in (HOLD, NEAREST):
        broken = take_hold(p, before, limb, after, margins)
    else:
        broken = judge_stance(p, before, after, -1, -1, margins)
        if broken < 0:
            broken = judge_move(p, before, after, margins)
    if broken >= 0:
        after.stage = before.stage
    return broken


@kernel
def set_pose(p, stance):
    """Write the pose of a stance (array of one record) from its steps."""
    place_body(p, stance[0], scratch_of(p))


@kernel
def first_stance(p, stance, height, holds, margins):
    """Write the start on some holds, steps of height above that of the task, and judge it; the first violated hard check, or -1."""
    s = stance[0]
    for k in range(AXES):
        s.pose[k] = 0
    s.pose[HEIGHT] = height
    s.stage, s.count, s.postured = 0, 0, 0
    for i in range(LIMBS):
        s.hold[i] = holds[i] if i < p.n_limbs else -1
    place_body(p, s, scratch_of(p))
    margins[SWING] = UNLIMITED
    broken = judge_stance(p, s, s, -1, -1, margins)
    while broken < 0 and s.stage < p.n_goals and meets(p, s, goals_of(p)[s.stage]):
        s.stage += 1
    return broken
