"""Two of many holds that overlap, found in a time that grows with their number."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .board import Hold

AROUND = tuple((i, j) for i in (-1, 0, 1) for j in (-1, 0, 1))
"""A cell and its neighbours."""


def find_overlap(holds: "Sequence[Hold]") -> "tuple[Hold, Hold] | None":
    """Two holds of which parts coincide, None if there are none.

    Larger holds come first. Those of like size, within a factor of two, lie in the cells of one grid, twice as wide as the largest of them:
    what overlaps one of them lies in a neighbouring cell, and a cell has room for a few only, wherever the others are.
    """
    grids: dict[int, dict[tuple[int, int], list[Hold]]] = {}
    for hold in sorted(holds, key=lambda hold: -hold.radius):
        for size, cells in grids.items():
            column, row = _cell(hold, size)
            for i, j in AROUND:
                for other in cells.get((column + i, row + j), ()):
                    if math.hypot(hold.x - other.x, hold.y - other.y) < hold.radius + other.radius:
                        return other, hold
        size = math.frexp(hold.radius)[1]  # the radius is less than 2^size
        grids.setdefault(size, {}).setdefault(_cell(hold, size), []).append(hold)
    return None


def _cell(hold: "Hold", size: int) -> tuple[int, int]:
    wide = math.ldexp(2.0, size)
    return math.floor(hold.x / wide), math.floor(hold.y / wide)
