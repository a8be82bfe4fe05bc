"""Places scattered at random over a rectangle, no two closer than a gap: a dart too close to an earlier one doesn't count.

The limit of that is random sequential addition, which jams when discs as wide as the gap cover 54.7 % of the area (Feder 1980).
"""

import math
from typing import Final

import numpy as np

from ....types import Floats

GRAIN: Final = 1e-4
"""Places are whole multiples of this [m], so that a file that lists them in decimals says the same."""
DEFAULT_GAP: Final = 0.5
"""Of the mean distance, one over the square root of the density [-]."""
MOST_PACKED: Final = 0.45
"""Largest share of the area under discs as wide as the gap [-]; darts find room quickly up to there."""
BATCH: Final = 4096
TRIES: Final = 2000
"""Darts per place before it is given up."""


class GapError(Exception):
    """So many places found no room that far apart; whoever knows the file turns it into a `SpecError`."""

    def __init__(self, placed: int) -> None:
        super().__init__(placed)
        self.placed = placed


def scatter(count: int, width: float, height: float, gap: float, seed: int) -> Floats:
    """Places in [0, width] x [0, height], in the order in which they were drawn.

    Deterministic on any machine: NumPy's PCG64 gives the same numbers everywhere, and distances are compared as whole numbers of `GRAIN`.

    Args:
        count: How many.
        width, height: Of the rectangle [m].
        gap: Least distance of two of them [m].
        seed: Of the random numbers.

    Returns:
        Places [m], shape (count, 2).

    Raises:
        GapError: If that many don't find room.
    """
    draw = np.random.default_rng(seed)
    steps = np.floor(np.array([width, height]) / GRAIN + 1e-6) + 1.0
    least = max(1, math.ceil(gap / GRAIN - 1e-6))  # two places never coincide
    square = least * least
    cells: dict[tuple[int, int], list[tuple[int, int]]] = {}
    placed: list[tuple[int, int]] = []
    left = TRIES * count
    while left > 0:
        left -= BATCH
        for x, y in np.floor(draw.random((BATCH, 2)) * steps).astype(np.int64).tolist():
            column, row = x // least, y // least
            if _has_room(cells, column, row, x, y, square):
                cells.setdefault((column, row), []).append((x, y))
                placed.append((x, y))
                if len(placed) == count:
                    return np.array(placed, np.float64) / round(1.0 / GRAIN)
    raise GapError(len(placed))


def _has_room(
    cells: dict[tuple[int, int], list[tuple[int, int]]], column: int, row: int, x: int, y: int, square: int
) -> bool:
    """Whether no place lies closer; cells are as wide as the gap, so that the eight neighbours suffice."""
    for i in (column, column - 1, column + 1):
        for j in (row, row - 1, row + 1):
            for other_x, other_y in cells.get((i, j), ()):
                if (x - other_x) ** 2 + (y - other_y) ** 2 < square:
                    return False
    return True
