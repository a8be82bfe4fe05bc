"""A board to start from: a listed grid of holds, to move, add and take away by hand."""

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
