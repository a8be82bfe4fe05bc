"""What an action does to a limbed climber: the one compiled meaning (page "The model", section 4)."""

import math

from ....compiled import inlined, kernel
from ....planning.problem.check import TICKS, TOLERANCE, UNLIMITED
from ....planning.problem.codes import HOLD, MOVE, NONE, RANDOM, RELEASE, unpack
from ....planning.problem.randoms import below, draw
from ..robot.kinematics import SOLUTION
from ..statics.elbows import WORDS, free_elbow
from ..statics.hang import hang
from ..statics.near import cells_about, cells_in_row
from ..statics.pose import count_holders, held, place, port_of, solve
from ..statics.records import cells, holds, limbs, work
from ..statics.stance import N_CHECKS, REACH, SUPPORT, judge
from .goals import advance, count_laps

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
    for w in range(WORDS):
        t.elbows[w] = s.elbows[w]
    for i in range(n):
        t.hold[i] = s.hold[i]
        t.left[i] = s.left[i]
        t.branch[i] = s.branch[i]
        for j in range(2):
            t.foot[i, j] = s.foot[i, j]
            t.force[i, j] = s.force[i, j]
            t.torques[i, j] = s.torques[i, j]
        for j in range(SOLUTION):
            t.solved[i, j] = s.solved[i, j]


@inlined
def release_limb(p, s, i):
    """Limb i releases: its foot stays where it is, in the body frame."""
    hold = holds(p)[s.hold[i]]
    dx = hold.x - s.x
    dy = hold.y - s.y
    s.foot[i, 0] = s.c * dx + s.s * dy
    s.foot[i, 1] = s.c * dy - s.s * dx
    s.left[i] = s.hold[i]
    s.hold[i] = -1
    free_elbow(s.elbows, p.n_limbs, i)
    s.in_use = i


@kernel
def nearest_free(p, s, i, own, px, py):
    """Distance of the nearest hold, at any distance, that no limb holds and that limb i may use [m]; infinity if there is none."""
    best = math.inf
    radius = p.grid_cell
    for _ in range(64):
        x0, x1, y0, y1 = cells_about(p, px, py, radius)
        for row in range(y0, y1 + 1):
            first, end = cells_in_row(p, row, x0, x1)
            for at in range(first, end):
                h = cells(p)[at]
                hold = holds(p)[h]
                if (hold.limbs >> i) & 1 and h != own and not held(p, s, h):
                    best = min(best, (hold.x - px) ** 2 + (hold.y - py) ** 2)
        whole = x0 == 0 and y0 == 0 and x1 == p.grid_nx - 1 and y1 == p.grid_ny - 1
        if whole or best <= radius * radius:
            break
        radius *= 2.0
    return math.sqrt(best)


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
        nearest = nearest_free(p, s, i, own, px, py)  # only on failure: how far the nearest one is
        if nearest < math.inf:
            return -1, 0, limit - nearest
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
            release_limb(p, after, i)
        return settle(p, after, holders, -1, False, margins)
    if kind == HOLD and before.hold[i] == argument:
        after.in_use = i
        after.resolved = argument
        return settle(p, after, holders, -1, False, margins)
    reason = -1
    if not p.atomic and before.hold[i] >= 0:
        others = holders - 1
        if others <= 1:
            release_limb(p, after, i)
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
    free_elbow(after.elbows, p.n_limbs, i)
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
