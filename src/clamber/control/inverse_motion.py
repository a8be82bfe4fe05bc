r"""From a motion of the task to one of the joints: the weighted, damped inverse of the task Jacobian, as a kernel.

With T the task Jacobian, m rows by n joints, and W = diag(share) the joints' weights,

.. math:: \ddot q = W^{-1} T^T (T W^{-1} T^T + \lambda^2 E)^{-1} a,

which for m = n and no damping is T^-1 a whatever W is. lambda^2 grows from 0 where the smallest singular value sigma of T falls
below `settings.sigma`: lambda^2 = lambda2 (1 - (sigma / sigma_0)^2) (Nakamura and Hanafusa 1986; Wampler 1986).
"""

from ..compiled import inlined, kernel
from .law_state import GRAM, SHARE, SPARE, SQUARE, TASK
from .matrices import back_substitute, factor, smallest_singular, solve_square


@inlined
def damping_of(settings, task, n_rows, n, gram, report):
    """Damping lambda^2 for this task Jacobian; it and sigma go into `report`."""
    sigma = smallest_singular(task, n_rows, n, gram)
    lambda2 = 0.0
    if sigma < settings.sigma:
        part = sigma / settings.sigma
        lambda2 = settings.lambda2 * (1.0 - part * part)
    report.sigma = sigma
    report.lambda2 = lambda2
    return lambda2


@kernel
def invert_motion(task, size, share, lambda2, wanted, scratch, out):
    """Joint motion that gives the task motion `wanted`.

    Args:
        task: Task Jacobian T, shape (>= n_rows, >= n).
        size: Rows and joints that count.
        share: Weights W, shape (n,), positive.
        lambda2: Damping; 0 for none.
        wanted: Task motion, shape (>= n_rows,).
        scratch: A matrix and a vector.
        out: Joint motion, shape (n,); zero where T has no inverse and there is no damping.
    """
    n_rows, n = size
    square, held = scratch
    if n_rows == n and lambda2 == 0.0:
        for i in range(n):
            out[i] = wanted[i]
            for j in range(n):
                square[i, j] = task[i, j]
        if not solve_square(square, n, out):
            for i in range(n):
                out[i] = 0.0
        return
    for i in range(n_rows):
        held[i] = wanted[i]
        for j in range(i + 1):
            total = lambda2 if i == j else 0.0
            for k in range(n):
                total += task[i, k] * task[j, k] / share[k]
            square[i, j] = total
    if not factor(square, n_rows, square):
        for j in range(n):
            out[j] = 0.0
        return
    back_substitute(square, n_rows, held)
    for j in range(n):
        total = 0.0
        for i in range(n_rows):
            total += task[i, j] * held[i]
        out[j] = total / share[j]


@inlined
def joint_motion(n, settings, wanted, room, report):
    """Motion of the first `n` joints that gives the task motion `wanted`, damped where the task is nearly singular: scratch of `room`."""
    damping_of(settings, room.squares[TASK], settings.n_rows, n, room.squares[GRAM], report)
    return damped_motion(n, settings, wanted, room.lines, room.squares, report)


@inlined
def damped_motion(n, settings, wanted, lines, squares, report):
    """The same with the damping that is in the report."""
    motion, scratch = lines[SPARE + 1], (squares[SQUARE], lines[SPARE + 2])
    invert_motion(squares[TASK], (settings.n_rows, n), lines[SHARE], report.lambda2, wanted, scratch, motion)
    return motion
