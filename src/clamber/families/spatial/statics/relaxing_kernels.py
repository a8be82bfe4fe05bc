"""Forces that are good enough, without a programme: a point of the equations is moved off the constraint that it violates most.

The relaxation of Agmon (1954) and of Motzkin and Schoenberg (1954) within the plane of the equations: whether forces with a share `need` of
all limits left exist is most often plain, and a few steps from the smallest forces that balance show it for a tenth of what the linear
programme takes. Where they don't, the programme decides, so that no verdict depends on them.
"""

import math

from ....compiled import kernel

STEPS = 12
"""Constraints that the forces are moved off, at most."""
FURTHER = 1.6
"""A step goes so much farther than to where the constraint holds [-]."""
SPARE = 0.02
"""Share that a step aims at beyond the need."""
SURE = 1e-9
"""What counts as reached lies so far beyond the need: rounding of the equations."""
FLAT = 1e-9
"""Smallest pivot of the equations' Gram matrix: those of two point contacts have one of none."""


@kernel
def factor_gram(work, n):
    """Factor the Gram matrix of the equations (Cholesky, in `gram`); False if they depend on each other."""
    gram, balance = work.gram, work.balance
    for i in range(6):
        for j in range(i + 1):
            total = 0.0
            for k in range(n):
                total += balance[i, k] * balance[j, k]
            gram[i, j] = total
    for j in range(6):
        for i in range(j, 6):
            total = gram[i, j]
            for k in range(j):
                total -= gram[i, k] * gram[j, k]
            if i > j:
                gram[i, j] = total / gram[j, j]
            elif total < FLAT:
                return False
            else:
                gram[j, j] = math.sqrt(total)
    return True


@kernel
def solve_gram(work):
    """Solve the factored Gram matrix for the right side in `six`, which becomes the solution."""
    gram, six = work.gram, work.six
    for i in range(6):
        total = six[i]
        for k in range(i):
            total -= gram[i, k] * six[k]
        six[i] = total / gram[i, i]
    for i in range(5, -1, -1):
        total = six[i]
        for k in range(i + 1, 6):
            total -= gram[k, i] * six[k]
        six[i] = total / gram[i, i]


@kernel
def tightest(robot, work, weight):
    """Least share that the forces in `solution` leave of any limit, with its limb and row: rows of the contact, then motors.

    The share's slope over the wrench of that limb is left in `full`.
    """
    least, limb_of, row_of, sign = math.inf, -1, -1, 0.0
    solution = work.solution
    size = robot.size
    at = 0
    for limb in range(robot.n_limbs):
        components = robot.components[limb]
        bears = work.bears[limb]
        if bears:
            mu, pull = work.friction[limb], work.pull[limb]
            for i in range(robot.n_rows[limb]):
                limit, slack = robot.limit[limb, i], robot.slack[limb, i]
                room = limit[0] + limit[1] * pull + limit[2] * mu * pull
                for c in range(components):
                    unit = weight if c < 3 else weight * size
                    room -= (robot.row[limb, i, c] + mu * robot.row_friction[limb, i, c]) * unit * solution[at + c]
                share = room / (slack[0] * weight + slack[1])
                if share < least:
                    least, limb_of, row_of = share, limb, i
        for k in range(robot.n_joints[limb]):
            part = work.load[limb, k] / robot.torque[limb, k]
            if bears:
                for c in range(components):
                    unit = weight if c < 3 else weight * size
                    part += work.lever[limb, k, c] * unit * solution[at + c]
            share = 1.0 - abs(part)
            if share < least:
                least, limb_of, row_of = share, limb, robot.n_rows[limb] + k
                sign = -1.0 if part > 0.0 else 1.0
        if bears:
            at += components
    if work.bears[limb_of]:
        rows = robot.n_rows[limb_of]
        for c in range(robot.components[limb_of]):
            unit = weight if c < 3 else weight * size
            if row_of < rows:
                slack = robot.slack[limb_of, row_of]
                row = robot.row[limb_of, row_of, c] + work.friction[limb_of] * robot.row_friction[limb_of, row_of, c]
                work.full[c] = -row * unit / (slack[0] * weight + slack[1])
            else:
                work.full[c] = sign * work.lever[limb_of, row_of - rows, c] * unit
    return least, limb_of


@kernel
def relax_forces(robot, work, weight, need, steps, n):
    """Seek forces in `solution` that balance and leave `need` of every limit, after `fill_balance` and before its equations are solved.

    Args:
        robot, work: Robot and scratch; `weigh` and `fill_balance` came before.
        weight: Unit of forces [N].
        need: Share of all limits.
        steps: Constraints that the forces are moved off, at most.
        n: Unknowns.

    Returns:
        A share of all limits that they leave, at least the need; less than it where no forces can leave more; -infinity: not found.
    """
    balance, solution, six = work.balance, work.solution, work.six
    if n < 6 or not factor_gram(work, n):
        return -math.inf
    for i in range(6):
        six[i] = balance[i, n]
    solve_gram(work)
    for j in range(n):
        total = 0.0
        for i in range(6):
            total += balance[i, j] * six[i]
        solution[j] = total
    for _ in range(steps):
        least, limb = tightest(robot, work, weight)
        if least >= need + SURE:
            return least
        if not work.bears[limb]:
            return min(least, need - SURE)
        first = 0
        for i in range(limb):
            if work.bears[i]:
                first += robot.components[i]
        slope = work.full
        square = 0.0
        components = robot.components[limb]
        for i in range(6):
            total = 0.0
            for c in range(components):
                total += balance[i, first + c] * slope[c]
            six[i] = total
        for c in range(components):
            square += slope[c] * slope[c]
        solve_gram(work)
        inner = square
        for i in range(6):  # what the equations leave of the slope: its square is what they take off
            for c in range(components):
                inner -= six[i] * balance[i, first + c] * slope[c]
        if inner <= 1e-9 * square:
            return -math.inf
        step = FURTHER * (need + SPARE - least) / inner
        for j in range(n):
            total = 0.0
            for i in range(6):
                total += balance[i, j] * six[i]
            solution[j] -= step * total
        for c in range(components):
            solution[first + c] += step * slope[c]
    least, _ = tightest(robot, work, weight)
    return least if least >= need + SURE else -math.inf
