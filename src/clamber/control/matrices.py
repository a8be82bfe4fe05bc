"""Small dense linear algebra, as kernels: what a law needs for a handful of joints, in place and without allocating."""

import math

from ..compiled import inlined, kernel

STEPS = 30
"""Of Laguerre's method at most; six rows settle in four to eight."""
NEAR = 1e-15
"""A step below this part of the largest entry is the last."""


@kernel
def solve_square(matrix, size, vector):
    """Solve `matrix` x = `vector` in place by elimination with row pivoting; False if a pivot is zero.

    Args:
        matrix: Shape (at least size, at least size); overwritten.
        size: Rows and columns that count.
        vector: Right side, then the solution.
    """
    for k in range(size):
        best = k
        for i in range(k + 1, size):
            if abs(matrix[i, k]) > abs(matrix[best, k]):
                best = i
        if matrix[best, k] == 0.0:
            return False
        if best != k:
            for j in range(k, size):
                matrix[k, j], matrix[best, j] = matrix[best, j], matrix[k, j]
            vector[k], vector[best] = vector[best], vector[k]
        for i in range(k + 1, size):
            part = matrix[i, k] / matrix[k, k]
            for j in range(k + 1, size):
                matrix[i, j] -= part * matrix[k, j]
            vector[i] -= part * vector[k]
    for k in range(size - 1, -1, -1):
        total = vector[k]
        for j in range(k + 1, size):
            total -= matrix[k, j] * vector[j]
        vector[k] = total / matrix[k, k]
    return True


@kernel
def factor(matrix, size, upper):
    """Cholesky factor U of a matrix U^T U, of which the lower half is read, into an upper half, its own or another's.

    Returns:
        False if the matrix is not positive definite.
    """
    for j in range(size):
        row = upper[j]
        for i in range(j, size):
            row[i] = matrix[i, j]
        for k in range(j):
            part, above = upper[k, j], upper[k]
            for i in range(j, size):
                row[i] -= above[i] * part
        if not row[j] > 0.0:
            return False
        row[j] = math.sqrt(row[j])
        for i in range(j + 1, size):
            row[i] /= row[j]
    return True


@inlined
def solve_transposed(upper, size, vector):
    """Solve U^T x = `vector` in place."""
    for k in range(size):
        vector[k] /= upper[k, k]
        for i in range(k + 1, size):
            vector[i] -= upper[k, i] * vector[k]


@inlined
def solve_upper(upper, size, vector):
    """Solve U x = `vector` in place."""
    for i in range(size - 1, -1, -1):
        for k in range(i + 1, size):
            vector[i] -= upper[i, k] * vector[k]
        vector[i] /= upper[i, i]


@inlined
def back_substitute(upper, size, vector):
    """Solve U^T U x = `vector` in place, with U from `factor`."""
    solve_transposed(upper, size, vector)
    solve_upper(upper, size, vector)


@kernel
def smallest_singular(rows, n_rows, n_columns, gram):
    """Smallest singular value of `rows`, by its Gram matrix; 0 where there are more rows than columns.

    Args:
        rows: Matrix, shape (at least n_rows, at least n_columns).
        n_rows, n_columns: What of it counts.
        gram: Scratch, overwritten.
    """
    if n_rows > n_columns:
        return 0.0
    for i in range(n_rows):
        for j in range(i + 1):
            total = 0.0
            for k in range(n_columns):
                total += rows[i, k] * rows[j, k]
            gram[i, j] = total
            gram[j, i] = total
    if n_rows == 1:
        return math.sqrt(gram[0, 0])
    if n_rows == 2:
        # the determinant of a square matrix itself loses half as many digits as that of its Gram matrix
        if n_columns == 2:
            product = abs(rows[0, 0] * rows[1, 1] - rows[0, 1] * rows[1, 0])
        else:
            product = math.sqrt(max(0.0, gram[0, 0] * gram[1, 1] - gram[0, 1] * gram[0, 1]))
        half = 0.5 * (gram[0, 0] + gram[1, 1])
        largest = half + math.hypot(0.5 * (gram[0, 0] - gram[1, 1]), gram[0, 1])
        return product / math.sqrt(largest) if largest > 0.0 else 0.0
    _tridiagonalise(gram, n_rows)
    return math.sqrt(_smallest_eigenvalue(gram, n_rows))


@kernel
def _tridiagonalise(matrix, size):
    """Reduce a symmetric matrix to its diagonal and the entries below it, in place, by Householder reflections; the rest is spent."""
    for k in range(size - 2):
        rest = 0.0
        for i in range(k + 2, size):
            rest += matrix[i, k] * matrix[i, k]
        if rest == 0.0:
            continue
        first = matrix[k + 1, k]
        off = -math.copysign(math.sqrt(first * first + rest), first)
        # the reflection's vector v stays in column k; w goes into row k; A becomes A - v w' - w v'
        matrix[k + 1, k] = first - off
        beta = 1.0 / (off * (off - first))
        along = 0.0
        for i in range(k + 1, size):
            total = 0.0
            for j in range(k + 1, size):
                total += matrix[i, j] * matrix[j, k]
            matrix[k, i] = beta * total
            along += matrix[k, i] * matrix[i, k]
        for i in range(k + 1, size):
            matrix[k, i] -= 0.5 * beta * along * matrix[i, k]
        for i in range(k + 1, size):
            for j in range(k + 1, size):
                matrix[i, j] -= matrix[i, k] * matrix[k, j] + matrix[k, i] * matrix[j, k]
        matrix[k + 1, k] = off


@kernel
def _smallest_eigenvalue(matrix, size):
    """Smallest eigenvalue of a tridiagonal matrix without negative ones, by Laguerre's steps on its characteristic polynomial.

    All roots are real, so from below, here from 0, the steps rise to the smallest root and cannot pass it (Wilkinson 1965).
    """
    largest = 0.0
    least = math.inf
    for i in range(size):
        largest = max(largest, matrix[i, i])
        least = min(least, matrix[i, i])
    at = 0.0
    for _ in range(STEPS):
        # the polynomial's value and two derivatives, by leading minors
        value, slope, bend = 1.0, 0.0, 0.0
        value_before, slope_before, bend_before = 0.0, 0.0, 0.0
        for i in range(size):
            here = (matrix[i, i] - at) / largest
            off = matrix[i, i - 1] / largest if i > 0 else 0.0
            off *= off
            next_value = here * value - off * value_before
            next_slope = here * slope - value - off * slope_before
            next_bend = here * bend - 2.0 * slope - off * bend_before
            value_before, slope_before, bend_before = value, slope, bend
            value, slope, bend = next_value, next_slope, next_bend
        if not (value > 0.0 and slope < 0.0):
            break  # on the root, up to rounding
        ratio = slope / value
        spread = (size - 1) * (size * (ratio * ratio - bend / value) - ratio * ratio)
        step = -size / (ratio - math.sqrt(max(0.0, spread)))
        at += step * largest
        if not at < least:
            return least  # no diagonal entry is below the smallest eigenvalue
        if step < NEAR:
            break
    return at
