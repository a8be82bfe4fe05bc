"""Can the holds and end effectors take it? The `hook` check, and the splits that respect it (page "The model", sections 7 and 8)."""

import math

from ....compiled import kernel
from ....planning.problem.check import TOLERANCE, UNLIMITED
from .forces import FAR, cut, cut_cone, cut_strength, general_split
from .pose import port_of
from .records import holds, limbs, work


@kernel
def interval(limb, hold, solved, branch, px, py, f, with_torque):
    """The internal forces lam that one limb in one branch can take along a general split.

    Args:
        limb, hold: Records of the limb and of its hold.
        solved: The limb's inverse kinematics.
        branch: 0 or 1.
        px, py: Its port, world [m].
        f: Force of the hold on it: constant x, y and slope x, y.
        with_torque: Whether the torque limits cut too.

    Returns:
        lo, hi [N], and the worst constant cut that is violated (else infinity).
    """
    lo = -FAR
    hi = FAR
    flat = math.inf
    at = 1 + 5 * branch
    if limb.c_cone > -1.5:
        gx, gy = solved[at + 3], solved[at + 4]
        lo, hi, flat = cut_cone(lo, hi, flat, gx, gy, limb.c_cone, limb.s_cone, f)
        if limb.pull > 0.0:
            lo, hi, flat = cut(lo, hi, flat, -(gx * f[0] + gy * f[1]) - limb.pull, -(gx * f[2] + gy * f[3]))
    if hold.c_cone > -1.5:
        lo, hi, flat = cut_cone(lo, hi, flat, hold.dir_x, hold.dir_y, hold.c_cone, hold.s_cone, f)
    strength = min(hold.strength, limb.strength)
    if strength < math.inf:
        lo, hi, flat = cut_strength(lo, hi, flat, strength, f)
    if with_torque:
        for joint in range(2):
            rx = hold.x - (px if joint == 0 else solved[at + 1])
            ry = hold.y - (py if joint == 0 else solved[at + 2])
            limit = limb.limit1 if joint == 0 else limb.limit2
            t0 = ry * f[0] - rx * f[1]
            t1 = ry * f[2] - rx * f[3]
            lo, hi, flat = cut(lo, hi, flat, limit - t0, -t1)
            lo, hi, flat = cut(lo, hi, flat, limit + t0, t1)
    return lo, hi, flat


@kernel
def pair_margin(p, s, a, b, use_a, use_b):
    """`hook` margin of two carriers [N]: that of the best combination of the branches that they may use (bit sets)."""
    f = work(p)[:8]
    hold_a = holds(p)[s.hold[a]]
    hold_b = holds(p)[s.hold[b]]
    if not general_split(p.weight, hold_a.x, hold_a.y, hold_b.x, hold_b.y, s.x, f):
        return -UNLIMITED
    ax, ay = port_of(limbs(p)[a], s)
    bx, by = port_of(limbs(p)[b], s)
    best = -math.inf
    for i in range(2):
        if not use_a & (1 << i):
            continue
        lo_a, hi_a, flat_a = interval(limbs(p)[a], hold_a, s.solved[a], i, ax, ay, f[:4], True)
        for j in range(2):
            if not use_b & (1 << j):
                continue
            lo_b, hi_b, flat_b = interval(limbs(p)[b], hold_b, s.solved[b], j, bx, by, f[4:], True)
            best = max(best, min(0.5 * (min(hi_a, hi_b) - max(lo_a, lo_b)), min(flat_a, flat_b)))
    return best


@kernel
def hang_margin(p, s, a, use):
    """`hook` margin of the one carrier, over both ends of its turn [N]: that of the best branch that it may use (bit set)."""
    weight = p.weight
    limb = limbs(p)[a]
    hold = holds(p)[s.hold[a]]
    fixed = UNLIMITED
    if hold.c_cone > -1.5:
        fixed = min(fixed, weight * (-hold.dir_y - hold.c_cone))
    strength = min(hold.strength, limb.strength)
    if strength < math.inf:
        fixed = min(fixed, strength - weight)
    best = -math.inf
    for i in range(2):
        if not use & (1 << i):
            continue
        margin = fixed
        if limb.c_cone > -1.5:
            gx = s.solved[a, 4 + 5 * i]
            gy = s.solved[a, 5 + 5 * i]
            start = gy * math.cos(s.turned) - gx * math.sin(s.turned)
            margin = min(margin, weight * (-gy - limb.c_cone))
            margin = min(margin, weight * (-start - limb.c_cone))
            if limb.pull > 0.0:
                margin = min(margin, -weight * max(gy, start) - limb.pull)
        best = max(best, margin)
    return best


@kernel
def worst_ratio(alpha, beta, lam):
    """Largest |alpha + beta lam| of four lines."""
    worst = 0.0
    for i in range(4):
        worst = max(worst, abs(alpha[i] + beta[i] * lam))
    return worst


@kernel
def flattest(alpha, beta, lo, hi):
    """The lam in [lo, hi] at which the largest of four |alpha + beta lam| is smallest: exact, at a crossing of two lines or an end."""
    best_lam = lo
    best = worst_ratio(alpha, beta, lo)
    value = worst_ratio(alpha, beta, hi)
    if value < best:
        best = value
        best_lam = hi
    for i in range(4):
        for j in range(i, 4):
            for side in range(2):
                if side == 0:
                    slope = beta[i] + beta[j]
                    rise = -(alpha[i] + alpha[j])
                else:
                    slope = beta[i] - beta[j]
                    rise = alpha[j] - alpha[i]
                if abs(slope) < 1e-15:
                    continue
                lam = min(hi, max(lo, rise / slope))
                value = worst_ratio(alpha, beta, lam)
                if value < best:
                    best = value
                    best_lam = lam
    return best_lam, best


@kernel
def least_norm(alpha, beta, lo, hi):
    """The lam in [lo, hi] at which the sum of squares of four alpha + beta lam is smallest."""
    top = 0.0
    bottom = 0.0
    for i in range(4):
        top -= alpha[i] * beta[i]
        bottom += beta[i] * beta[i]
    lam = min(hi, max(lo, top / bottom if bottom > 1e-15 else 0.0))
    total = 0.0
    for i in range(4):
        total += (alpha[i] + beta[i] * lam) ** 2
    return lam, total


@kernel
def least_pair(p, s, a, b, use_a, use_b, norm):
    """The split of two carriers with the least torque. Exact: over every combination of the branches that they may use (bit sets).

    Returns:
        Branch of a (-1: their holds coincide), branch of b, lam [N], what was made least, and whether the cuts of end effectors and
        holds are met; they are left out where no combination meets them.
    """
    f = work(p)[:8]
    alpha = work(p)[8:12]
    beta = work(p)[12:16]
    hold_a = holds(p)[s.hold[a]]
    hold_b = holds(p)[s.hold[b]]
    best_i = -1
    best_j = -1
    best_lam = 0.0
    best = math.inf
    if not general_split(p.weight, hold_a.x, hold_a.y, hold_b.x, hold_b.y, s.x, f):
        return best_i, best_j, best_lam, best, False
    ax, ay = port_of(limbs(p)[a], s)
    bx, by = port_of(limbs(p)[b], s)
    for bound in range(2):  # first within the cuts, then without
        for i in range(2):
            if not use_a & (1 << i):
                continue
            for j in range(2):
                if not use_b & (1 << j):
                    continue
                lo = -FAR
                hi = FAR
                if bound == 0:
                    lo_a, hi_a, flat_a = interval(limbs(p)[a], hold_a, s.solved[a], i, ax, ay, f[:4], False)
                    lo_b, hi_b, flat_b = interval(limbs(p)[b], hold_b, s.solved[b], j, bx, by, f[4:], False)
                    lo = max(lo_a, lo_b)
                    hi = min(hi_a, hi_b)
                    if 0.5 * (hi - lo) < -TOLERANCE or flat_a < -TOLERANCE or flat_b < -TOLERANCE:
                        continue
                    if hi < lo:
                        lo = 0.5 * (lo + hi)
                        hi = lo
                torque_lines(limbs(p)[a], hold_a, s.solved[a], i, (ax, ay), f[:4], alpha[:2], beta[:2])
                torque_lines(limbs(p)[b], hold_b, s.solved[b], j, (bx, by), f[4:], alpha[2:], beta[2:])
                if norm:
                    lam, value = least_norm(alpha, beta, lo, hi)
                else:
                    lam, value = flattest(alpha, beta, lo, hi)
                if value < best - 1e-9:
                    best = value
                    best_i = i
                    best_j = j
                    best_lam = lam
        if best_i >= 0:
            return best_i, best_j, best_lam, best, bound == 0
    return best_i, best_j, best_lam, best, False


@kernel
def torque_lines(limb, hold, solved, branch, port, f, alpha, beta):
    """Torque over limit of both joints along a general split: alpha + beta lam."""
    px, py = port
    at = 1 + 5 * branch
    for joint in range(2):
        rx = hold.x - (px if joint == 0 else solved[at + 1])
        ry = hold.y - (py if joint == 0 else solved[at + 2])
        limit = limb.limit1 if joint == 0 else limb.limit2
        alpha[joint] = (ry * f[0] - rx * f[1]) / limit
        beta[joint] = (ry * f[2] - rx * f[3]) / limit
