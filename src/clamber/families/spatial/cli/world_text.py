"""What `clamber new world` is told, and what it writes."""

import math
import os
from pathlib import Path
from typing import TYPE_CHECKING, Final

from ....errors import SpecError, UnitError
from ....files import Document
from ....spec_text import spec_text
from ....types import Json
from ....units import DEGREE, parse_quantity
from ..world.guide import GRAIN
from ..world.library import read_parts
from ..world.made import Fit, Kind, Wanted, world_data
from ..world.measured import guide_through, measured_data
from ..world.world import World, WorldSpec, build_world

if TYPE_CHECKING:
    from .new_world import WorldOptions

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


def made_data(words: "WorldOptions", kind: Kind, fit: Fit, name: str) -> Json:
    """The document of a world that is made up.

    Raises:
        SpecError: If an option is none that it may be; the error names it.
    """
    sizes = {key: length(f"--{key}", getattr(words, key)) for key in ("length", "width", "spacing")}
    wanted = Wanted(
        kind=kind,
        **sizes,
        bumps=length("--bumps", words.bumps, least=0.0),
        gap=length("--gap", words.gap),
        angle=angle("--angle", words.angle),
        left_out=words.left_out,
        seed=words.seed,
    )
    return world_data(wanted, fit, name)


def read_data(words: "WorldOptions", source: str, fit: Fit, name: str) -> Json:
    """The document of a world of a file, with a guide through its holds.

    Args:
        words: Options.
        source: The one that names the file: table, heights, mesh or points.
        fit: The robot that it is for.
        name: What it is called.

    Raises:
        FileError: If the file cannot be read.
        SpecError: If an option is none that it may be, or the file has fewer than three holds.
    """
    path: Path = getattr(words, source)
    said = os.path.relpath(path, words.output.parent)
    if source == "table":
        table: Json = {"table": said}
    else:
        sizes = {} if words.size is None else {"size": _size(words.size)}
        scale, slope = length("--scale", words.scale, least=0.0), angle("--slope", words.slope)
        table = {"kind": source, "file": said} | sizes
        table |= {} if scale is None else {"scale": f"{scale:g} m"}
        table |= {} if slope is None else {"slope": f"{slope:g} deg"}
        table |= {"seed": words.seed} if words.seed else {}
    data = measured_data(table, fit, name, length("--spacing", words.spacing))
    built, _ = checked_world(data, words.output.parent)
    return data | {"title": f"Holds of {path.name}", "guide": guide_through(built, fit, str(path))}


def _size(text: str) -> list[str]:
    parts = [part.strip() for part in text.split(",")]
    if len(parts) != 2:
        raise SpecError(COMMAND, "--size", text, "must be two lengths, such as 4m,2m")
    return [f"{length('--size', part):g} m" for part in parts]


def checked_world(data: Json, folder: Path) -> tuple[World, float]:
    """The world of a document, and its guide's length [m].

    Args:
        data: The document.
        folder: Where its file is to lie.

    Raises:
        FileError: If a file that it names cannot be read.
        SpecError: If sizes were stated that make none.
    """
    built = build_world(read_parts(Document(COMMAND, data, (), folder), folder))
    return built, GRAIN * (len(built.frames) - 1)


def world_text(data: Json, path: Path) -> str:
    """A world's document, told key by key."""
    title = f"A world in space; `clamber check {path.name}` says what is wrong or odd with it.\n{HOW}"
    lead: list[tuple[str, object, str]] = [("schema", data["schema"], "The format of this file.")]
    if "table" in data:
        lead.append(("table", data["table"], "A CSV file of holds, from where this file lies, in place of `holds`."))
    return spec_text(WorldSpec, data, header=title, lead=lead, examples=EXAMPLES)
