"""What an action does to a limbed climber: the one compiled meaning (page "The model", section 4), and the family's scalar kernels."""

import math

import numpy as np

from ..compiled import inlined, kernel
from ..robots.kinematics import SOLUTION, TWO_PI, wrap
from ..statics.grip import port_of
from ..statics.interference import inside, point_segment
from ..statics.limbed import (
    N_CHECKS,
    REACH,
    SUPPORT,
    cells_about,
    cells_in_row,
    count_holders,
    hang,
    judge,
    place,
    solve,
    tip_of,
)
from ..statics.records import PARAMS, TICKS, TOLERANCE, UNLIMITED, cells, goals, holds, limbs, vertices, work
from .codes import HOLD, MOVE, NONE, RANDOM, RELEASE, pack_code, unpack
from .family import family_kernels
from .randoms import below, draw

FEATURES = 7
"""Body progress, limb progress, power, stages, length, poor stability, largest torque."""
KEY_WORDS = 10
"""Integers of a key; three more per limb where checks of interference are hard."""
RELEASES, GRABS = 1 << 6, 1 << 7
"""Bits of `allowed`."""
FOOT_SCALE = float(1 << 40)
"""Free feet are kept in a key to 2^-40 m."""
RANK_QUANTUM = 1.0e-10
"""Squared distances that differ by less are a tie [m^2]."""


@inlined
def copy_stance(n, s, t):
    """Copy a stance record of n limbs."""
    t.ix = s.ix
    t.iy = s.iy
    t.ia = s.ia
    t.in_use = s.in_use
    t.hangs = s.hangs
    t.stage = s.stage
    t.laps = s.laps
    t.count = s.count
    t.carriers = s.carriers
    t.push_pull = s.push_pull
    t.resolved = s.resolved
    t.x = s.x
    t.y = s.y
    t.angle = s.angle
    t.c = s.c
    t.s = s.s
    t.turned = s.turned
    t.bearing = s.bearing
    t.power = s.power
    t.torque = s.torque
    for i in range(n):
        t.hold[i] = s.hold[i]
        t.left[i] = s.left[i]
        t.open[i] = s.open[i]
        t.branch[i] = s.branch[i]
        for j in range(2):
            t.foot[i, j] = s.foot[i, j]
            t.force[i, j] = s.force[i, j]
            t.torques[i, j] = s.torques[i, j]
        for j in range(SOLUTION):
            t.solved[i, j] = s.solved[i, j]


@inlined
def let_go(p, s, i):
    """Limb i releases: its foot stays where it is, in the body frame."""
    hold = holds(p)[s.hold[i]]
    dx = hold.x - s.x
    dy = hold.y - s.y
    s.foot[i, 0] = s.c * dx + s.s * dy
    s.foot[i, 1] = s.c * dy - s.s * dx
    s.left[i] = s.hold[i]
    s.hold[i] = -1
    s.open[i] = 3
    s.in_use = i


@inlined
def held(p, s, h):
    """Whether any limb holds hold h."""
    for i in range(p.n_limbs):
        if s.hold[i] == h:
            return True
    return False


@kernel
def find_hold(p, s, i, rank, own):
    """The hold of a given rank (1 is nearest) among limb i's candidates; `own`, the one it came from, is none of them.

    Returns:
        Index of the hold (-1: none), the number of candidates, and for none the `reach` margin [m]. Rank 0 only counts.
    """
    limb = limbs(p)[i]
    limit = limb.length - p.reach_offset
    px, py = port_of(limb, s)
    # a pass per rank over few candidates beats sorting and needs no memory
    found = -1
    floor_rank = -1
    floor_number = -1
    n = 0
    nearest = math.inf
    x0, x1, y0, y1 = cells_about(p, px, py, max(limit, 0.0) + 1e-9)
    for turn in range(max(rank, 1)):
        best_rank = 1 << 62
        best_number = 1 << 30
        best = -1
        for row in range(y0, y1 + 1):
            first, end = cells_in_row(p, row, x0, x1)
            for at in range(first, end):
                h = cells(p)[at]
                hold = holds(p)[h]
                dx = hold.x - px
                dy = hold.y - py
                square = dx * dx + dy * dy
                if limit - math.sqrt(square) < -TOLERANCE or not (hold.limbs >> i) & 1 or h == own or held(p, s, h):
                    continue
                if turn == 0:
                    n += 1
                order = int(round(square / RANK_QUANTUM))
                number = hold.number
                if order < floor_rank or (order == floor_rank and number <= floor_number):
                    continue
                if order < best_rank or (order == best_rank and number < best_number):
                    best_rank = order
                    best_number = number
                    best = h
        if best < 0:
            break  # k is clipped to the number of candidates
        found = best
        floor_rank = best_rank
        floor_number = best_number
    if found < 0:
        for h in range(p.n_holds):  # only on failure: how far the nearest one is
            hold = holds(p)[h]
            if (hold.limbs >> i) & 1 and h != own and not held(p, s, h):
                nearest = min(nearest, (hold.x - px) ** 2 + (hold.y - py) ** 2)
        if nearest < math.inf:
            return -1, 0, limit - math.sqrt(nearest)
        return -1, 0, -UNLIMITED
    return found, n, 0.0


@kernel
def settle(p, s, holders_before, grabbing, moved, margins):
    """Hang if one limb is left, solve the limbs that need it, judge. `moved`: every limb's solution is stale, else only `grabbing`'s."""
    holders, _ = count_holders(p, s)
    swing = UNLIMITED
    if holders == 1:
        if holders_before >= 2:
            s.hangs += 1
        ix = s.ix
        iy = s.iy
        ia = s.ia
        swing = hang(p, s)
        moved = moved or ix != s.ix or iy != s.iy or ia != s.ia
    for i in range(p.n_limbs):
        if s.hold[i] >= 0 and (moved or i == grabbing):
            solve(p, s, i)
    return judge(p, s, grabbing, swing, margins)


@inlined
def fail(margins, check, margin):
    """An action that could not even be tried: only one margin means anything."""
    for i in range(N_CHECKS):
        margins[i] = math.nan
    margins[check] = margin
    return check


@inlined
def advance(p, s):
    """Count the goals that the stance meets, in order."""
    while s.stage < p.n_goals and meets(p, s, goals(p)[s.stage]):
        s.stage += 1


@inlined
def swept(p, s):
    """Angle that the origin has swept about the task's centre since the start [rad]."""
    return TWO_PI * s.laps + s.bearing - p.centre_angle


@inlined
def meets(p, s, goal):
    """Whether a stance meets one goal."""
    if s.x < goal.x_min - 1e-9 or s.x > goal.x_max + 1e-9 or s.y < goal.y_min - 1e-9 or s.y > goal.y_max + 1e-9:
        return False
    if goal.a_half < math.pi and abs(wrap(s.angle - goal.a_mid)) > goal.a_half + 1e-9:
        return False
    if goal.turns != 0.0 and swept(p, s) * math.copysign(1.0, goal.turns) < abs(goal.turns) - 1e-9:
        return False
    for i in range(p.n_limbs):
        if goal.hold[i] >= 0 and s.hold[i] != goal.hold[i]:
            return False
    if goal.n_vertices:
        polygon = vertices(p)[goal.vertex : goal.vertex + goal.n_vertices]
        return inside(s.x, s.y, polygon) or edge_distance(s.x, s.y, polygon) <= 1e-9
    return True


@inlined
def edge_distance(x, y, polygon):
    """Distance of a point from the nearest edge of a polygon, shape (n, 2) [m]."""
    near = math.inf
    j = polygon.shape[0] - 1
    for i in range(polygon.shape[0]):
        near = min(near, point_segment(x, y, polygon[j, 0], polygon[j, 1], polygon[i, 0], polygon[i, 1]))
        j = i
    return near


@inlined
def count_laps(p, before, after):
    """Follow the branch cut of atan2 about the task's centre, if some goal asks for turns."""
    if not p.circles:
        return
    now = math.atan2(after.y - p.centre_y, after.x - p.centre_x)
    was = before.bearing
    after.bearing = now
    if now - was > math.pi:
        after.laps -= 1
    elif now - was < -math.pi:
        after.laps += 1


@inlined
def act(p, before, code, after, margins):
    """Carry out one action; see `step`."""
    kind, i, argument = unpack(code)
    holders, _ = count_holders(p, before)
    if kind == NONE:
        place(p, after)  # so that a start given by its ticks alone becomes a stance
        return settle(p, after, holders, -1, True, margins)
    if kind == MOVE:
        sign = 1 - 2 * (argument & 1)
        axis = argument >> 1
        if axis == 0:
            after.ix += sign * TICKS
        elif axis == 1:
            after.iy += sign * TICKS
        else:
            after.ia = (after.ia + sign * TICKS) % p.turn_ticks
        place(p, after)
        return settle(p, after, holders, -1, True, margins)
    if kind == RELEASE:
        if after.hold[i] >= 0:
            let_go(p, after, i)
        return settle(p, after, holders, -1, False, margins)
    if kind == HOLD and before.hold[i] == argument:
        after.in_use = i
        after.resolved = argument
        return settle(p, after, holders, -1, False, margins)
    reason = -1
    if not p.atomic and before.hold[i] >= 0:
        others = holders - 1
        if others <= 1:
            let_go(p, after, i)
            reason = settle(p, after, holders, -1, False, margins)
            if others == 0:
                for check in range(N_CHECKS):
                    margins[check] = math.nan
                margins[SUPPORT] = -1.0
                return SUPPORT
            if reason >= 0:
                return reason
            reason = -2  # the release was an action of its own: its margins count too
    h = argument
    if kind == HOLD:
        hold = holds(p)[h]
        px, py = port_of(limbs(p)[i], after)
        out = limbs(p)[i].length - p.reach_offset - math.hypot(hold.x - px, hold.y - py) < -TOLERANCE
        banned = not (hold.limbs >> i) & 1
        if (out or banned) and p.replace:
            h, _, margin = find_hold(p, after, i, 1, before.hold[i])
            if h < 0:
                return fail(margins, REACH, margin)
        elif banned:
            return fail(margins, REACH, -UNLIMITED)
    else:
        rank = argument
        if kind == RANDOM:
            _, candidates, margin = find_hold(p, after, i, 1, before.hold[i])
            if candidates:
                rank = 1 + below(draw(p.seed, before.count, i, 0), candidates)
        h, _, margin = find_hold(p, after, i, rank, before.hold[i])
        if h < 0:
            return fail(margins, REACH, margin)
    if after.hold[i] >= 0:
        after.left[i] = after.hold[i]
    after.hold[i] = h
    after.open[i] = 3
    after.in_use = i
    after.resolved = h
    if reason == -2:
        kept = work(p)[-N_CHECKS:]
        for check in range(N_CHECKS):
            kept[check] = margins[check]
        reason = settle(p, after, 1, i, False, margins)
        for check in range(N_CHECKS):
            margins[check] = min(margins[check], kept[check])
        return reason
    return settle(p, after, holders, i, False, margins)


@kernel
def step(p, before, code, after, margins):
    """Carry out the action `code` from the stance `before`, judge where it leads, and write it all down. Allocates nothing.

    Args:
        p: Record of `PARAMS`.
        before: Stance record; only read.
        code: Packed action (`actions.codes`).
        after: Stance record that is written, whatever the verdict.
        margins: Every check's signed margin, shape (N_CHECKS,).

    Returns:
        -1 if the action holds, else the number of the first hard check that it violates.
    """
    copy_stance(p.n_limbs, before, after)
    after.resolved = -1
    after.turned = 0.0
    after.count = before.count + 1
    reason = act(p, before, code, after, margins)
    count_laps(p, before, after)  # even where a check is violated: whoever goes on from there has turned all the same
    if reason < 0:
        advance(p, after)
    return reason


@inlined
def goal_distance(p, s, x, y, goal):
    """Way from a point to a goal: to its box, region and named holds, or along its circle [m]."""
    dx = max(0.0, max(goal.x_min - x, x - goal.x_max))
    dy = max(0.0, max(goal.y_min - y, y - goal.y_max))
    way = math.sqrt(dx * dx + dy * dy)
    if goal.turns != 0.0:
        left = abs(goal.turns) - swept(p, s) * math.copysign(1.0, goal.turns)
        way = max(way, goal.radius * max(0.0, left))
    if goal.n_vertices:
        polygon = vertices(p)[goal.vertex : goal.vertex + goal.n_vertices]
        if not inside(x, y, polygon):
            way = max(way, edge_distance(x, y, polygon))
    return way


@inlined
def measure(p, s, row):
    """Features of one action's stance (page "The model", section 10)."""
    if s.stage >= p.n_goals:
        last = goals(p)[p.n_goals - 1]
        done = last.before + last.way
        row[0] = done
        row[1] = p.n_limbs * done
    else:
        goal = goals(p)[s.stage]
        base = goal.before + goal.way
        row[0] = base - goal_distance(p, s, s.x, s.y, goal)
        total = 0.0
        for i in range(p.n_limbs):
            tx, ty = tip_of(p, s, i)
            way = goal_distance(p, s, tx, ty, goal)
            if goal.hold[i] >= 0:
                way = math.hypot(holds(p)[goal.hold[i]].x - tx, holds(p)[goal.hold[i]].y - ty)
            total += base - way
        row[1] = total
    row[2] = s.power
    row[3] = s.stage
    row[4] = 1.0
    holders, _ = count_holders(p, s)
    row[5] = 1.0 if s.push_pull or holders == 1 else 0.0
    row[6] = s.torque


@kernel
def done(p, s):
    """Whether every goal has been met."""
    return s.stage >= p.n_goals


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
    opened = 0
    if p.kept:
        for i in range(n):
            if s.hold[i] >= 0:
                opened |= s.open[i] << (2 * i)
    words[8] = opened
    words[9] = s.laps
    if words.shape[0] > KEY_WORDS:  # checks of interference are hard: they read free feet, and the holds these left
        for i in range(n):
            free = s.hold[i] < 0
            words[KEY_WORDS + 3 * i] = np.int64(round(s.foot[i, 0] * FOOT_SCALE)) if free else 0
            words[KEY_WORDS + 3 * i + 1] = np.int64(round(s.foot[i, 1] * FOOT_SCALE)) if free else 0
            words[KEY_WORDS + 3 * i + 2] = s.left[i] if free else -1


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
    for i in range(p.n_limbs):
        long = words.shape[0] > KEY_WORDS
        s.left[i] = words[KEY_WORDS + 3 * i + 2] if long else -1
        s.open[i] = (words[8] >> (2 * i)) & 3 if p.kept and s.hold[i] >= 0 else 3
        s.foot[i, 0] = words[KEY_WORDS + 3 * i] / FOOT_SCALE if long else 0.0
        s.foot[i, 1] = words[KEY_WORDS + 3 * i + 1] / FOOT_SCALE if long else 0.0
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
                if n < codes.shape[0] and (hold.limbs >> i) & 1 and not held(p, s, h):
                    if limit - math.hypot(hold.x - px, hold.y - py) >= -TOLERANCE:
                        codes[n] = pack_code(HOLD, i, h)
                        n += 1
    return n


@kernel
def bound(p, s):
    """An admissible, consistent number of actions still needed: body steps along x and y from goal to goal; 0 if hangs are allowed.

    A body move changes x or y by one step; only a hang could do more. Boxes that no goal asks for are infinitely wide.
    """
    if s.stage >= p.n_goals or p.max_hangs != 0:
        return 0.0
    goal = goals(p)[s.stage]
    stride = p.tick * TICKS
    dx = max(0.0, max(goal.x_min - s.x, s.x - goal.x_max))
    dy = max(0.0, max(goal.y_min - s.y, s.y - goal.y_max))
    return math.ceil(dx / stride - 1e-6) + math.ceil(dy / stride - 1e-6) + goal.after


family_kernels(
    PARAMS,
    step=step,
    candidates=candidates,
    key=key,
    restore=restore,
    measure=measure,
    bound=bound,
    done=done,
    cell=cell,
)
