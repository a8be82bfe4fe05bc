"""A small dense linear programme, solved without allocation: the largest c.x with A x <= b, x free (within a box)."""

import math

from ....compiled import kernel

BOX = 1.0e4
"""Bound on every |x|; callers scale their unknowns to the order of one."""
TINY = 1.0e-9
"""Smallest pivot."""
SLACK = 1.0e-10
"""The violation of a row that counts as none; ten times as much each time that the rows seem to contradict each other."""
REFUSALS = 3
"""So often they must, before that is believed: by rounding, the two rows of an equality contradict each other a little."""
ROUNDS = 6
"""How often the table may be made anew from its basis."""


@kernel
def fill(a, b, c, table):
    """The table of the dual programme with the box's corner as its basis: a column per row of `a`, two per unknown, the right side."""
    m, d = a.shape
    n = m + 2 * d
    for i in range(d):
        sign = 1.0 if c[i] >= 0.0 else -1.0
        for j in range(m):
            table[i, j] = sign * a[j, i]
        for j in range(d):
            table[i, m + j] = sign if j == i else 0.0
            table[i, m + d + j] = -sign if j == i else 0.0
        table[i, n] = sign * c[i]
    for j in range(n + 1):
        cost = 0.0
        if j < m:
            cost = b[j]
        elif j < n:
            cost = BOX
        for i in range(d):
            cost -= BOX * table[i, j]
        table[d, j] = cost


@kernel
def pivot(table, d, n, row, column):
    """Make `column` a unit vector with its one in `row`."""
    scale = 1.0 / table[row, column]
    for j in range(n + 1):
        table[row, j] *= scale
    for i in range(d + 1):
        factor = table[i, column]
        if i != row and factor != 0.0:
            for j in range(n + 1):
                table[i, j] -= factor * table[row, j]


@kernel
def improve(table, basis, d, n, slack):
    """Pivot until no row is violated: the most violated one first, by Bland's rule after a while, so it ends.

    Returns:
        False if the rows contradict each other.
    """
    for turn in range(200 * (n + d)):
        bland = turn >= 20 * d
        enter = -1
        worst = -slack
        for j in range(n):
            if table[d, j] < worst:
                enter = j
                worst = table[d, j]
                if bland:
                    break
        if enter < 0:
            return True
        best = math.inf
        for i in range(d):
            if table[i, enter] > TINY:
                best = min(best, max(table[i, n], 0.0) / table[i, enter])
        leave = -1
        for i in range(d):
            size = table[i, enter]
            if size <= TINY or max(table[i, n], 0.0) > (best + 1e-12) * size:
                continue
            # of equals the largest pivot: small ones spoil the table
            if leave < 0 or (basis[i] < basis[leave] if bland else size > table[leave, enter]):
                leave = i
        if leave < 0:
            return False
        pivot(table, d, n, leave, enter)
        basis[leave] = enter
    return False


@kernel
def renew(a, b, c, table, basis, columns, slack):
    """Make the table of a basis anew from the data, without the rounding errors of the pivots that led there.

    Returns:
        Whether the basis still violates no row.
    """
    m, d = a.shape
    n = m + 2 * d
    fill(a, b, c, table)
    for i in range(d):
        columns[i] = basis[i]
        basis[i] = -1.0
    for q in range(d):
        column = int(columns[q])
        row = -1
        for i in range(d):
            if basis[i] < 0.0 and (row < 0 or abs(table[i, column]) > abs(table[row, column])):
                row = i
        pivot(table, d, n, row, column)
        basis[row] = column
    least = 0.0
    for j in range(n):
        least = min(least, table[d, j])
    return least >= -slack


@kernel
def maximise(a, b, c, table, basis, x):
    """Simplex method on the dual, which starts feasible from the box.

    Args:
        a: Rows of the constraints, shape (m, d).
        b: Right-hand sides, shape (m,).
        c: Objective, shape (d,).
        table: Scratch, shape (d + 1, m + 2 d + 1) or larger.
        basis: Scratch, shape (d,).
        x: The answer, shape (d,).

    Returns:
        True if the constraints can be met; x is then the answer.
    """
    m, d = a.shape
    n = m + 2 * d
    fill(a, b, c, table)
    for i in range(d):
        basis[i] = m + i if c[i] >= 0.0 else m + d + i
    refused = 0
    slack = SLACK
    for _ in range(ROUNDS):
        met = improve(table, basis, d, n, slack)
        if not met:
            refused += 1
            slack *= 10.0
            if refused == REFUSALS:
                return False
        if renew(a, b, c, table, basis, x, slack) and met:
            break
    for i in range(d):
        x[i] = BOX - table[d, m + i]
    for j in range(m):  # the answer proves itself
        left = -b[j]
        size = 1.0
        for i in range(d):
            left += a[j, i] * x[i]
            size += abs(a[j, i] * x[i])
        if left > 1e-7 * size:
            return False
    return True
