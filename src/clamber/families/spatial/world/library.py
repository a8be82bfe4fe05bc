"""Worlds in space by name or path, and holds from a table."""

from dataclasses import replace
from pathlib import Path
from typing import Final

from ....errors import FileError
from ....files import Document, data_names, find_data, read_text, read_toml
from ....types import Json
from ....units import is_number, split_title
from .terrain import packed_terrain
from .terrain_files import table_rows

DATA: Final = Path(__file__).parents[1] / "data" / "worlds"
COLUMNS: Final = ("x", "y", "z", "nx", "ny", "nz", "radius", "strength", "friction")
"""Of a table of holds: the first six are needed."""
NEEDED: Final = 6
UNITS: Final = {"x": "m", "y": "m", "z": "m", "radius": "m", "strength": "N"}
"""Where a column's title names no unit."""


def world_names() -> tuple[str, ...]:
    """Names of the worlds that come with Clamber."""
    return data_names(DATA)


def read_world(name: str, folder: Path | None = None) -> Document:
    """The document of a world by name or path; tables of holds (`table = "holds.csv"`) and terrains are read into it.

    Raises:
        UnknownNameError: If no world has that name.
        FileError: If a file cannot be read, or a line of the table is wrong.
    """
    path, label = find_data("world", name, (DATA,), folder)
    return read_parts(read_toml(path, label), path.parent)


def read_parts(document: Document, folder: Path) -> Document:
    """A world's document with its table of holds and its terrains in place of their files, which lie in a folder.

    Raises:
        SpecError: If it states holds twice, or no path.
        FileError: If a file cannot be read, or a line of the table is wrong.
    """
    document = packed_terrain(replace(document, folder=folder))
    table = document.data.get("table")
    if table is None:
        return document
    if not isinstance(table, str):
        raise document.problem("table", "must be the path of a CSV file, in quotes")
    if "holds" in document.data:
        raise document.problem("table", "and 'holds' cannot both be stated")
    data = {key: value for key, value in document.data.items() if key != "table"}
    data["holds"] = read_holds(folder / table)
    return replace(document, data=data)


def read_holds(path: Path) -> list[Json]:
    """Holds of a CSV file with a header, such as `x [m],y [m],z [m],nx,ny,nz,strength [N]`; further columns are `radius`, `friction`.

    Raises:
        FileError: If the header lacks a column or has one that is unknown, or a line is wrong; the error gives the line.
    """
    name = str(path)
    rows = table_rows(read_text(path), name)
    if not rows:
        raise FileError(name, "has no holds", f"the first line is a header: {', '.join(COLUMNS)}")
    titles = [split_title(title) for title in rows[0][1]]
    names = [title.lower() for title, _ in titles]
    unknown = [title for title in names if title not in COLUMNS]
    missing = [title for title in COLUMNS[:NEEDED] if title not in names]
    if unknown or missing:
        wrong = f"has the unknown column '{unknown[0]}'" if unknown else f"has no column '{missing[0]}'"
        raise FileError(f"{name}:{rows[0][0]}", wrong, f"columns are {', '.join(COLUMNS)}; the first six are needed")
    units = {title: unit or UNITS.get(title, "") for title, (_, unit) in zip(names, titles, strict=True)}
    return [
        _hold(f"{name}:{line}", number, dict(zip(names, row, strict=False)), units)
        for number, (line, row) in enumerate(rows[1:], 1)
    ]


def _hold(label: str, number: int, cells: dict[str, str], units: dict[str, str]) -> Json:
    for column in COLUMNS[:NEEDED]:
        if not cells.get(column):
            raise FileError(label, f"has no {column}", "each line has a number for each column of the header")
    for column, cell in cells.items():
        if cell and not is_number(cell):
            raise FileError(label, f"{column} = {cell!r}", "state a finite number without a unit")
    made: Json = {
        "number": number,
        "at": [f"{cells[axis]} {units[axis]}" for axis in ("x", "y", "z")],
        "normal": [float(cells[axis]) for axis in ("nx", "ny", "nz")],
    }
    for column in COLUMNS[NEEDED:]:
        if cells.get(column):
            made[column] = f"{cells[column]} {units[column]}".strip()
    return made
