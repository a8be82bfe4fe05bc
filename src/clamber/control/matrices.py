"""Small dense linear algebra, as kernels: what a law needs for a handful of joints, in place and without allocating."""

import math

from ..compiled import inlined, kernel

SWEEPS = 12
"""Jacobi sweeps at most; six rows settle in five."""


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
def factor(matrix, size):
    """Cholesky factor in the lower half, in place; False if `matrix` is not positive definite."""
    for j in range(size):
        total = matrix[j, j]
        for k in range(j):
            total -= matrix[j, k] * matrix[j, k]
        if not total > 0.0:
            return False
        root = math.sqrt(total)
        matrix[j, j] = root
        for i in range(j + 1, size):
            total = matrix[i, j]
            for k in range(j):
                total -= matrix[i, k] * matrix[j, k]
            matrix[i, j] = total / root
    return True


@inlined
def back_substitute(lower, size, vector):
    """Solve L L^T x = `vector` in place, with L from `factor`."""
    for i in range(size):
        total = vector[i]
        for k in range(i):
            total -= lower[i, k] * vector[k]
        vector[i] = total / lower[i, i]
    for i in range(size - 1, -1, -1):
        total = vector[i]
        for k in range(i + 1, size):
            total -= lower[k, i] * vector[k]
        vector[i] = total / lower[i, i]


@kernel
def smallest_singular(rows, n_rows, n_columns, gram):
    """Smallest singular value of `rows`, by Jacobi rotations of its Gram matrix; 0 where there are more rows than columns.

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
    for _ in range(SWEEPS):
        off = 0.0
        size = 0.0
        for i in range(n_rows):
            size += gram[i, i] * gram[i, i]
            for j in range(i):
                off += gram[i, j] * gram[i, j]
        if off <= 1e-30 * size:
            break
        for i in range(n_rows):
            for j in range(i):
                if gram[i, j] == 0.0:
                    continue
                # the tangent of the smaller of two angles that make this entry zero
                cotangent = 0.5 * (gram[j, j] - gram[i, i]) / gram[i, j]
                tangent = math.copysign(1.0, cotangent) / (abs(cotangent) + math.sqrt(1.0 + cotangent * cotangent))
                c = 1.0 / math.sqrt(1.0 + tangent * tangent)
                s = c * tangent
                for k in range(n_rows):
                    a = gram[k, i]
                    b = gram[k, j]
                    gram[k, i] = c * a - s * b
                    gram[k, j] = s * a + c * b
                for k in range(n_rows):
                    a = gram[i, k]
                    b = gram[j, k]
                    gram[i, k] = c * a - s * b
                    gram[j, k] = s * a + c * b
    least = gram[0, 0]
    for i in range(1, n_rows):
        least = min(least, gram[i, i])
    return math.sqrt(max(0.0, least))
