"""How the carriers share the weight, and the torques and power that this takes (page "The model", section 7)."""

import math

from ....compiled import inlined, kernel
from .forces import NO_SPLIT, general_split, thesis_split
from .grip import least_pair
from .many import CUT, NORM, UNCUT, best_many
from .pose import joint_torques, take_branch, usable
from .records import holds, limbs, work


@inlined
def find_carriers(p, s):
    """Set the stance's carriers; returns their number, and the first two."""
    holders = 0
    for i in range(p.n_limbs):
        if s.hold[i] >= 0:
            holders += 1
    s.carriers = 0
    a = -1
    b = -1
    k = 0
    for i in range(p.n_limbs):
        if s.hold[i] >= 0 and not (p.idle and holders >= 3 and i == s.in_use):
            s.carriers |= 1 << i
            k += 1
            if a < 0:
                a = i
            elif b < 0:
                b = i
    return k, a, b


@kernel
def share(p, s, k, a, b, assignment):
    """Forces, branches and torques of all holders; sets push_pull, force, branch, torques, power and torque of the stance.

    Args:
        p, s: Parameters and stance, with its carriers.
        k: Their number.
        a, b: The first two.
        assignment: Of the elbows that are kept; -1: each limb takes what is best.

    Returns:
        What the split makes least over branches (0 for a split that knows none), and whether the cuts of ends and holds are met, or
        there are none to be met.
    """
    n = p.n_limbs
    carriers = s.carriers
    for i in range(n):
        s.force[i, 0] = 0.0
        s.force[i, 1] = 0.0
    s.push_pull = 0
    split = True
    value = 0.0
    met = True
    given_a = -1
    given_b = -1
    if k == 1:
        s.force[a, 1] = p.weight
    elif k == 2:
        hold_a = holds(p)[s.hold[a]]
        hold_b = holds(p)[s.hold[b]]
        opposed = (p.opposed[a] >> b) & 1 == 1
        rax = hold_a.x - s.x
        rbx = hold_b.x - s.x
        if p.force_rule == 0:
            split, push_pull, fax, fay, fbx, fby = thesis_split(
                p.weight, opposed, rax, hold_a.y - s.y, rbx, hold_b.y - s.y
            )
            s.push_pull = 1 if push_pull else 0
            s.force[a, 0] = fax
            s.force[a, 1] = fay
            s.force[b, 0] = fbx
            s.force[b, 1] = fby
        else:
            s.push_pull = 0 if opposed or rax * rbx < 0.0 else 1
            use_a = usable(s, a, assignment)
            use_b = usable(s, b, assignment)
            given_a, given_b, lam, value, met = least_pair(p, s, a, b, use_a, use_b, p.force_rule == 2)
            split = given_a >= 0
            if split:
                f = work(p)[:8]
                general_split(p.weight, hold_a.x, hold_a.y, hold_b.x, hold_b.y, s.x, f)
                s.force[a, 0] = f[0] + lam * f[2]
                s.force[a, 1] = f[1] + lam * f[3]
                s.force[b, 0] = f[4] + lam * f[6]
                s.force[b, 1] = f[5] + lam * f[7]
    elif k >= 3:
        value = best_many(p, s, carriers, NORM if p.force_rule == 2 else CUT, assignment, s.force)
        if value == math.inf and p.force_rule != 2:
            met = False
            value = best_many(p, s, carriers, UNCUT, assignment, s.force)
        split = value < math.inf
    for i in range(n):
        if s.hold[i] < 0:
            continue
        if i == a and given_a >= 0:
            s.branch[i] = given_a
        elif i == b and given_b >= 0:
            s.branch[i] = given_b
        elif k < 3 or not carriers & (1 << i):
            s.branch[i] = take_branch(p, s, i, usable(s, i, assignment), s.force[i, 0], s.force[i, 1])
    worst = 0.0
    power = 0.0
    for i in range(n):
        s.torques[i, 0] = 0.0
        s.torques[i, 1] = 0.0
        if not carriers & (1 << i):
            continue
        if split:
            t1, t2 = joint_torques(p, s, i, s.branch[i], s.force[i, 0], s.force[i, 1])
        else:
            t1 = NO_SPLIT
            t2 = NO_SPLIT
        s.torques[i, 0] = t1
        s.torques[i, 1] = t2
        worst = max(worst, max(abs(t1), abs(t2)))
        power += t1 * t1 * limbs(p)[i].heat1 + t2 * t2 * limbs(p)[i].heat2
    s.torque = worst
    s.power = power
    return value, met
