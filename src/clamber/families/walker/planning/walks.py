"""Walks by name or path."""

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

from ....errors import FileError, UnitError, describe_choices
from ....files import Document, csv_rows, data_names, find_data, read_text, read_toml
from ....regular_files import is_file, user_path
from ....tasks.overrides import apply_overrides
from ....tasks.parts import Naming
from ....tasks.robots import family_in, read_robot
from ....types import Json
from ....units import convert, split_title
from ..world.ground import read_ground
from .walk import SCHEMA, Walk, build_walk, check_mechanism, walk_keys

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


DATA: Final = Path(__file__).parents[1] / "data" / "walks"


def walk_names() -> tuple[str, ...]:
    """Names of the walks that come with Clamber."""
    return data_names(DATA)


def is_walk(name_or_path: str) -> bool:
    """Whether a text means a walk: a shipped one's name, or a TOML file that says so."""
    path = Path(name_or_path)
    if name_or_path in walk_names():
        return True
    return path.suffix == ".toml" and is_file(path) and read_toml(path).data.get("schema") == SCHEMA


def load_walk(name_or_path: str, overrides: Sequence[str] = ()) -> Walk:
    """A walk by its shipped name, such as "slope-walk", or from the user's TOML file.

    Args:
        name_or_path: Name, or a path that ends in .toml; robot, ground and paths to follow may be paths relative to it.
        overrides: Texts "key=value", such as "level=false", "ground.slope=5deg", "way.0.distance=2m", "legs.speed=8mm/s",
            or "ground=steps" for another ground.

    Raises:
        UnknownNameError: If a name of walk, robot or ground does not exist.
        FileError: If a file cannot be read, or a path to follow is none.
        SpecError: If a file or an override says something that cannot be used.
    """
    path, label = find_data("walk", name_or_path, (DATA,))
    naming = Naming.of(read_toml(path, label), overrides, ("robot", "ground"))
    robot = naming.read("robot", read_robot)
    if family_in(robot).name != "walker":
        raise robot.problem("family", "must be 'walker': a walk is for a two-frame walker")
    merged, keys = naming.merged(robot=robot, ground=naming.read("ground", read_ground)), walk_keys()
    whole = _with_paths(apply_overrides(merged, naming.others, keys["walk"], keys["robot"], {}))
    walk = build_walk(whole)
    check_mechanism(walk, whole)
    return walk


def walk_from_document(document: Json, label: str = "stored walk") -> Walk:
    """The walk that `Walk.document` describes, in another process.

    Raises:
        SpecError: If the document is not one that this version can build.
    """
    return build_walk(Document(label, document))


def _with_paths(document: Document) -> Document:
    """The places of every `path` read into `through`; a path in an override starts where the user stands."""
    way = document.data.get("way")
    if not isinstance(way, list):
        return document
    pieces: list[object] = []
    for i, piece in enumerate(way):
        path = piece.get("path") if isinstance(piece, dict) else None
        if isinstance(path, str):
            if "through" in piece:
                raise document.problem(f"way.{i}", "must state through or path, not both")
            inside = document.label_of(f"way.{i}.path") == document.label and document.folder is not None
            file = user_path(path)
            pieces.append(piece | {"through": read_path(document.folder / file if inside else file)})  # type: ignore[operator]
        else:
            pieces.append(piece)
    return replace(document, data=document.data | {"way": pieces})
