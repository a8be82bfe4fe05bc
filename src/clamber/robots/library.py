"""Robots by name or path: which family builds which file."""

from collections.abc import Callable
from pathlib import Path
from typing import Final, TypeAlias

from ..errors import UnknownNameError, describe_choices
from ..extensions import blamed, load_outside, outside
from ..files import Document, data_names, find_data, is_path, read_toml
from .limbed import LimbedRobot, build_limbed
from .walker import WalkerRobot, build_walker

DATA: Final = Path(__file__).parent / "data"
Robot: TypeAlias = LimbedRobot | WalkerRobot
"""A robot of any family."""

ROBOT_FAMILIES: Final[dict[str, Callable[[Document], Robot]]] = {"limbed": build_limbed, "walker": build_walker}
"""What a robot file calls its `family` -> what builds it."""


def robot_names(family: str | None = None) -> tuple[str, ...]:
    """Names of the robots that come with Clamber; those of one family, if it is named."""
    names = data_names(DATA)
    return names if family is None else tuple(name for name in names if family_of(read_robot(name)) == family)


def read_robot(name_or_path: str, folder: Path | None = None) -> Document:
    """The document of a robot: shipped, of another package, or the user's own (a path, relative to `folder`).

    Raises:
        UnknownNameError: If no robot has that name.
        FileError: If the file cannot be read.
        ExtensionError: If another package's robot cannot be loaded.
    """
    shipped = data_names(DATA)
    if is_path(name_or_path) or name_or_path in shipped:
        path, label = find_data("robot", name_or_path, DATA, folder)
        return read_toml(path, label)
    theirs = outside("robots")
    if name_or_path not in theirs:
        raise UnknownNameError("robot", name_or_path, (*shipped, *theirs))
    found = load_outside("robots", name_or_path)
    with blamed("robots", name_or_path):
        return read_toml(Path(found() if callable(found) else found))


def family_of(document: Document) -> str:
    """The family that a robot's document names.

    Raises:
        SpecError: If it names none, or one that does not exist.
    """
    family = document.data.get("family")
    if not isinstance(family, str) or family not in ROBOT_FAMILIES:
        raise document.problem("family", f"must be one of {describe_choices(str(family), ROBOT_FAMILIES)}")
    return family


def build_robot(document: Document) -> Robot:
    """The robot that a document describes."""
    return ROBOT_FAMILIES[family_of(document)](document)


def load_robot(name_or_path: str) -> Robot:
    """A robot by its shipped name, such as "libra", or from the user's TOML file.

    Raises:
        UnknownNameError: If no shipped robot has that name.
        FileError: If the file cannot be read.
        SpecError: If the file says something that cannot be used.
    """
    return build_robot(read_robot(name_or_path))
