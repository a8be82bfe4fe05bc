"""Robots by name or path, of any family."""

from pathlib import Path
from typing import Protocol

from ..extensions import blamed, load_outside, outside
from ..family import Family, families, known_families, named_family
from ..files import Document, as_text, data_names, find_data, is_path, read_toml, unknown_name


class Robot(Protocol):
    """A robot of any family."""

    @property
    def family(self) -> str:
        """Name of its family."""

    @property
    def name(self) -> str:
        """Short name."""

    @property
    def title(self) -> str:
        """In one line."""


def shipped(kind: str) -> tuple[Path, ...]:
    """Folders with data of one kind, such as "robots", that come with the families."""
    return tuple(family.data / kind for family in families() if family.data is not None)


def robot_names(family: str | None = None) -> tuple[str, ...]:
    """Names of the robots that come with Clamber; those of one family, if it is named."""
    chosen = [one.data for one in families() if one.data is not None and family in (None, one.name)]
    return tuple(sorted(name for data in chosen for name in data_names(data / "robots")))


def read_robot(name_or_path: str, folder: Path | None = None) -> Document:
    """The document of a robot: shipped, of another package, or the user's own (a path, relative to `folder`).

    Raises:
        UnknownNameError: If no robot has that name.
        FileError: If the file cannot be read.
        ExtensionError: If another package's robot cannot be loaded.
    """
    name_or_path, names = as_text(name_or_path), robot_names()
    if is_path(name_or_path) or name_or_path in names:
        path, label = find_data("robot", name_or_path, shipped("robots"), folder)
        return _whole(read_toml(path, label))
    theirs = outside("robots")
    if name_or_path not in theirs:
        raise unknown_name("robot", name_or_path, (*names, *theirs))
    found = load_outside("robots", name_or_path)
    with blamed("robots", name_or_path):
        return _whole(read_toml(Path(found() if callable(found) else found)))


def _whole(document: Document) -> Document:
    """A robot's document with what its family takes from other files."""
    family = named_family(document.data.get("family"))
    return document if family is None else family.whole_robot(document)


def family_in(document: Document) -> Family:
    """The family that a robot's document names.

    Raises:
        SpecError: If it names none, or one that is not installed.
    """
    name = document.data.get("family")
    family = named_family(name)
    if family is None:
        raise document.problem("family", known_families(name))
    return family


def build_robot(document: Document) -> Robot:
    """The robot that a document describes."""
    robot: Robot = family_in(document).files.build_robot(document)
    return robot


def load_robot(name_or_path: str) -> Robot:
    """A robot by its shipped name, such as "libra", or from the user's TOML file.

    Raises:
        UnknownNameError: If no shipped robot has that name.
        FileError: If the file cannot be read.
        SpecError: If the file says something that cannot be used.
    """
    return build_robot(read_robot(name_or_path))
