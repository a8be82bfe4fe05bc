"""Judge one stance of the limbed climber: forces, torques and every check's margin (page "The model", sections 3 and 5 to 9)."""

import math

from ..compiled import kernel
from .forces import NO_SPLIT
from .grip import hang_margin, pair_margin
from .interference import HOLDER_PEG, KEEP_OUT, LIMB_BODY, LIMB_LIMB, LIMB_PEG, holder_gap, interference
from .many import many_split
from .near import nearest_hold
from .pose import count_holders, joint_torques, usable
from .records import LIMBS, TOLERANCE, UNLIMITED, goals, holds, limbs, work
from .share import share

REACH, JOINT, SUPPORT, HANGS, TORQUE, POWER, CLEARANCE, SWING = 0, 1, 2, 3, 4, 5, 6, 7
HOOK, SHARED, STABILITY = 12, 13, 14
"""Places of the checks among the margins; the others lie beside their kernels."""
N_CHECKS = 16


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
    joint = math.inf
    for i in range(n):
        if s.hold[i] < 0:
            continue
        offset = p.holding_offset
        if i == grabbing or p.offset_while_holding:
            offset = max(offset, p.reach_offset)
        limit = limbs(p)[i].length - offset
        reach = min(reach, limit - s.solved[i, 0])
        allowed = s.open[i] if p.kept else 3
        best = -math.pi
        for branch in range(2):
            if allowed & (1 << branch):
                best = max(best, s.solved[i, 1 + 5 * branch])
        joint = min(joint, best)
    margins[REACH] = reach
    margins[JOINT] = joint
    k = share(p, s)
    torque = math.inf
    for i in range(n):
        if s.carriers & (1 << i):
            torque = min(torque, limbs(p)[i].limit1 - abs(s.torques[i, 0]))
            torque = min(torque, limbs(p)[i].limit2 - abs(s.torques[i, 1]))
    margins[TORQUE] = torque
    margins[POWER] = p.max_power - s.power if p.max_power < math.inf else UNLIMITED
    near = nearest_hold(p, s.x, s.y)
    margins[CLEARANCE] = near - p.clearance if near < math.inf else UNLIMITED
    if p.seen & (1 << STABILITY):
        margins[STABILITY] = stability(p, s, k) - p.inside
    if p.seen & (1 << SHARED):
        margins[SHARED] = shared(p, s)
    every = 3 * 0x5555  # branches, two bits a limb
    good = every
    if p.seen & (1 << HOOK):
        margins[HOOK], good = hook(p, s, k)
    margins[KEEP_OUT] = UNLIMITED
    fenced = p.fences > 0 and p.seen & (1 << KEEP_OUT)
    if fenced or p.seen & (1 << LIMB_LIMB | 1 << LIMB_BODY | 1 << LIMB_PEG):
        interference(p, s, margins)
    clear = every
    if p.seen & (1 << HOLDER_PEG):
        margins[HOLDER_PEG], clear = holder_gap(p, s)
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
        left = (good if p.hard & (1 << HOOK) else every) & (clear if p.hard & (1 << HOLDER_PEG) else every)
        for i in range(n):
            if s.hold[i] >= 0:
                s.open[i] = still_open(p, s, i, (left >> (2 * i)) & 3)
    return -1


@kernel
def still_open(p, s, i, good):
    """The open branches of a holder that this stance leaves open (bit set)."""
    if abs(s.torques[i, 0]) == NO_SPLIT:
        return 0
    left = 0
    for branch in range(2):
        if s.open[i] & good & (1 << branch) and s.solved[i, 1 + 5 * branch] >= -TOLERANCE:
            t1, t2 = joint_torques(p, s, i, branch, s.force[i, 0], s.force[i, 1])
            if limbs(p)[i].limit1 - abs(t1) >= -TOLERANCE and limbs(p)[i].limit2 - abs(t2) >= -TOLERANCE:
                left |= 1 << branch
    return left


@kernel
def hook(p, s, k):
    """`hook` margin [N] and, two bits a limb, the branches in good combinations."""
    a = -1
    b = -1
    for i in range(p.n_limbs):
        if s.carriers & (1 << i):
            if a < 0:
                a = i
            elif b < 0:
                b = i
    good = 3 * 0x5555
    if k == 1:
        margin, good_a = hang_margin(p, s, a, usable(s, a, p.kept))
        return margin, good & ~(3 << (2 * a)) | good_a << (2 * a)
    if k == 2:
        margin, good_a, good_b = pair_margin(p, s, a, b, usable(s, a, p.kept), usable(s, b, p.kept))
        good = good & ~(3 << (2 * a)) | good_a << (2 * a)
        return margin, good & ~(3 << (2 * b)) | good_b << (2 * b)
    if k == 0:
        return math.nan, good
    spare = work(p)[16:32].reshape((LIMBS, 2))
    split, margin = many_split(p, s, s.carriers, 2, spare)
    return margin if split else -UNLIMITED, good


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
