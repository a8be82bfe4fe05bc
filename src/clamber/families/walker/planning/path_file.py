"""Paths from a table of places: a place per line, x, y and perhaps the heading, under a line that names columns and units."""

import math
from pathlib import Path
from typing import Final

from ....errors import FileError, UnitError, describe_choices
from ....files import csv_rows, read_text
from ....units import convert, split_title

COLUMNS: Final = {"x": "length", "y": "length", "heading": "angle"}
"""Name -> dimension; the last one may be missing."""
MOST: Final = 10_000
"""Places of a path."""


def read_path(path: Path) -> list[dict[str, str]]:
    """Places of a CSV file, as the key `through` of a walk states them.

    Args:
        path: The file: a first line such as `x [m], y [m], heading [deg]`, then a place per line; blank lines and lines that start with
            "#" are left out.

    Raises:
        FileError: If it cannot be read, a column or its unit is unknown or missing, a cell is no finite number, or there are no places;
            the error gives the line.
    """
    name, units, places = str(path), dict[str, str](), list[dict[str, str]]()
    for line, row in csv_rows(read_text(path), name):
        cells = [cell.strip() for cell in row]
        if not any(cells) or cells[0].startswith("#"):
            continue
        where = f"{name}:{line}"
        if not units:
            units = _read_titles(where, cells)
            continue
        if len(cells) != len(units):
            raise FileError(
                where, f"has {len(cells)} columns", f"the first line names {len(units)}: {', '.join(units)}"
            )
        places.append({key: _read_cell(where, key, cell, units[key]) for key, cell in zip(units, cells, strict=True)})
        if len(places) > MOST:
            raise FileError(where, f"is place {len(places)}", f"a path has at most {MOST}")
    if not places:
        raise FileError(name, "has no places", "state a line such as 'x [m], y [m]', and below it a place per line")
    return places


def _read_titles(where: str, cells: list[str]) -> dict[str, str]:
    units: dict[str, str] = {}
    for cell in cells:
        key, unit = split_title(cell)
        if key not in COLUMNS:
            raise FileError(where, f"names the column {cell!r}", f"there are {describe_choices(key, COLUMNS)}")
        if unit is None:
            raise FileError(where, f"names no unit of {key}", f"write '{key} [{'deg' if key == 'heading' else 'm'}]'")
        if key in units:
            raise FileError(where, f"names {key} twice", "name each column once")
        units[key] = unit
        try:
            convert(1.0, units[key], COLUMNS[key])
        except UnitError as error:
            raise FileError(where, f"{cell!r} {error.problem}", error.allowed) from None
    missing = [key for key in ("x", "y") if key not in units]
    if missing:
        raise FileError(where, f"names no column {missing[0]}", "a path has x, y and perhaps heading")
    return units


def _read_cell(where: str, key: str, cell: str, unit: str) -> str:
    try:
        number = float(cell)
    except ValueError:
        number = math.nan
    if not math.isfinite(number) or "_" in cell:
        raise FileError(where, f"{key} = {cell!r}", "state a finite number without a unit")
    return f"{number!r} {unit}"
