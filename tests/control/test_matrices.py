"""The small linear algebra of the kernels against NumPy's."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from clamber.control.inverse_motion import invert_motion
from clamber.control.matrices import back_substitute, factor, smallest_singular, solve_square
from clamber.types import Floats

SIZES = st.integers(1, 7)
SEEDS = st.integers(0, 10_000)


def room(matrix: Floats) -> Floats:
    """The matrix in a corner of a larger array, as the kernels have it."""
    out = np.full((9, 9), np.nan)
    out[: matrix.shape[0], : matrix.shape[1]] = matrix
    return out


@given(seed=SEEDS, n=SIZES)
def test_a_square_system_is_solved(seed: int, n: int) -> None:
    rng = np.random.default_rng(seed)
    matrix, right = rng.normal(size=(n, n)), rng.normal(size=n)
    vector = right.copy()
    assert solve_square(room(matrix), n, vector)
    np.testing.assert_allclose(matrix @ vector, right, atol=1e-12 * np.linalg.cond(matrix))


def test_a_singular_system_says_so() -> None:
    assert not solve_square(room(np.zeros((3, 3))), 3, np.ones(3))
    indefinite = room(np.diag((1.0, -1.0)))
    assert not factor(indefinite, 2, indefinite)


@given(seed=SEEDS, n=SIZES)
def test_a_positive_matrix_is_factored_and_solved(seed: int, n: int) -> None:
    rng = np.random.default_rng(seed)
    half = rng.normal(size=(n, n))
    matrix, right = half @ half.T + 0.1 * np.eye(n), rng.normal(size=n)
    upper, vector = room(matrix), right.copy()
    assert factor(upper, n, upper)
    triangle = np.triu(upper[:n, :n])
    np.testing.assert_allclose(triangle.T @ triangle, matrix, atol=1e-12)
    back_substitute(upper, n, vector)
    np.testing.assert_allclose(matrix @ vector, right, atol=1e-11)


@given(
    seed=SEEDS,
    rows=st.integers(1, 6),
    more=st.integers(0, 3),
    small=st.sampled_from([1.0, 1e-3, 1e-6, 1e-12, 0.0]),
    alike=st.integers(0, 6),
    scale=st.sampled_from([1e-3, 1.0, 1e3]),
)
def test_the_smallest_singular_value_is_numpys(
    seed: int, rows: int, more: int, small: float, alike: int, scale: float
) -> None:
    rng = np.random.default_rng(seed)
    left, values, right = np.linalg.svd(rng.normal(size=(rows, rows + more)), full_matrices=False)
    values[max(0, rows - alike) :] *= 0.0
    values[max(0, rows - alike) :] += small  # of several that are the same, too
    matrix = scale * (left * values @ right)
    found = smallest_singular(room(matrix), rows, rows + more, np.empty((9, 9)))
    wanted, largest = scale * values.min(), scale * values.max()
    # by the Gram matrix, so its square has the digits; several equal values cost three of them
    assert found**2 == pytest.approx(wanted**2, rel=0, abs=1e-12 * largest**2)


def test_more_rows_than_joints_are_singular() -> None:
    assert smallest_singular(room(np.ones((3, 2))), 3, 2, np.empty((9, 9))) == 0.0


@given(seed=SEEDS, rows=st.integers(1, 6), more=st.integers(0, 3), lambda2=st.sampled_from([0.0, 0.01, 1.0]))
def test_the_damped_inverse_is_the_least_of_its_cost(seed: int, rows: int, more: int, lambda2: float) -> None:
    # |T x - a|^2 + lambda^2 x' W x has its least where its slope is zero; undamped, T x = a and x is across W's null space
    rng = np.random.default_rng(seed)
    n = rows + more
    task, share, wanted = rng.normal(size=(rows, n)), rng.uniform(0.1, 1.0, n), rng.normal(size=rows)
    out = np.empty(n)
    invert_motion(room(task), (rows, n), share, lambda2, wanted, (np.empty((9, 9)), np.empty(9)), out)
    condition = np.linalg.cond(task) ** 2 / share.min()
    slope = task.T @ (task @ out - wanted) + lambda2 * share * out
    np.testing.assert_allclose(slope, 0.0, atol=1e-13 * condition)
    if lambda2 == 0.0:
        np.testing.assert_allclose(task @ out, wanted, atol=1e-13 * condition)
    null = np.linalg.svd(task)[2][rows:]
    np.testing.assert_allclose(null @ (share * out), 0.0, atol=1e-13 * condition)
