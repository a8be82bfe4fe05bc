"""Boards from a table of points: one hold per line, x and y, in lengths with a unit or in a picture's pixels with a scale."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from ....errors import FileError, SpecError, UnitError
from ....files import Document, csv_rows, read_text
from ....types import Json
from ....units import UNITS, convert, is_number, split_title
from .board import SCHEMA, Board, build_board

DEFAULT_RADIUS: Final = "5 mm"
"""Radius of holds that come without one."""
PIXELS: Final = ("px", "pixel", "pixels")


@dataclass(frozen=True, slots=True)
class Points:
    """The points of a file."""

    name: str
    """Of the file, as errors call it."""
    places: tuple[tuple[str, str], ...]
    """x and y as they stand there: finite numbers without a unit."""
    lines: tuple[int, ...]
    """Line of each, from 1."""
    unit: str | None
    """What the header names."""


def read_points(path: Path) -> Points:
    """The points of a CSV file: `x,y` per line, blank lines and lines that start with "#" left out.

    A header such as `x [in], y [in]` names the unit.

    Raises:
        FileError: If a line is not two finite numbers, or there is none; the error gives the line.
    """
    name, text = str(path), read_text(path)
    places: list[tuple[str, str]] = []
    lines: list[int] = []
    unit: str | None = None
    seen_header = False
    for line, row in csv_rows(text, name):
        cells = [cell.strip() for cell in row]
        if not any(cells) or cells[0].startswith("#"):
            continue
        if not places and not seen_header and not is_number(cells[0]):
            seen_header, unit = True, _header_unit(name, line, cells)
            continue
        if len(cells) != 2:
            raise FileError(f"{name}:{line}", f"has {len(cells)} columns", "each line is x, y")
        for column, cell in zip("xy", cells, strict=True):
            if not is_number(cell):
                raise FileError(f"{name}:{line}", f"{column} = {cell!r}", "state a finite number without a unit")
        places.append((cells[0], cells[1]))
        lines.append(line)
    if not places:
        raise FileError(name, "has no points", "each line is x, y")
    return Points(name, tuple(places), tuple(lines), unit)


def read_csv_board(path: Path, unit: str | None = None, radius: str = DEFAULT_RADIUS) -> Document:
    """The document of a board whose holds stand in a CSV file, numbered from 1 line by line.

    Args:
        path: The file, see `read_points`.
        unit: Unit of length of both columns; needed when the header names none.
        radius: Radius of every hold, with its unit.

    Raises:
        FileError: As `read_points`, and if no unit is known or two are.
    """
    points = read_points(path)
    if points.unit is not None and unit not in (None, points.unit):
        raise FileError(points.name, f"names the unit {points.unit!r}", f"but '{unit}' was asked for")
    known = _known_unit(points.name, points.unit or unit)
    return _document(points, path, [(f"{x} {known}", f"{y} {known}") for x, y in points.places], radius)


def read_pixel_board(
    path: Path, scale: float, origin: tuple[float, float] | None = None, radius: str = DEFAULT_RADIUS
) -> Document:
    """The document of a board whose holds were marked in a picture, y down.

    Args:
        path: The file, see `read_points`; a header may name the unit px.
        scale: Size of a pixel on the wall [m].
        origin: Pixel that is the origin of the board; None: below the leftmost and beside the lowest hold.
        radius: Radius of every hold, with its unit.

    Raises:
        FileError: As `read_points`, and if the header names a unit of length.
    """
    points = read_points(path)
    if points.unit is not None and points.unit not in PIXELS:
        raise FileError(points.name, f"names the unit {points.unit!r}", "pixels have 'px', or no unit; see --csv")
    pixels = [(float(x), float(y)) for x, y in points.places]
    left, low = origin or (min(x for x, _ in pixels), max(y for _, y in pixels))
    metres = [(f"{round(scale * (x - left), 9)!r} m", f"{round(scale * (low - y), 9)!r} m") for x, y in pixels]
    return _document(points, path, metres, radius)


def build_points_board(document: Document, path: Path) -> Board:
    """The board of a document that was read here; what is wrong with a hold is told by its line.

    Raises:
        FileError: If a hold is, such as one that overlaps another.
        SpecError: If something else is, such as the radius.
    """
    try:
        return build_board(document)
    except SpecError as error:
        words = error.key.split(".")
        if words[0] != "holds" or len(words) < 2 or not words[1].isdecimal():
            raise
        lines = read_points(path).lines
        said = re.sub(r"holds (\d+) and (\d+)", lambda m: _by_line(lines, int(m[1]), int(m[2])), error.allowed)
        raise FileError(f"{path}:{lines[int(words[1]) - 1]}", f"hold {words[1]}", said) from None


def _by_line(lines: tuple[int, ...], first: int, second: int) -> str:
    return f"holds {first} and {second} (lines {lines[first - 1]} and {lines[second - 1]})"


def _document(points: Points, path: Path, places: list[tuple[str, str]], radius: str) -> Document:
    stem = re.sub(r"[^A-Za-z0-9_-]", "-", path.stem)
    data: Json = {
        "schema": SCHEMA,
        "name": stem if stem[:1].isalpha() else f"board-{stem}",
        "title": f"{len(places)} holds from {path.name}",
        "source": path.name,
        "hold_radius": radius,
        "holds": [{"number": number, "x": x, "y": y} for number, (x, y) in enumerate(places, start=1)],
    }
    return Document(points.name, data, (), path.parent)


def _header_unit(name: str, line: int, cells: list[str]) -> str | None:
    if [cell[:1].lower() for cell in cells] != ["x", "y"]:
        raise FileError(f"{name}:{line}", f"is neither a header nor numbers: {', '.join(cells)}", "start with x, y")
    found = {unit for _, unit in map(split_title, cells) if unit is not None}
    if len(found) > 1:
        raise FileError(f"{name}:{line}", f"names two units: {', '.join(sorted(found))}", "use one unit")
    return found.pop() if found else None


def _known_unit(name: str, unit: str | None) -> str:
    lengths = ", ".join(UNITS["length"])
    if unit is None:
        allowed = f"state one of {lengths} in the header, such as 'x [in], y [in]', or where the board is loaded"
        raise FileError(name, "does not say its unit", allowed)
    try:
        convert(1.0, unit, "length")
    except UnitError:
        raise FileError(name, f"has the unit {unit!r}", f"units of length are {lengths}") from None
    return unit
