"""A limbed climber's stances as search sees them: keys and back, what can be done next, and a bound on what is left."""

import math

import numpy as np

from ....compiled import kernel
from ....planning.problem.check import TICKS, TOLERANCE
from ....planning.problem.codes import HOLD, MOVE, RELEASE, pack_code
from ..statics.elbows import EVERY, words_of
from ..statics.near import cells_about, cells_in_row
from ..statics.pose import count_holders, held, place, port_of, solve
from ..statics.records import cells, goals, holds, limbs
from ..statics.stance import HANGS
from .relaxed_places import actions_left

KEY_WORDS = 10
"""Integers of a key, see `key_length`."""
RELEASES, GRABS, ANY_HOLD = 1 << 6, 1 << 7, 1 << 8
"""Bits of `allowed`: beside the six moves, releases, grabs of holds that no limb holds, grabs of those that one holds."""
FOOT_SCALE = float(1 << 40)
"""Free feet are kept in a key to 2^-40 m."""


def key_length(limbs: int, kept: bool, reads_feet: bool) -> int:
    """Integers of a key: more for kept elbows of seven or eight limbs, and three more per limb where checks of interference are hard."""
    return KEY_WORDS + (max(1, (1 << limbs) // 64) - 1 if kept else 0) + (3 * limbs if reads_feet else 0)


@kernel
def cell(p, s):
    """A coarse place in the search space for niching: stage, contacts and x to a third of a metre, as one number."""
    value = s.stage
    for i in range(p.n_limbs):
        value = value * 1000003 + (s.hold[i] + 1)
    return value * 1000003 + int(math.floor(s.x / 0.3))


@kernel
def key(p, s, words):
    """Everything that the hard checks and actions read of a stance, as integers: equal keys have equal futures."""
    n = p.n_limbs
    words[0] = s.ix
    words[1] = s.iy
    words[2] = s.ia
    holders, _ = count_holders(p, s)
    for w in range(4):
        low = s.hold[2 * w] if 2 * w < n else -1
        high = s.hold[2 * w + 1] if 2 * w + 1 < n else -1
        words[3 + w] = ((high + 1) << 32) | (low + 1)
    idle = s.in_use + 1 if p.idle and holders >= 3 and s.in_use >= 0 and s.hold[s.in_use] >= 0 else 0
    hangs = s.hangs if p.max_hangs >= 0 else 0
    words[7] = idle | hangs << 8 | s.stage << 32
    words[8] = s.elbows[0] if p.kept else 0
    words[9] = s.laps
    at = KEY_WORDS
    if p.kept:
        for w in range(1, words_of(n)):
            words[at] = s.elbows[w]
            at += 1
    if words.shape[0] > at:  # checks of interference are hard: they read free feet, and the holds these left
        for i in range(n):
            free = s.hold[i] < 0
            words[at + 3 * i] = np.int64(round(s.foot[i, 0] * FOOT_SCALE)) if free else 0
            words[at + 3 * i + 1] = np.int64(round(s.foot[i, 1] * FOOT_SCALE)) if free else 0
            words[at + 3 * i + 2] = s.left[i] if free else -1


@kernel
def restore(p, words, s):
    """The stance of a key. In a short key free feet lie at the origin: no hard check reads them."""
    s.ix = words[0]
    s.iy = words[1]
    s.ia = words[2]
    for w in range(4):
        s.hold[2 * w] = (words[3 + w] & 0xFFFFFFFF) - 1
        s.hold[2 * w + 1] = (words[3 + w] >> 32) - 1
    s.in_use = (words[7] & 0xFF) - 1
    s.hangs = (words[7] >> 8) & 0xFFFFFF
    s.stage = words[7] >> 32
    s.laps = words[9]
    s.bearing = 0.0
    s.resolved = -1
    s.turned = 0.0
    place(p, s)
    if p.circles:
        s.bearing = math.atan2(s.y - p.centre_y, s.x - p.centre_x)
    at = KEY_WORDS
    s.elbows[0] = words[8] if p.kept else EVERY
    for w in range(1, words_of(p.n_limbs)):
        s.elbows[w] = words[at] if p.kept else EVERY
        at += 1 if p.kept else 0
    long = words.shape[0] > at
    for i in range(p.n_limbs):
        s.left[i] = words[at + 3 * i + 2] if long else -1
        s.foot[i, 0] = words[at + 3 * i] / FOOT_SCALE if long else 0.0
        s.foot[i, 1] = words[at + 3 * i + 1] / FOOT_SCALE if long else 0.0
        if s.hold[i] >= 0:
            solve(p, s, i)


@kernel
def candidates(p, s, codes):
    """Every different action from a stance, holds named one by one through the grid; returns their number.

    Args:
        p, s: Parameters and stance.
        codes: Output; holds beyond its length are left out, so give it 6 + n (1 + holds in reach).
    """
    n = 0
    for axis in range(6):
        if p.allowed & (1 << axis):
            codes[n] = pack_code(MOVE, 0, axis)
            n += 1
    for i in range(p.n_limbs):
        if s.hold[i] >= 0 and p.allowed & RELEASES:
            codes[n] = pack_code(RELEASE, i, 0)
            n += 1
        if not p.allowed & GRABS:
            continue
        px, py = port_of(limbs(p)[i], s)
        limit = limbs(p)[i].length - p.reach_offset
        x0, x1, y0, y1 = cells_about(p, px, py, limit + 1e-9)
        for row in range(y0, y1 + 1):
            first, end = cells_in_row(p, row, x0, x1)
            for at in range(first, end):
                h = cells(p)[at]
                hold = holds(p)[h]
                if n < codes.shape[0] and (hold.limbs >> i) & 1 and (p.allowed & ANY_HOLD or not held(p, s, h)):
                    if limit - math.hypot(hold.x - px, hold.y - py) >= -TOLERANCE:
                        codes[n] = pack_code(HOLD, i, h)
                        n += 1
    return n


@kernel
def bound(p, s):
    """An admissible, consistent number of actions still needed; infinity where the goal can't be reached.

    The fewest actions in the relaxed problem, where the problem has one (`actions.relaxed`) and the pose is on its lattice; else body
    steps along x and y from goal to goal. While a hang is left, or one limb alone holds, only the steps up count: a hang turns the body
    about a hold to straight below it, so it never comes to lie higher than before, and no other action lifts it by more than a step.
    """
    if s.stage >= p.n_goals:
        return 0.0
    limited = p.max_hangs >= 0 and p.hard & (1 << HANGS)
    holders, _ = count_holders(p, s)
    if not limited or s.hangs < p.max_hangs or holders < 2:
        rise = goals(p)[s.stage].y_min - s.y
        return math.ceil(max(0.0, rise) / (p.tick * TICKS) - 1e-6) + goals(p)[s.stage].rise_after
    if p.n_left:
        column = s.ix // TICKS - p.places_x
        row = s.iy // TICKS - p.places_y
        if s.ix % TICKS == 0 and s.iy % TICKS == 0 and s.ia % TICKS == 0:
            if column < 0 or row < 0 or column >= p.places_nx or row >= p.places_ny:
                return math.inf
            lap = min(max(s.laps - p.laps_least, 0), p.laps_most - 1)
            angle = s.ia // TICKS if p.angles_kept > 1 else 0
            return actions_left(p, s, row * p.places_nx + column, angle, lap)
    goal = goals(p)[s.stage]
    stride = p.tick * TICKS
    dx = max(0.0, max(goal.x_min - s.x, s.x - goal.x_max))
    dy = max(0.0, max(goal.y_min - s.y, s.y - goal.y_max))
    return math.ceil(dx / stride - 1e-6) + math.ceil(dy / stride - 1e-6) + goal.after
