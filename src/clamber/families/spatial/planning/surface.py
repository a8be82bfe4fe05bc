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
    rows, columns = (np.ceil((places[:, :2].max(axis=0) + radius - low) / grain).astype(int) + 1).tolist()
    made = np.zeros((max(2, rows), max(2, columns), 3))
    damping = np.diag([0.0, SMOOTH, SMOOTH])
    for i in range(made.shape[0]):
        for j in range(made.shape[1]):
            away = places[:, :2] - (low + grain * np.array((i, j)))
            weight = np.exp(-(away**2).sum(axis=1) / (2.0 * radius**2)) + LEAST
            terms = np.column_stack((np.ones(len(away)), away / radius))
            matrix = (terms * weight[:, None]).T @ terms + damping * weight.sum()
            fitted = np.linalg.solve(matrix, (terms * weight[:, None]).T @ places[:, 2])
            made[i, j] = fitted[0], fitted[1] / radius, fitted[2] / radius
    return made, (float(low[0]), float(low[1]))


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
