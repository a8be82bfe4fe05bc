"""Judge one stance of the limbed climber: forces, torques and every check's margin (page "The model", sections 3 and 5 to 9)."""

import math

from ....compiled import inlined, kernel
from ....planning.problem.check import TOLERANCE, UNLIMITED
from .elbows import WORDS, free_elbow, is_open
from .grip import hang_margin, pair_margin
from .interference import (
    HOLDER_PEG,
    KEEP_OUT,
    LIMB_BODY,
    LIMB_LIMB,
    LIMB_PEG,
    bend_free_limbs,
    holder_gap,
    interference,
)
from .many import BETTER, SLACK, best_many
from .near import nearest_hold
from .pose import count_holders, take_branch, usable
from .records import LIMBS, goals, holds, limbs, work
from .share import find_carriers, share

REACH, JOINT, SUPPORT, HANGS, TORQUE, POWER, CLEARANCE, SWING = 0, 1, 2, 3, 4, 5, 6, 7
HOOK, SHARED, STABILITY = 12, 13, 14
"""Places of the checks among the margins; the others lie beside their kernels."""
N_CHECKS = 16
BENDS = (JOINT, TORQUE, POWER, KEEP_OUT, LIMB_LIMB, LIMB_BODY, LIMB_PEG, HOOK, HOLDER_PEG)
"""The checks that elbows change, in their order."""
MEMBER, LOAD, MET = REACH, SUPPORT, HANGS
"""Places in a row of margins of an assignment, where checks stand that elbows do not change: whether it is left, and what `share` says."""
TIE = 1.0e-9
"""Loads of two carriers [of the limits] and joint margins [rad] that differ by less are equal."""


@kernel
def judge(p, s, grabbing, swing, margins):
    """Write every margin of a settled stance; return the first hard check that is violated, or -1.

    Args:
        p: Parameters.
        s: Stance record, posed and hung, with `solved` up to date for the holders.
        grabbing: The limb whose grab is being judged (its reach limit is less the offset), or -1.
        swing: Margin of the swing that led here [m].
        margins: Output, shape (N_CHECKS,).
    """
    n = p.n_limbs
    for i in range(N_CHECKS):
        margins[i] = math.nan
    holders, _ = count_holders(p, s)
    margins[SUPPORT] = float(holders - p.min_supports) if holders else -1.0
    if not holders:
        return SUPPORT
    margins[HANGS] = float(p.max_hangs - s.hangs) if p.max_hangs >= 0 else UNLIMITED
    if holders == 1 and s.stage < p.n_goals and not goals(p)[s.stage].hangs:
        margins[HANGS] = -1.0
    margins[SWING] = swing
    reach = math.inf
    for i in range(n):
        if s.hold[i] < 0:
            continue
        offset = p.holding_offset
        if i == grabbing or p.offset_while_holding:
            offset = max(offset, p.reach_offset)
        limit = limbs(p)[i].length - offset
        reach = min(reach, limit - s.solved[i, 0])
    margins[REACH] = reach
    k, a, b = find_carriers(p, s)
    near = nearest_hold(p, s.x, s.y)
    margins[CLEARANCE] = near - p.clearance if near < math.inf else UNLIMITED
    if p.seen & (1 << STABILITY):
        margins[STABILITY] = stability(p, s, k) - p.inside
    if p.seen & (1 << SHARED):
        margins[SHARED] = shared(p, s)
    if sees_links(p):
        bend_free_limbs(p, s)
    if p.kept:
        judge_assignments(p, s, k, a, b, margins)
    else:
        judge_bent(p, s, k, a, b, -1, margins)
    violated = 0
    for check in range(N_CHECKS):  # no branches, so that it vectorises
        violated |= (1 << check) if margins[check] < -TOLERANCE else 0
    violated &= p.hard
    if violated:
        check = 0
        while not violated & (1 << check):
            check += 1
        return check
    if p.kept:
        leave_open(p, s)
    return -1


@inlined
def sees_links(p):
    """Whether a check of links against what is about them is looked at."""
    return p.seen & (1 << LIMB_LIMB | 1 << LIMB_BODY | 1 << LIMB_PEG) or (p.fences > 0 and p.seen & (1 << KEEP_OUT))


@kernel
def judge_bent(p, s, k, a, b, assignment, margins):
    """Write the margins that elbows change.

    Args:
        p, s: Parameters and stance, with its carriers; its forces and branches are set.
        k: Number of carriers.
        a, b: The first two.
        assignment: Of the elbows that are kept; -1: every check takes those that are best for it.
        margins: Output, shape (N_CHECKS,).

    Returns:
        What `share` returns.
    """
    n = p.n_limbs
    joint = math.inf
    for i in range(n):
        if s.hold[i] >= 0:
            here = max(s.solved[i, 1], s.solved[i, 6])
            if assignment >= 0:
                here = s.solved[i, 1 + 5 * ((assignment >> i) & 1)]
            joint = min(joint, here)
    margins[JOINT] = joint
    value, met = share(p, s, k, a, b, assignment)
    torque = math.inf
    for i in range(n):
        if s.carriers & (1 << i):
            torque = min(torque, limbs(p)[i].limit1 - abs(s.torques[i, 0]))
            torque = min(torque, limbs(p)[i].limit2 - abs(s.torques[i, 1]))
    margins[TORQUE] = torque
    margins[POWER] = p.max_power - s.power if p.max_power < math.inf else UNLIMITED
    if p.seen & (1 << HOOK):
        margins[HOOK] = hook(p, s, k, a, b, assignment)
    margins[KEEP_OUT] = UNLIMITED
    if sees_links(p):
        interference(p, s, margins)
    if p.seen & (1 << HOLDER_PEG):
        margins[HOLDER_PEG] = holder_gap(p, s)
    return value, met


@inlined
def rows_of(p):
    """Margins of each assignment, shape (2^n, N_CHECKS)."""
    size = N_CHECKS << p.n_limbs
    return work(p)[p.n_work - N_CHECKS - size : p.n_work - N_CHECKS].reshape((1 << p.n_limbs, N_CHECKS))


@kernel
def judge_assignments(p, s, k, a, b, margins):
    """Write the margins that elbows change where these are kept: those of the assignment that is taken.

    Each open assignment is judged by itself. Check by check, those that violate a hard one drop out, and where all do, all but the best;
    of what is left the stance takes the assignment that it prefers.

    Args:
        p, s: Parameters and stance, with its carriers; its forces and branches are set.
        k: Number of carriers.
        a, b: The first two.
        margins: Output, shape (N_CHECKS,).
    """
    n = p.n_limbs
    rows = rows_of(p)
    held = 0
    for i in range(n):
        if s.hold[i] >= 0:
            held |= 1 << i
    none = True
    for m in range(1 << n):
        rows[m, MEMBER] = 0.0
        if not m & ~held and is_open(s.elbows, m):
            none = False
            for check in range(N_CHECKS):
                rows[m, check] = math.nan
            rows[m, MEMBER] = 1.0
            joint = math.inf
            for i in range(n):
                if s.hold[i] >= 0:
                    joint = min(joint, s.solved[i, 1 + 5 * ((m >> i) & 1)])
            rows[m, JOINT] = joint
    if none:  # no action leads to such a stance
        judge_bent(p, s, k, a, b, -1, margins)
        margins[JOINT] = -math.pi
        return
    sift(p, rows, JOINT)
    apart = sees_links(p) or p.seen & (1 << HOLDER_PEG)
    for m in range(1 << n):
        if rows[m, MEMBER] == 0.0:
            continue
        like = m
        if not apart:  # elbows of limbs that carry nothing change nothing
            like = 0
            while rows[like, MEMBER] == 0.0 or (like ^ m) & s.carriers:
                like += 1
        if like < m:
            for check in (TORQUE, POWER, KEEP_OUT, HOOK, LOAD, MET):
                rows[m, check] = rows[like, check]
        else:
            value, met = judge_bent(p, s, k, a, b, m, rows[m])
            rows[m, LOAD] = value
            rows[m, MET] = 1.0 if met else 0.0
    for check in BENDS[1:]:
        if p.seen & (1 << check):
            sift(p, rows, check)
    taken = -1
    for m in range(1 << n):
        if rows[m, MEMBER] != 0.0 and (taken < 0 or is_preferred(p, s, k, rows, m, taken)):
            taken = m
    share(p, s, k, a, b, taken)
    for check in BENDS:
        margins[check] = rows[taken, check]


@kernel
def sift(p, rows, check):
    """Drop the assignments that violate a check, if it is hard; where all do, all but the best, and those as good but for rounding."""
    if not p.hard & (1 << check):
        return
    best = -math.inf
    for m in range(rows.shape[0]):
        if rows[m, MEMBER] != 0.0:
            best = max(best, rows[m, check])
    least = min(best - BETTER * max(1.0, abs(best)), -TOLERANCE)
    for m in range(rows.shape[0]):
        if rows[m, check] < least:
            rows[m, MEMBER] = 0.0


@kernel
def is_preferred(p, s, k, rows, m, other):
    """Whether an assignment is taken rather than another.

    Where the split depends on elbows, for less load, or farther from joint limits at the same load; else limb by limb, as where elbows
    are not kept.
    """
    split = k >= 3 or (k == 2 and p.force_rule != 0)
    if split:
        if rows[m, MET] != rows[other, MET]:
            return rows[m, MET] > rows[other, MET]
        tie = TIE if k == 2 else BETTER
        if abs(rows[m, LOAD] - rows[other, LOAD]) > tie:
            return rows[m, LOAD] < rows[other, LOAD]
        if abs(rows[m, JOINT] - rows[other, JOINT]) > TIE:
            return rows[m, JOINT] > rows[other, JOINT]
    for i in range(p.n_limbs):
        branch = (m >> i) & 1
        if branch == (other >> i) & 1:
            continue
        if not split or not s.carriers & (1 << i):
            return branch == take_branch(p, s, i, 3, s.force[i, 0], s.force[i, 1])
        return branch == 0
    return False


@kernel
def leave_open(p, s):
    """Keep the assignments that are left as those that are open; a free limb's elbow is bound to nothing."""
    rows = rows_of(p)
    some = False
    for m in range(1 << p.n_limbs):
        some |= rows[m, MEMBER] != 0.0
    if not some:
        return
    for w in range(WORDS):
        s.elbows[w] = 0
    for m in range(1 << p.n_limbs):
        if rows[m, MEMBER] != 0.0:
            s.elbows[m >> 6] |= 1 << (m & 63)
    for i in range(p.n_limbs):
        if s.hold[i] < 0:
            free_elbow(s.elbows, p.n_limbs, i)


@kernel
def hook(p, s, k, a, b, assignment):
    """`hook` margin [N], over the branches that carriers may have."""
    if k == 1:
        return hang_margin(p, s, a, usable(s, a, assignment))
    if k == 2:
        return pair_margin(p, s, a, b, usable(s, a, assignment), usable(s, b, assignment))
    if k == 0:
        return math.nan
    taken = 0
    for i in range(p.n_limbs):
        taken |= s.branch[i] << i
    slack = best_many(p, s, s.carriers, SLACK, assignment, work(p)[:16].reshape((LIMBS, 2)))
    for i in range(p.n_limbs):
        if s.carriers & (1 << i):
            s.branch[i] = (taken >> i) & 1
    return -slack * p.weight if slack < math.inf else -UNLIMITED


@kernel
def stability(p, s, k):
    """How far the origin lies inside the carriers' span [m]; 0 in a hang."""
    if k < 2:
        return 0.0
    lo = math.inf
    hi = -math.inf
    for i in range(p.n_limbs):
        if s.carriers & (1 << i):
            lo = min(lo, holds(p)[s.hold[i]].x)
            hi = max(hi, holds(p)[s.hold[i]].x)
    return min(hi - s.x, s.x - lo)


@kernel
def shared(p, s):
    """-1 if two limbs hold one hold, else 0."""
    n = p.n_limbs
    for i in range(n):
        for j in range(i + 1, n):
            if s.hold[i] >= 0 and s.hold[i] == s.hold[j]:
                return -1.0
    return 0.0
