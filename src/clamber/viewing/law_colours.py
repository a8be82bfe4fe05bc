"""One colour for each control law in every picture, and one line for each way of matching its gains."""

from typing import Final, TypeAlias

from .style import INK

Line: TypeAlias = str | tuple[int, tuple[float, ...]]

LAW_COLOURS: Final[dict[str, str]] = {
    "scct": "#0072B2",
    "jacobian-transpose": "#D55E00",
    "operational-space": "#009E73",
    "resolved-rate": "#CC79A7",
    "resolved-rate-plain": "#8C564B",
    "joint-pd": "#6B6B6B",
    "admittance": "#B5A900",
    "implicit-admittance": "#56B4E9",
    "hybrid": "#6A51A3",
    "implicit-force": "#E69F00",
}
"""Name of a law -> its colour."""
OUTSIDE: Final = "#A6761D"
"""Laws of other packages."""
WANTED: Final = INK
"""What was asked for."""
MATCH_LINES: Final[dict[str, Line]] = {
    "yy": "-",
    "mean": (0, (5, 1.6)),
    "diagonal": (0, (6, 1.5, 1, 1.5)),
    "none": (0, (1, 1.2)),
}
"""How gains were matched -> the line's pattern."""
