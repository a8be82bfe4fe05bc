"""Places of holds on a guide, and the smooth surface through them that bodies may follow."""

from typing import Final

import numpy as np

from ....types import Floats
from ..world.guide import GRAIN

LEAST: Final = 1e-9
"""Weight of the flat surface where no hold is near, of that of a hold."""
SMOOTH: Final = 0.1
"""How much flat weighs beside the holds in a fitted plane, per square of the radius."""


def on_guide(frames: Floats, places: Floats) -> Floats:
    """Along, across and height of places on a guide, each at the nearest of its frames, shape (n, 3) [m].

    Args:
        frames: Of the guide, shape (m, 12).
        places: World frame [m], shape (n, 3).
    """
    made = np.zeros((len(places), 3))
    last = len(frames) - 1
    for row, place in zip(made, places, strict=True):
        away = place - frames[:, :3]
        k = int(np.einsum("ij,ij->i", away, away).argmin())
        along, across, up = frames[k, 3:].reshape(3, 3) @ away[k]
        row[:] = GRAIN * k + (along if k in (0, last) else 0.0), across, up
    return made


def fit_surface(places: Floats, grain: float, radius: float) -> tuple[Floats, tuple[float, float]]:
    """Heights and slopes of planes fitted to the holds near each node of a grid over the guide.

    Args:
        places: Along, across and height of the holds [m], shape (n, 3).
        grain: Of the grid [m].
        radius: Over which holds count [m].

    Returns:
        Height [m] and both slopes of each node, shape (rows, columns, 3), and where the grid begins.
    """
    low = places[:, :2].min(axis=0) - radius
    counts = np.maximum(2, np.ceil((places[:, :2].max(axis=0) + radius - low) / grain).astype(int) + 1)
    away = [(places[:, a] - (low[a] + grain * np.arange(counts[a]))[:, None]) / radius for a in (0, 1)]
    near = [np.exp(-0.5 * u**2) for u in away]  # the weight of a hold is the product of both

    def total(along: int, across: int, values: Floats | float = 1.0) -> Floats:
        """Sums over the holds of weight, values and powers of how far away they are, of each node."""
        u, v = away[0] ** along * values, away[1] ** across
        made: Floats = (near[0] * u) @ (near[1] * v).T + LEAST * u @ v.T
        return made

    powers = ((0, 0), (1, 0), (0, 1))
    matrix = np.array([[total(i + k, j + m) for k, m in powers] for i, j in powers]).transpose(2, 3, 0, 1)
    matrix[..., (1, 2), (1, 2)] += SMOOTH * matrix[..., :1, 0]
    sums = np.array([total(i, j, places[:, 2]) for i, j in powers]).transpose(1, 2, 0)
    fitted = np.linalg.solve(matrix, sums[..., None])[..., 0] / (1.0, radius, radius)
    return fitted, (float(low[0]), float(low[1]))


def span_along(frames: Floats, reach: float, height: float) -> float:
    """Largest distance along a guide between a body and a hold that are no more than `reach` apart in space [m].

    Args:
        frames: Of the guide, shape (n, 12).
        reach: From the body's origin to a hold [m].
        height: Most that body and hold together are away from the guide [m].
    """
    if float(abs(frames[:, 3:6] @ frames[0, 3:6] - 1.0).max()) < 1e-9:
        return reach
    step = max(1, len(frames) // 400)
    places = frames[::step, :3]
    apart = np.linalg.norm(places[:, None] - places[None], axis=2)
    i, j = np.nonzero(apart <= reach + height)
    return GRAIN * step * (float(abs(i - j).max()) + 1.0)
