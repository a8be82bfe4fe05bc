"""A small dense linear programme, solved without allocation: the largest c.x with A x <= b, x free (within a box)."""

from clamber.compiled import kernel

BOX = 1.0e4
"""Bound on every |x|; callers scale their unknowns to the order of one."""


@kernel
def maximise(a, b, c, table, basis, x):
    """Simplex method on the dual, which starts feasible from the box; Bland's rule, so it ends.

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
    for i in range(d):
        sign = 1.0 if c[i] >= 0.0 else -1.0
        for j in range(m):
            table[i, j] = sign * a[j, i]
        for j in range(d):
            table[i, m + j] = sign if j == i else 0.0
            table[i, m + d + j] = -sign if j == i else 0.0
        table[i, n] = sign * c[i]
        basis[i] = m + i if sign > 0.0 else m + d + i
    for j in range(n + 1):
        cost = 0.0
        if j < m:
            cost = b[j]
        elif j < n:
            cost = BOX
        for i in range(d):
            cost -= BOX * table[i, j]
        table[d, j] = cost
    for _ in range(200 * (n + d)):
        enter = -1
        for j in range(n):
            if table[d, j] < -1e-9:
                enter = j
                break
        if enter < 0:
            break
        leave = -1
        best = 0.0
        for i in range(d):
            if table[i, enter] > 1e-11:
                ratio = table[i, n] / table[i, enter]
                if leave < 0 or ratio < best - 1e-14 or (ratio <= best + 1e-14 and basis[i] < basis[leave]):
                    leave = i
                    best = ratio
        if leave < 0:
            return False
        scale = 1.0 / table[leave, enter]
        for j in range(n + 1):
            table[leave, j] *= scale
        for i in range(d + 1):
            if i != leave:
                factor = table[i, enter]
                if factor != 0.0:
                    for j in range(n + 1):
                        table[i, j] -= factor * table[leave, j]
        basis[leave] = enter
    for i in range(d):
        x[i] = BOX - table[d, m + i]
    for j in range(m):  # the answer proves itself
        left = -b[j]
        for i in range(d):
            left += a[j, i] * x[i]
        if left > 1e-6:
            return False
    return True
