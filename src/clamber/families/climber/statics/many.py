"""Three or more carriers: the split of least torque and the `hook` margin as linear programmes (page "The model", sections 7 and 8).

Both are sought over the branches of all carriers, by branch and bound: a limb whose branch is still undecided counts with its shoulder,
its hold and its strength, which are the same in both, and neither with its elbow nor with the direction of its hook.
"""

import math

import numpy as np

from ....compiled import inlined, kernel
from .pose import joint_torques, port_of, take_branch, usable
from .programme import maximise
from .records import LIMBS, holds, limbs, work

CUT, UNCUT, SLACK, NORM = 0, 1, 2, 3
"""Goals of a split: the least largest |torque|/limit within the cuts, the same without them, the largest slack of the cuts with torques
and strengths within limits (the `hook` margin), the least sum of squares of torque/limit."""
UNDECIDED = -1
"""Branch of a limb that may still have either."""
BETTER = 1.0e-7
"""By how much a value must be better for other branches to be taken, in units of the torque limits or of the weight."""
CORNERS = 16
"""Sides of the polygon that stands for the strength of a hold or an end effector."""


@kernel
def cone_rows(a, row, column, axis, cone, slack, last):
    """Two rows: -F of columns (column, column + 1) within a cone, its cosine and sine, about an axis, with slack in column `last`."""
    mx, my = axis
    c_cone, s_cone = cone
    for side in range(2):
        turn = c_cone if side == 0 else -c_cone
        a[row, column] = mx * s_cone - my * turn
        a[row, column + 1] = my * s_cone + mx * turn
        a[row, last] = slack
        row += 1
    return row


@inlined
def _balance_rows(a, s, hold, column):
    """Six rows: what a hold's force brings to the body, an equality as two inequalities."""
    for sign in range(2):
        e = 1.0 if sign == 0 else -1.0
        a[sign, column] = e
        a[2 + sign, column + 1] = e
        a[4 + sign, column] = -e * (hold.y - s.y)
        a[4 + sign, column + 1] = e * (hold.x - s.x)


@inlined
def _torque_rows(rows, row, column, s, i, ends, goal, last):
    """Two rows a joint: the motors of limb `i` within their limits, or within what is made least; the next row."""
    a, b = rows
    limb, hold, weight = ends
    px, py = port_of(limb, s)
    branch_at = 1 + 5 * s.branch[i]
    for joint in range(1 if s.branch[i] == UNDECIDED else 2):
        rx = hold.x - (px if joint == 0 else s.solved[i, branch_at + 1])
        ry = hold.y - (py if joint == 0 else s.solved[i, branch_at + 2])
        scale = weight / (limb.limit1 if joint == 0 else limb.limit2)
        for sign in range(2):
            e = scale if sign == 0 else -scale
            a[row, column] = e * ry
            a[row, column + 1] = -e * rx
            if goal == SLACK:
                b[row] = 1.0
            else:
                a[row, last] = -1.0
            row += 1
    return row


@inlined
def _cut_rows(rows, row, column, s, i, ends, goal, last):
    """Rows of what limb `i`'s end and its hold can bear: cones, least pull, strength; the next row."""
    a, b = rows
    limb, hold, weight = ends
    slack = 1.0 if goal == SLACK else 0.0
    branch_at = 1 + 5 * s.branch[i]
    if limb.c_cone > -1.5 and s.branch[i] != UNDECIDED:
        gx = s.solved[i, branch_at + 3]
        gy = s.solved[i, branch_at + 4]
        row = cone_rows(a, row, column, (gx, gy), (limb.c_cone, limb.s_cone), slack, last)
        if limb.pull > 0.0:
            a[row, column] = gx
            a[row, column + 1] = gy
            a[row, last] = slack
            b[row] = -limb.pull / weight
            row += 1
    if hold.c_cone > -1.5:
        row = cone_rows(a, row, column, (hold.dir_x, hold.dir_y), (hold.c_cone, hold.s_cone), slack, last)
    strength = min(hold.strength, limb.strength)
    if strength < math.inf:
        for side in range(CORNERS):
            angle = (2 * side + 1) * math.pi / CORNERS
            a[row, column] = math.cos(angle)
            a[row, column + 1] = math.sin(angle)
            b[row] = strength / weight * math.cos(math.pi / CORNERS)
            row += 1
    return row


@kernel
def many_split(p, s, carriers, goal, forces):
    """The split of three or more carriers in their branches by linear programme, in units of the weight.

    Args:
        p, s: Parameters and stance.
        carriers: Bit set of the carrying limbs.
        goal: `CUT`, `UNCUT` or `SLACK`.
        forces: Where the forces of the holds on the limbs go [N], shape (LIMBS, 2).

    Returns:
        Whether a split exists, and the optimum [of the limits, or of the weight].
    """
    n = p.n_limbs
    weight = p.weight
    k = 0
    for i in range(n):
        if carriers & (1 << i):
            k += 1
    d = 2 * k + 1
    last = 2 * k
    most = 6 + k * (9 + CORNERS)
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
    a[:] = 0.0
    b[:] = 0.0
    c[:] = 0.0
    c[last] = 1.0 if goal == SLACK else -1.0
    column = 0
    row = 6
    b[2] = 1.0
    b[3] = -1.0
    for i in range(n):
        if carriers & (1 << i):
            hold = holds(p)[s.hold[i]]
            limb = limbs(p)[i]
            _balance_rows(a, s, hold, column)
            ends = limb, hold, weight
            row = _torque_rows((a, b), row, column, s, i, ends, goal, last)
            if goal != UNCUT:
                row = _cut_rows((a, b), row, column, s, i, ends, goal, last)
            column += 2
    if not maximise(a[:row], b[:row], c, table, basis, x):
        return False, 0.0
    column = 0
    for i in range(n):
        if carriers & (1 << i):
            forces[i, 0] = weight * x[column]
            forces[i, 1] = weight * x[column + 1]
            column += 2
    return True, x[last]


@kernel
def many_least_norm(p, s, carriers, forces):
    """The split of three or more carriers in their branches with the smallest sum of (torque / limit)^2: the normal equations.

    Returns:
        Whether a split exists, and that sum.
    """
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
        for joint in range(1 if s.branch[i] == UNDECIDED else 2):
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
            return False, 0.0
        for j in range(i, d + 1):
            m[i, j], m[pivot, j] = m[pivot, j], m[i, j]
        for j in range(d):
            if j != i:
                factor = m[j, i] / m[i, i]
                for l in range(i, d + 1):  # noqa: E741
                    m[j, l] -= factor * m[i, l]
    column = 0
    total = 0.0
    for i in range(n):
        if carriers & (1 << i):
            forces[i, 0] = m[column, d] / m[column, column]
            forces[i, 1] = m[column + 1, d] / m[column + 1, column + 1]
            t1, t2 = joint_torques(p, s, i, max(s.branch[i], 0), forces[i, 0], forces[i, 1])
            total += (t1 / limbs(p)[i].limit1) ** 2
            if s.branch[i] != UNDECIDED:
                total += (t2 / limbs(p)[i].limit2) ** 2
            column += 2
    return True, total


@inlined
def _value(p, s, carriers, goal, forces):
    """What a split in the branches of the stance comes to, infinity without one: less is better."""
    if goal == NORM:
        found, value = many_least_norm(p, s, carriers, forces)
    else:
        found, value = many_split(p, s, carriers, goal, forces)
    if not found:
        return math.inf
    return -value if goal == SLACK else value


@inlined
def _bend(s, carriers, n, branches):
    """Give the carriers their branches of a bit set."""
    for i in range(n):
        if carriers & (1 << i):
            s.branch[i] = (branches >> i) & 1


@inlined
def _next(undecided, i, way):
    """The next limb of a bit set after limb i, up (way 1) or down (-1); -1 or 32 beyond its ends."""
    i += way
    while 0 <= i < 32 and not undecided & (1 << i):
        i += way
    return i


@kernel
def best_many(p, s, carriers, goal, assignment, forces):
    """The best split of three or more carriers over the branches that they may use, by branch and bound; sets their branches.

    Those that are best where all carry the same weight straight down come first; others are taken where they are better.

    Args:
        p, s: Parameters and stance.
        carriers: Bit set of the carrying limbs.
        goal: `CUT`, `UNCUT`, `SLACK` or `NORM`.
        assignment: Of the elbows that are kept, or -1.
        forces: Where the forces of the holds on the limbs go [N], shape (LIMBS, 2).

    Returns:
        The optimum [of the limits, minus the slack in units of the weight, of the squared limits], less is better; infinity without a
        split.
    """
    n = p.n_limbs
    k = 0
    for i in range(n):
        k += (carriers >> i) & 1
    spare = work(p)[16:32].reshape((LIMBS, 2))
    undecided = 0
    preferred = 0
    for i in range(n):
        if carriers & (1 << i):
            options = usable(s, i, assignment)
            preferred |= take_branch(p, s, i, options, 0.0, p.weight / k) << i
            if options == 3:
                undecided |= 1 << i
    _bend(s, carriers, n, preferred)
    best = _value(p, s, carriers, goal, forces)
    if undecided == 0:
        return best
    chosen = preferred
    for i in range(n):
        if undecided & (1 << i):
            s.branch[i] = UNDECIDED
    last = _next(undecided, 32, -1)
    at = -1  # the limb decided last, by number
    if _value(p, s, carriers, goal, spare) < best - BETTER:
        at = _next(undecided, -1, 1)
        s.branch[at] = (preferred >> at) & 1
    while at >= 0:
        value = _value(p, s, carriers, goal, spare)
        if value < best - BETTER and at < last:
            at = _next(undecided, at, 1)
            s.branch[at] = (preferred >> at) & 1
            continue
        if value < best - BETTER:
            best = value
            chosen = preferred
            for i in range(n):
                if carriers & (1 << i):
                    chosen = chosen & ~(1 << i) | s.branch[i] << i
                    forces[i, 0] = spare[i, 0]
                    forces[i, 1] = spare[i, 1]
        while at >= 0 and s.branch[at] != (preferred >> at) & 1:  # both branches of this limb are done with
            s.branch[at] = UNDECIDED
            at = _next(undecided, at, -1)
        if at >= 0:
            s.branch[at] = 1 - s.branch[at]
    _bend(s, carriers, n, chosen)
    return best


def work_size(n_limbs: int, n_ports: int) -> int:
    """Floats of scratch that the kernels of a robot with `n_limbs` limbs need."""
    d = 2 * n_limbs + 3
    most = 6 + n_limbs * (9 + CORNERS)
    return int(64 + 2 * n_ports + most * d + most + 3 * d + (d + 1) * (most + 2 * d + 1) + np.int64(d * (d + 1)))
