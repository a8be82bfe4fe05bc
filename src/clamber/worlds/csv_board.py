"""Boards from a table of coordinates: one hold per line, x and y, an optional header that may name the unit."""

import csv
import io
import math
import re
from pathlib import Path
from typing import Any, Final

from ..errors import FileError, UnitError
from ..files import Document, read_text
from ..units import UNITS, convert
from .board import SCHEMA

DEFAULT_RADIUS: Final = "5 mm"
"""Radius of holds that come without one."""
_HEADER_UNIT: Final = re.compile(r"[\[(]\s*([^\])]+?)\s*[\])]")


def read_csv_board(path: Path, unit: str | None = None, radius: str = DEFAULT_RADIUS) -> Document:
    """The document of a board whose holds stand in a CSV file, numbered from 1 line by line.

    Args:
        path: The file: `x,y` per line, blank lines and lines that start with "#" left out. A header such as
            `x [in], y [in]` names the unit.
        unit: Unit of length of both columns; needed when the header names none.
        radius: Radius of every hold, with its unit.

    Raises:
        FileError: If a line is not two finite numbers, or no unit is known; the error gives the line.
    """
    name, text = str(path), read_text(path)
    holds: list[dict[str, Any]] = []
    seen_header = False
    for line, row in enumerate(csv.reader(io.StringIO(text), skipinitialspace=True), start=1):
        cells = [cell.strip() for cell in row]
        if not any(cells) or cells[0].startswith("#"):
            continue
        if not holds and not seen_header and not _is_number(cells[0]):
            seen_header = True
            unit = _header_unit(name, line, cells, unit)
            continue
        if len(cells) != 2:
            raise FileError(f"{name}:{line}", f"has {len(cells)} columns", "each line is x, y")
        for column, cell in zip("xy", cells, strict=True):
            if not _is_number(cell):
                raise FileError(f"{name}:{line}", f"{column} = {cell!r}", "state a finite number without a unit")
        known = _known_unit(name, unit)
        holds.append({"number": len(holds) + 1, "x": f"{cells[0]} {known}", "y": f"{cells[1]} {known}"})
    title = f"{len(holds)} holds from {path.name}"
    stem = re.sub(r"[^A-Za-z0-9_-]", "-", path.stem)
    data = {
        "schema": SCHEMA,
        "name": stem if stem[:1].isalpha() else f"board-{stem}",
        "title": title,
        "source": path.name,
        "hold_radius": radius,
        "holds": holds,
    }
    return Document(name, data, (), path.parent)


def _is_number(cell: str) -> bool:
    try:
        return math.isfinite(float(cell)) and "_" not in cell
    except ValueError:
        return False


def _header_unit(name: str, line: int, cells: list[str], unit: str | None) -> str | None:
    if [cell[:1].lower() for cell in cells] != ["x", "y"]:
        raise FileError(f"{name}:{line}", f"is neither a header nor numbers: {', '.join(cells)}", "start with x, y")
    found = {match.group(1) for cell in cells if (match := _HEADER_UNIT.search(cell))}
    if len(found) > 1:
        raise FileError(f"{name}:{line}", f"names two units: {', '.join(sorted(found))}", "use one unit")
    if found and unit is not None and found != {unit}:
        raise FileError(f"{name}:{line}", f"names the unit {found.pop()!r}", f"but '{unit}' was asked for")
    return found.pop() if found else unit


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
