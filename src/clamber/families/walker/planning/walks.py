"""Walks by name or path."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

from ....files import Document, data_names, find_data, read_toml
from ....regular_files import is_file, user_path
from ....tasks.overrides import apply_overrides
from ....tasks.parts import Naming
from ....tasks.robots import family_in, read_robot
from ....types import Json
from ..world.library import read_ground
from .path_file import read_path
from .standing import check_mechanism
from .walk import SCHEMA, Walk, build_walk, walk_keys

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
