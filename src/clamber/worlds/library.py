"""Boards and grounds by name or path."""

from pathlib import Path
from typing import Final

from ..files import Document, data_names, find_data, read_toml
from .board import SCHEMA as BOARD_SCHEMA
from .board import Board, build_board
from .csv_board import build_points_board, read_csv_board
from .ground import SCHEMA as GROUND_SCHEMA
from .ground import Ground, build_ground

DATA: Final = Path(__file__).parent / "data"


def board_names() -> tuple[str, ...]:
    """Names of the boards that come with Clamber."""
    return _names_of(BOARD_SCHEMA)


def ground_names() -> tuple[str, ...]:
    """Names of the grounds that come with Clamber."""
    return _names_of(GROUND_SCHEMA)


def _names_of(schema: str) -> tuple[str, ...]:
    return tuple(name for name in data_names(DATA) if read_toml(DATA / f"{name}.toml").data.get("schema") == schema)


def read_board(name_or_path: str, folder: Path | None = None, unit: str | None = None) -> Document:
    """The document of a board, shipped or the user's own (TOML, or CSV with the unit of its columns)."""
    path, label = find_data("board", name_or_path, DATA, folder)
    return read_csv_board(path, unit) if path.suffix == ".csv" else read_toml(path, label)


def load_board(name_or_path: str, unit: str | None = None) -> Board:
    """A board by its shipped name, such as "ladder", or from the user's TOML or CSV file.

    Args:
        name_or_path: Name, or a path that ends in .toml or .csv.
        unit: Unit of the coordinates of a CSV file whose header names none.

    Raises:
        UnknownNameError: If no shipped board has that name.
        FileError: If the file cannot be read.
        SpecError: If the file says something that cannot be used.
    """
    document = read_board(name_or_path, unit=unit)
    path = Path(name_or_path)
    return build_points_board(document, path) if path.suffix == ".csv" else build_board(document)


def read_ground(name_or_path: str, folder: Path | None = None) -> Document:
    """The document of a ground, shipped or the user's own (a path, relative to `folder`)."""
    path, label = find_data("ground", name_or_path, DATA, folder)
    return read_toml(path, label)


def load_ground(name_or_path: str) -> Ground:
    """A ground by its shipped name, such as "slope", or from the user's TOML file.

    Raises:
        UnknownNameError: If no shipped ground has that name.
        FileError: If the file cannot be read.
        SpecError: If the file says something that cannot be used.
    """
    return build_ground(read_ground(name_or_path))
