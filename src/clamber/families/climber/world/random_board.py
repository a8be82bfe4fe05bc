"""Boards to begin with, as documents: what `clamber new board` writes, a grid of holds or, with `--random`, how to scatter them."""

from typing import Final

from ....types import Json
from .board import SCHEMA

COLUMNS: Final = 5
ROWS: Final = 8
SPACING: Final = 15
"""Of neighbours [cm]."""


def starter_board(name: str) -> Json:
    """The document of a wall of `COLUMNS` x `ROWS` holds, every second row half a spacing to the right."""
    places = [
        (SPACING * column + SPACING / 2 * (row % 2), SPACING * row) for row in range(ROWS) for column in range(COLUMNS)
    ]
    return {
        "schema": SCHEMA,
        "name": name,
        "title": f"Wall of {len(places)} holds",
        "source": "made up",
        "hold_radius": {"value": 8, "unit": "mm", "source": "made up"},
        "holds": [
            {"number": number, "x": f"{x:g} cm", "y": f"{y:g} cm"} for number, (x, y) in enumerate(places, start=1)
        ],
    }


RADIUS: Final = "5 mm"
"""Of every hold of a random board, unless told otherwise."""


def random_board_data(
    holds: int,
    density: float,
    seed: int = 0,
    *,
    width: float | None = None,
    least_gap: float | None = None,
    name: str = "random-wall",
    radius: str = RADIUS,
) -> Json:
    """What the file of a random board says; it lists no hold, it says how to scatter them.

    Args:
        holds: How many.
        density: Holds per area [1/m^2].
        seed: Same seed, same board.
        width: Of the wall [m]; None: as wide as high.
        least_gap: Least distance of two holds [m]; None: half of the mean distance.
        name: What the board is called.
        radius: Of every hold, with its unit.
    """
    scattered: Json = {"holds": holds, "density": f"{density!r} holds/m^2"}
    if width is not None:
        scattered["width"] = f"{width!r} m"
    if least_gap is not None:
        scattered["least_gap"] = f"{least_gap!r} m"
    return {
        "schema": SCHEMA,
        "name": name,
        "title": f"Random wall: {holds} holds, {density:g} per m^2, seed {seed}",
        "source": "random",
        "hold_radius": radius,
        "random": {**scattered, "seed": seed},
    }
