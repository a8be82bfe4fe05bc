"""Boards by name or path."""

from pathlib import Path
from typing import Final

from ....files import Document, data_names, find_data, read_toml
from .board import Board, build_board
from .csv_board import build_points_board, read_csv_board

DATA: Final = Path(__file__).parents[1] / "data" / "worlds"


def board_names() -> tuple[str, ...]:
    """Names of the boards that come with Clamber."""
    return data_names(DATA)


def read_board(name_or_path: str, folder: Path | None = None, unit: str | None = None) -> Document:
    """The document of a board, shipped or the user's own (TOML, or CSV with the unit of its columns)."""
    path, label = find_data("board", name_or_path, (DATA,), folder)
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
