"""Can the holds and end effectors take it? The `hook` check, and the splits that respect it (page "The model", sections 7 and 8)."""

import math

import numpy as np

from ..compiled import inlined, kernel
from .forces import FAR, cut, cut_cone, cut_strength, general_split
from .programme import maximise
from .records import TOLERANCE, UNLIMITED, holds, limbs, work

CORNERS = 16
"""Sides of the polygon that stands for a hold's strength with three or more carriers."""


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
        lo, hi, flat = cut_cone(lo, hi, flat, solved[at + 3], solved[at + 4], limb.c_cone, limb.s_cone, f)
    if hold.c_cone > -1.5:
        lo, hi, flat = cut_cone(lo, hi, flat, hold.dir_x, hold.dir_y, hold.c_cone, hold.s_cone, f)
    if hold.strength < math.inf:
        lo, hi, flat = cut_strength(lo, hi, flat, hold.strength, f)
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


@inlined
def port_of(limb, s):
    """Port of a limb in the world [m]."""
    return s.x + s.c * limb.port_x - s.s * limb.port_y, s.y + s.s * limb.port_x + s.c * limb.port_y


@kernel
def pair_margin(p, s, a, b, use_a, use_b):
    """`hook` margin of two carriers, and the branches of each that appear in some good combination (bit sets)."""
    f = work(p)[:8]
    hold_a = holds(p)[s.hold[a]]
    hold_b = holds(p)[s.hold[b]]
    if not general_split(p.weight, hold_a.x, hold_a.y, hold_b.x, hold_b.y, s.x, f):
        return -UNLIMITED, 0, 0
    ax, ay = port_of(limbs(p)[a], s)
    bx, by = port_of(limbs(p)[b], s)
    best = -math.inf
    good_a = 0
    good_b = 0
    for i in range(2):
        if not use_a & (1 << i):
            continue
        lo_a, hi_a, flat_a = interval(limbs(p)[a], hold_a, s.solved[a], i, ax, ay, f[:4], True)
        for j in range(2):
            if not use_b & (1 << j):
                continue
            lo_b, hi_b, flat_b = interval(limbs(p)[b], hold_b, s.solved[b], j, bx, by, f[4:], True)
            margin = min(0.5 * (min(hi_a, hi_b) - max(lo_a, lo_b)), min(flat_a, flat_b))
            best = max(best, margin)
            if margin >= -TOLERANCE:
                good_a |= 1 << i
                good_b |= 1 << j
    return best, good_a, good_b


@kernel
def hang_margin(p, s, a, use):
    """`hook` margin of the one carrier, over both ends of its turn; and its good branches."""
    weight = p.weight
    limb = limbs(p)[a]
    hold = holds(p)[s.hold[a]]
    fixed = UNLIMITED
    if hold.c_cone > -1.5:
        fixed = min(fixed, weight * (-hold.dir_y - hold.c_cone))
    if hold.strength < math.inf:
        fixed = min(fixed, hold.strength - weight)
    best = -math.inf
    good = 0
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
        best = max(best, margin)
        if margin >= -TOLERANCE:
            good |= 1 << i
    return best, good


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
    """The split of two carriers with the least torque: branch of a, branch of b, lam; branch -1 if their holds coincide.

    Exact: over every combination of usable branches, within the cuts of end effectors and holds if those can be met at all.
    """
    f = work(p)[:8]
    alpha = work(p)[8:12]
    beta = work(p)[12:16]
    hold_a = holds(p)[s.hold[a]]
    hold_b = holds(p)[s.hold[b]]
    best_i = -1
    best_j = -1
    best_lam = 0.0
    if not general_split(p.weight, hold_a.x, hold_a.y, hold_b.x, hold_b.y, s.x, f):
        return best_i, best_j, best_lam
    ax, ay = port_of(limbs(p)[a], s)
    bx, by = port_of(limbs(p)[b], s)
    for bound in range(2):  # first within the cuts, then without
        best = math.inf
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
                torque_lines(limbs(p)[a], hold_a, s.solved[a], i, ax, ay, f[:4], alpha[:2], beta[:2])
                torque_lines(limbs(p)[b], hold_b, s.solved[b], j, bx, by, f[4:], alpha[2:], beta[2:])
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
            break
    return best_i, best_j, best_lam


@kernel
def torque_lines(limb, hold, solved, branch, px, py, f, alpha, beta):
    """Torque over limit of both joints along a general split: alpha + beta lam."""
    at = 1 + 5 * branch
    for joint in range(2):
        rx = hold.x - (px if joint == 0 else solved[at + 1])
        ry = hold.y - (py if joint == 0 else solved[at + 2])
        limit = limb.limit1 if joint == 0 else limb.limit2
        alpha[joint] = (ry * f[0] - rx * f[1]) / limit
        beta[joint] = (ry * f[2] - rx * f[3]) / limit


@kernel
def cone_rows(a, row, column, mx, my, c_cone, s_cone, slack, last):
    """Two rows: the force -F of columns (column, column + 1) within a cone about (mx, my), with slack in column `last`."""
    for side in range(2):
        turn = c_cone if side == 0 else -c_cone
        a[row, column] = mx * s_cone - my * turn
        a[row, column + 1] = my * s_cone + mx * turn
        a[row, last] = slack
        row += 1
    return row


@kernel
def many_split(p, s, carriers, goal, forces):
    """The split of three or more carriers by linear programme, in units of the weight.

    Args:
        p, s: Parameters and stance.
        carriers: Bit set of the carrying limbs.
        goal: 0: least largest |torque|/limit within the cuts; 1: the same without cuts; 2: largest slack of the cuts with torques and
            strengths within limits (the `hook` margin).
        forces: Where the forces of the holds on the limbs go [N], shape (LIMBS, 2).

    Returns:
        Whether a split exists, and the optimum (goal 2 in N).
    """
    n = p.n_limbs
    weight = p.weight
    k = 0
    for i in range(n):
        if carriers & (1 << i):
            k += 1
    d = 2 * k + 1
    last = 2 * k
    most = 6 + k * (8 + CORNERS)
    at = 32
    a = work(p)[at : at + most * d].reshape((most, d))
    at += most * d
    b = work(p)[at : at + most]
    at += most
    c = work(p)[at : at + d]
    at += d
    x = work(p)[at : at + d]
    at += d
    basis = work(p)[at : at + d]
    at += d
    table = work(p)[at : at + (d + 1) * (most + 2 * d + 1)].reshape((d + 1, most + 2 * d + 1))
    for i in range(most):
        b[i] = 0.0
        for j in range(d):
            a[i, j] = 0.0
    for j in range(d):
        c[j] = 0.0
    c[last] = 1.0 if goal == 2 else -1.0
    column = 0
    row = 6
    b[2] = 1.0
    b[3] = -1.0
    for i in range(n):
        if not carriers & (1 << i):
            continue
        hold = holds(p)[s.hold[i]]
        limb = limbs(p)[i]
        for sign in range(2):  # an equality is two inequalities
            e = 1.0 if sign == 0 else -1.0
            a[sign, column] = e
            a[2 + sign, column + 1] = e
            a[4 + sign, column] = -e * (hold.y - s.y)
            a[4 + sign, column + 1] = e * (hold.x - s.x)
        px, py = port_of(limb, s)
        branch_at = 1 + 5 * s.branch[i]
        for joint in range(2):
            rx = hold.x - (px if joint == 0 else s.solved[i, branch_at + 1])
            ry = hold.y - (py if joint == 0 else s.solved[i, branch_at + 2])
            scale = weight / (limb.limit1 if joint == 0 else limb.limit2)
            for sign in range(2):
                e = scale if sign == 0 else -scale
                a[row, column] = e * ry
                a[row, column + 1] = -e * rx
                if goal == 2:
                    b[row] = 1.0
                else:
                    a[row, last] = -1.0
                row += 1
        if goal != 1:
            slack = 1.0 if goal == 2 else 0.0
            if limb.c_cone > -1.5:
                gx = s.solved[i, branch_at + 3]
                gy = s.solved[i, branch_at + 4]
                row = cone_rows(a, row, column, gx, gy, limb.c_cone, limb.s_cone, slack, last)
            if hold.c_cone > -1.5:
                row = cone_rows(a, row, column, hold.dir_x, hold.dir_y, hold.c_cone, hold.s_cone, slack, last)
            if hold.strength < math.inf:
                for side in range(CORNERS):
                    angle = (2 * side + 1) * math.pi / CORNERS
                    a[row, column] = math.cos(angle)
                    a[row, column + 1] = math.sin(angle)
                    b[row] = hold.strength / weight * math.cos(math.pi / CORNERS)
                    row += 1
        column += 2
    if not maximise(a[:row], b[:row], c, table, basis, x):
        return False, 0.0
    column = 0
    for i in range(n):
        if carriers & (1 << i):
            forces[i, 0] = weight * x[column]
            forces[i, 1] = weight * x[column + 1]
            column += 2
    return True, weight * x[last] if goal == 2 else x[last]


@kernel
def many_least_norm(p, s, carriers, forces):
    """The split of three or more carriers with the smallest sum of (torque / limit)^2: the normal equations, by elimination."""
    n = p.n_limbs
    weight = p.weight
    k = 0
    for i in range(n):
        if carriers & (1 << i):
            k += 1
    d = 2 * k + 3
    m = work(p)[32 : 32 + d * (d + 1)].reshape((d, d + 1))
    m[:] = 0.0
    column = 0
    for i in range(n):
        if not carriers & (1 << i):
            continue
        hold = holds(p)[s.hold[i]]
        limb = limbs(p)[i]
        px, py = port_of(limb, s)
        at = 1 + 5 * s.branch[i]
        for joint in range(2):
            limit = limb.limit1 if joint == 0 else limb.limit2
            gx = (hold.y - (py if joint == 0 else s.solved[i, at + 2])) / limit
            gy = -(hold.x - (px if joint == 0 else s.solved[i, at + 1])) / limit
            m[column, column] += gx * gx
            m[column, column + 1] += gx * gy
            m[column + 1, column] += gx * gy
            m[column + 1, column + 1] += gy * gy
        m[column, column] += 1e-14  # a stretched limb has no torque along its line
        m[column + 1, column + 1] += 1e-14
        m[column, 2 * k] = 1.0
        m[column + 1, 2 * k + 1] = 1.0
        m[column, 2 * k + 2] = -(hold.y - s.y)
        m[column + 1, 2 * k + 2] = hold.x - s.x
        for j in range(3):
            m[2 * k + j, column] = m[column, 2 * k + j]
            m[2 * k + j, column + 1] = m[column + 1, 2 * k + j]
        column += 2
    m[2 * k + 1, d] = weight
    for i in range(d):
        pivot = i
        for j in range(i + 1, d):
            if abs(m[j, i]) > abs(m[pivot, i]):
                pivot = j
        if abs(m[pivot, i]) < 1e-16:
            return False
        for j in range(i, d + 1):
            m[i, j], m[pivot, j] = m[pivot, j], m[i, j]
        for j in range(d):
            if j != i:
                factor = m[j, i] / m[i, i]
                for l in range(i, d + 1):  # noqa: E741
                    m[j, l] -= factor * m[i, l]
    column = 0
    for i in range(n):
        if carriers & (1 << i):
            forces[i, 0] = m[column, d] / m[column, column]
            forces[i, 1] = m[column + 1, d] / m[column + 1, column + 1]
            column += 2
    return True


def work_size(n_limbs: int, n_ports: int) -> int:
    """Floats of scratch that the kernels of a robot with `n_limbs` limbs need."""
    d = 2 * n_limbs + 3
    most = 6 + n_limbs * (8 + CORNERS)
    return int(64 + 2 * n_ports + most * d + most + 3 * d + (d + 1) * (most + 2 * d + 1) + np.int64(d * (d + 1)))
