"""What `clamber new world` is told, and what it writes."""

import math
from pathlib import Path
from typing import Final

from ....errors import SpecError, UnitError
from ....files import Document
from ....spec_text import spec_text
from ....types import Json
from ....units import DEGREE, parse_quantity
from ..world.guide import GRAIN
from ..world.world import World, WorldSpec, build_world

COMMAND: Final = "clamber new world"
LONGEST: Final = 1000.0
"""Of a stated length [m]: a guide of a kilometre has 200 000 frames."""
SHORTEST: Final = 1e-3
"""Of a stated length [m]."""
HOW: Final = (
    'A quantity is a text such as "15 cm", or { value = 15, unit = "cm", source = "datasheet" }.\n'
    'A line that begins with "#" and no blank is a key that is not stated: take the "#" away to state it.'
)
EXAMPLES: Final = {
    ("WorldSpec", "holds"): [{"number": 1, "at": ["0 m", "0 m", "0 m"], "normal": [0, 0, 1]}],
    ("Pattern", "friction"): 0.6,
    ("Pattern", "strength"): "30 N",
}
"""Values of keys that are not stated, where the spec has no default to show."""


def length(option: str, text: str | None, least: float = SHORTEST) -> float | None:
    """The value of an option [m]; None: not given.

    Raises:
        SpecError: If it is no length, or too long or short; the error names the option.
    """
    if text is None:
        return None
    value = _parsed(option, text, "length")
    if not least <= value <= LONGEST:
        raise SpecError(COMMAND, option, text, f"must be {least:g} m to {LONGEST:g} m")
    return value


def angle(option: str, text: str | None) -> float | None:
    """The value of an option [deg]; None: not given.

    Raises:
        SpecError: If it is no angle from 0 to 90 deg; the error names the option.
    """
    if text is None:
        return None
    value = _parsed(option, text, "angle") / DEGREE
    if not 0.0 <= value <= 90.0:
        raise SpecError(COMMAND, option, text, "must be 0 deg to 90 deg")
    return value


def _parsed(option: str, text: str, dimension: str) -> float:
    try:
        value = parse_quantity(text, dimension)
    except UnitError as error:
        raise SpecError(COMMAND, option, text, f"{error.problem}; {error.allowed}") from None
    return value if math.isfinite(value) else math.nan


def checked_world(data: Json, folder: Path | None = None) -> tuple[World, float]:
    """The world of a document, and its guide's length [m].

    Raises:
        SpecError: If sizes were stated that make none.
    """
    built = build_world(Document(COMMAND, data, (), folder))
    return built, GRAIN * (len(built.frames) - 1)


def world_text(data: Json, path: Path) -> str:
    """A world's document, told key by key."""
    title = f"A world in space; `clamber check {path.name}` says what is wrong or odd with it.\n{HOW}"
    lead = (("schema", data["schema"], "The format of this file."),)
    return spec_text(WorldSpec, data, header=title, lead=lead, examples=EXAMPLES)
