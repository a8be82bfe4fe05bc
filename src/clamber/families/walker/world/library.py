"""Grounds by name or path."""

from pathlib import Path
from typing import Final

from ....files import Document, data_names, find_data, read_toml
from .ground import Ground, build_ground

DATA: Final = Path(__file__).parents[1] / "data" / "worlds"


def ground_names() -> tuple[str, ...]:
    """Names of the grounds that come with Clamber."""
    return data_names(DATA)


def read_ground(name_or_path: str, folder: Path | None = None) -> Document:
    """The document of a ground, shipped or the user's own (a path, relative to `folder`)."""
    path, label = find_data("ground", name_or_path, (DATA,), folder)
    return read_toml(path, label)


def load_ground(name_or_path: str) -> Ground:
    """A ground by its shipped name, such as "slope", or from the user's TOML file.

    Raises:
        UnknownNameError: If no shipped ground has that name.
        FileError: If the file cannot be read.
        SpecError: If the file says something that cannot be used.
    """
    return build_ground(read_ground(name_or_path))
