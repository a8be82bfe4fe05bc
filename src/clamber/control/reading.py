"""A reading of two numbers weighed against three that are unsure: one correction of a Kalman filter. A kernel."""

import numpy as np

from ..compiled import kernel


@kernel
def weigh_reading(covariance, noise, off, learns, move):
    """Correct a state of three, of which the first two are read.

    Args:
        covariance: Of the state, changed, shape (3, 3).
        noise: Variance of each of both readings.
        off: Readings less what is believed, shape (2,).
        learns: Whether the third is corrected, too.
        move: Output, by how much the state is to be corrected, shape (3,).

    Returns:
        Whether there is anything to weigh: neither readings nor state are certain.
    """
    s00 = covariance[0, 0] + noise
    s11 = covariance[1, 1] + noise
    s01 = covariance[0, 1]
    spread = s00 * s11 - s01 * s01
    if s00 * s11 <= 0.0 or spread <= 0.0:
        return False
    gain = np.zeros((3, 2))
    for i in range(3 if learns else 2):
        gain[i, 0] = (covariance[i, 0] * s11 - covariance[i, 1] * s01) / spread
        gain[i, 1] = (covariance[i, 1] * s00 - covariance[i, 0] * s01) / spread
        move[i] = gain[i, 0] * off[0] + gain[i, 1] * off[1]
    rest = np.eye(3)
    rest[:, :2] -= gain
    half = np.zeros((3, 3))
    for i in range(3):
        for j in range(3):
            for k in range(3):
                half[i, j] += rest[i, k] * covariance[k, j]
    # the form that holds for any gain
    for i in range(3):
        for j in range(3):
            covariance[i, j] = noise * (gain[i, 0] * gain[j, 0] + gain[i, 1] * gain[j, 1])
            for k in range(3):
                covariance[i, j] += half[i, k] * rest[j, k]
    return True
