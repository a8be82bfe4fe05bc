"""The linear programme of a stance: solve six equations for six unknowns, then the largest s within all rows.

What is left after elimination has `d` free unknowns z: max s with `columns^T z + s <= bound` and |z| <= `BOX`. It is solved as the primal
simplex of its dual, whose first basis is free of charge: the row of the smallest bound and a side of the box for each unknown. Every point
that it visits bounds s from both sides, so that it may end as soon as a need is decided.
"""

import math

from ....compiled import kernel

BOX = 50.0
"""Largest free unknown, in units of the programme: no force in a contact is larger than 50 times the robot's weight."""
MOST_PIVOTS = 300
"""A solution in more ends with the bounds found; 20 are usual."""
PATIENT = 40
"""Pivots without progress after which Bland's rule, slower but free of cycles, chooses."""
SINGULAR = 1e-9
UNBALANCED = 1e-7
"""Of an equation that no unknown is left in [1], in parts of the weight."""
OPTIMAL = 1e-10
SMALLEST_PIVOT = 1e-8
"""Smaller ones are rounding: postures are solved to parts in a million, and a basis turned on such a pivot is next to singular."""
ABREAST = 4
"""Unknowns whose terms are added in one go, in their order: sums are read and written that much less often."""
FEASIBLE = 1e-9
"""How far below zero a multiplier of the dual may fall, so that a larger pivot can be had."""


@kernel
def eliminate(work, n):
    """Solve `balance` (6 equations, n unknowns, right side in column n) for as many unknowns as it has rank, by full pivoting.

    Returns:
        The rank; -1 if what is left contradicts itself, so that no forces balance. `free` numbers the unknowns that are left, from 0, and
        holds -1 - row for the others.
    """
    balance = work.balance
    free = work.free
    for j in range(n):
        free[j] = 0
    rank = 0
    for row in range(6):
        best = SINGULAR
        bi, bj = -1, -1
        for i in range(row, 6):
            for j in range(n):
                if free[j] == 0 and abs(balance[i, j]) > best:
                    best = abs(balance[i, j])
                    bi, bj = i, j
        if bi < 0:
            break
        if bi != row:
            for j in range(n + 1):
                balance[row, j], balance[bi, j] = balance[bi, j], balance[row, j]
        free[bj] = -1 - row
        work.pivot[row] = bj
        rank = row + 1
        inverse = 1.0 / balance[row, bj]
        for j in range(n + 1):
            balance[row, j] *= inverse
        for i in range(6):
            factor = balance[i, bj]
            if i != row and factor != 0.0:
                for j in range(n + 1):
                    balance[i, j] -= factor * balance[row, j]
    for i in range(rank, 6):
        if abs(balance[i, n]) > UNBALANCED:
            return -1
    d = 0
    for j in range(n):
        if free[j] >= 0:
            free[j] = d
            d += 1
    return rank


@kernel
def leaving(work, size, bland):
    """Place of the basis that the entering row takes, -1 if none: of those that reach zero first, within `FEASIBLE`, the largest pivot.

    The ratio test of Harris (1973). With `bland` it is the first to reach zero, of several the one with the lowest number.
    """
    entering, dual, basis = work.entering, work.dual, work.basis
    most, leave = math.inf, -1
    if bland:
        for i in range(size):
            if entering[i] > SMALLEST_PIVOT:
                ratio = dual[i] / entering[i]
                if ratio < most or (ratio == most and basis[i] < basis[leave]):
                    most, leave = ratio, i
        return leave
    for i in range(size):  # without branches, which nothing would foresee
        ratio = (dual[i] + FEASIBLE) / max(entering[i], SMALLEST_PIVOT)
        most = min(most, ratio if entering[i] > SMALLEST_PIVOT else math.inf)
    largest = SMALLEST_PIVOT
    for i in range(size):
        if (entering[i] > largest) & (dual[i] <= most * entering[i]):
            largest, leave = entering[i], i
    return leave


@kernel
def maximise(work, m, d, need):
    """Largest s of the programme in `columns` and `bound` (m rows, d unknowns), or bounds of it as soon as they decide `s >= need`.

    Returns:
        Lower bound of s, upper bound, pivots. Equal at the optimum; the lower one is kept by `point`.
    """
    columns, bound, residual = work.columns, work.bound, work.residual
    inverse, dual, basis = work.inverse, work.dual, work.basis
    point, price, entering = work.point, work.price, work.entering
    size = d + 1
    first = 0
    for i in range(m):
        if bound[i] < bound[first]:
            first = i
    for i in range(size):
        for j in range(size):
            inverse[i, j] = 0.0
    basis[0] = first
    dual[0] = 1.0
    inverse[d, 0] = 1.0
    price[d] = bound[first]
    for k in range(d):
        a = columns[k, first]
        side = -1.0 if a > 0.0 else 1.0
        basis[k + 1] = m + 2 * k + (1 if a > 0.0 else 0)
        inverse[k, k + 1] = side
        inverse[d, k + 1] = -side * a
        dual[k + 1] = abs(a)
        price[k] = side * BOX
        price[d] += abs(a) * BOX
    lower, upper = -math.inf, math.inf
    still = 0
    for pivot in range(MOST_PIVOTS):
        s = price[d]
        upper = min(upper, s)
        if upper < need:
            return lower, upper, pivot
        for i in range(m):
            residual[i] = bound[i]
        k = 0
        while k + ABREAST <= d:
            z0, z1, z2, z3 = price[k], price[k + 1], price[k + 2], price[k + 3]
            for i in range(m):
                left = residual[i] - columns[k, i] * z0 - columns[k + 1, i] * z1
                residual[i] = left - columns[k + 2, i] * z2 - columns[k + 3, i] * z3
            k += ABREAST
        while k < d:
            z = price[k]
            for i in range(m):
                residual[i] -= columns[k, i] * z
            k += 1
        outside = False
        worst, enter = math.inf, -1
        for i in range(m):
            if residual[i] < worst:
                worst = residual[i]
                enter = i
        least = worst
        worst -= s
        for k in range(d):
            room = BOX - abs(price[k])
            if room < -OPTIMAL:
                outside = True
                if room < worst:
                    worst = room
                    enter = m + 2 * k + (0 if price[k] > 0.0 else 1)
        if not outside and least > lower:
            lower = least
            for k in range(d):
                point[k] = price[k]
            if lower >= need:
                return lower, upper, pivot
        if worst >= -OPTIMAL:
            return lower, upper, pivot
        if still > PATIENT:  # Bland: the first that would enter
            enter = -1
            for i in range(m):
                if residual[i] - s < -OPTIMAL:
                    enter = i
                    break
            if enter < 0:
                for k in range(d):
                    if BOX - abs(price[k]) < -OPTIMAL:
                        enter = m + 2 * k + (0 if price[k] > 0.0 else 1)
                        break
        if enter < m:
            gap = residual[enter] - s
            for i in range(size):
                entering[i] = inverse[d, i]
            k = 0
            while k + ABREAST <= d:
                a0, a1 = columns[k, enter], columns[k + 1, enter]
                a2, a3 = columns[k + 2, enter], columns[k + 3, enter]
                for i in range(size):
                    total = entering[i] + inverse[k, i] * a0 + inverse[k + 1, i] * a1
                    entering[i] = total + inverse[k + 2, i] * a2 + inverse[k + 3, i] * a3
                k += ABREAST
            while k < d:
                a = columns[k, enter]
                for i in range(size):
                    entering[i] += inverse[k, i] * a
                k += 1
        else:
            k = (enter - m) >> 1
            side = 1.0 if (enter - m) & 1 == 0 else -1.0
            gap = BOX - side * price[k]
            for i in range(size):
                entering[i] = side * inverse[k, i]
        leave = leaving(work, size, still > PATIENT)
        if leave < 0:  # only by rounding: the box bounds the dual
            return lower, upper, pivot
        ratio = dual[leave] / entering[leave]
        still = still + 1 if ratio * -gap < 1e-14 else 0
        scale = 1.0 / entering[leave]
        for j in range(size):
            pivoted = inverse[j, leave] * scale
            if pivoted != 0.0:
                for i in range(size):
                    inverse[j, i] -= entering[i] * pivoted
            inverse[j, leave] = pivoted
            price[j] += gap * pivoted
        for i in range(size):
            dual[i] = max(dual[i] - ratio * entering[i], 0.0)
        dual[leave] = ratio
        basis[leave] = enter
    return lower, upper, MOST_PIVOTS
