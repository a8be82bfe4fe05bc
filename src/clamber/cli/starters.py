"""The texts of files to start from: a document's values, and above each key what its spec says of it."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from ..errors import OptionError
from ..families.climber.family import CLIMBER
from ..families.climber.robot.robot import SCHEMA as ROBOT
from ..families.climber.robot.starter import starter_robot
from ..families.climber.world.board import SCHEMA as BOARD
from ..families.climber.world.board import BoardSpec
from ..families.climber.world.library import load_board, read_board
from ..families.climber.world.random_board import starter_board
from ..family import Family, families
from ..files import Document, check_schema, find_data, is_path, read_toml
from ..regular_files import user_path
from ..spec_text import spec_text
from ..tasks.imported import ImportedRobot
from ..tasks.library import load_task
from ..tasks.robots import family_in, load_robot, read_robot, shipped
from ..terminal.options import ROBOT as ROBOT_NAME
from ..terminal.output import name_of
from ..types import Json
from .new_files import task_data

HOW: Final = (
    'A quantity is a text such as "15 cm", or { value = 15, unit = "cm", source = "datasheet" }.\n'
    'A line that begins with "#" and no blank is a key that is not stated: take the "#" away to state it.'
)
LIMBS: Final = 4
EXAMPLES: Final = {
    (spec, key): value
    for spec, keys in read_toml(Path(__file__).parent / "examples.toml", "examples").data.items()
    for key, value in keys.items()
}
"""Values of keys that are not stated, where the spec has no default to show."""


@dataclass(frozen=True, slots=True)
class Starter:
    """A file to write."""

    data: Json
    text: str


def robot_starter(path: Path, limbs: int | None, like: str | None) -> Starter:
    """A robot's file: equal limbs about a body, or one that there is, told key by key.

    Raises:
        ClamberError: If there is no robot to be like.
    """
    name = name_of(path, "robot")
    if like is None:
        data = starter_robot(name, limbs or LIMBS)
    else:
        load_robot(like)
        data = _data(read_robot(like), ROBOT) | {"name": name}
    family = family_in(Document(like or name, data))
    lead = (
        ("schema", data["schema"], "The format of this file."),
        ("family", family.name, "; ".join(f"{one.name}: {one.title}" for one in families()) + "."),
    )
    title = f"A robot ({family.name}); `clamber check {path.name}` says what is wrong or odd with it.\n{HOW}"
    return Starter(data, spec_text(family.files.robot_spec, data, header=title, lead=lead, examples=EXAMPLES))


def imported_robot(model: Path, path: Path) -> ImportedRobot:
    """What the family that reads such model files makes of one, for a robot file at `path`.

    Raises:
        OptionError: If none reads files of that name.
        ClamberError: If the model can't be used.
    """
    makers = {suffix: make for family in families() for suffix, make in (family.imports or {}).items()}
    if model.suffix.lower() not in makers:
        raise OptionError("--from", f"{model.name} is no model that can be read", f"names end in {', '.join(makers)}")
    return makers[model.suffix.lower()](model, path, name_of(path, "robot"))


def board_starter(path: Path, like: str | None) -> Starter:
    """A board's file: a grid of holds, or one that there is, told key by key.

    Raises:
        ClamberError: If there is no board to be like.
    """
    name = name_of(path)
    if like is None:
        data = starter_board(name)
    else:
        load_board(like)  # what is wrong with it is told, and not copied
        data = _data(read_board(like), BOARD) | {"name": name}
    return Starter(data, board_text(data, path))


def board_text(data: Json, path: Path) -> str:
    """A board's document, told key by key."""
    title = (
        f"A board; `clamber check {path.name}` says what is wrong or odd with it.\n"
        f"It states exactly one of holds, [ladder], [grid], [random].\n{HOW}"
    )
    lead = (("schema", data["schema"], "The format of this file."),)
    return spec_text(BoardSpec, data, header=title, lead=lead, examples=EXAMPLES)


def task_starter(
    path: Path, robot: str, board: str, like: str | None, overrides: Sequence[str], world: str | None = None
) -> Starter:
    """A task's file, told key by key: from the lowest stance on a board to its top, along the guide of a world, or one that there is.

    Paths of robot, board and world are from where the user stands; the file names them from where it lies.

    Raises:
        SpecError: If board or world have no stance that the rules allow.
        ClamberError: If there is no such robot, board or task.
    """
    name = name_of(path, "task")
    family: Family = CLIMBER
    own = None if like is not None else _family_with_worlds(robot, world)
    if own is not None:
        assert own.first_task is not None and world is not None
        data, family = own.first_task(robot, world, name, overrides), own
        data |= {key: _from(path, str(data[key])) for key in ("robot", own.files.world_key)}
    elif like is None:
        data = task_data(read_board(board).data, board, path, overrides, robot) | {"name": name}
        data |= {"robot": _from(path, robot), "board": _from(path, board)}
    else:
        data, family = _task_like(like)
        data |= {"name": name}
    key = family.files.world_key
    lead = (
        ("schema", data["schema"], "The format of this file."),
        ("robot", data["robot"], "Name (`clamber list robots`) or path of the robot's file, from here."),
        (key, data[key], f"Name (`clamber list {key}s`) or path of the {key}'s file, from here."),
    )
    title = f"A task; `clamber check {path.name}` says whether its start holds, and by how much.\n{HOW}"
    return Starter(data, spec_text(family.files.task_spec, data, header=title, lead=lead, examples=EXAMPLES))


def _family_with_worlds(robot: str, world: str | None) -> Family | None:
    """The family of a robot that stands in worlds in place of boards; None: it climbs boards.

    Raises:
        OptionError: If a world is named with a robot of another family, or none with one of this.
    """
    if robot == ROBOT_NAME and world is None:
        return None
    document = read_robot(robot)
    family = family_in(document)
    if (family.first_task is None) == (world is None):
        return None if world is None else family
    if world is None:
        raise OptionError("--world", "is not given", f"a {family.title} such as '{robot}' needs one: clamber new world")
    raise OptionError(
        "--world", f"is no place for a {family.title} such as '{robot}'", "take a robot in space, or --board"
    )


def _data(document: Document, schema: str) -> Json:
    """What a file says, if it follows its schema."""
    check_schema(document, schema)
    return document.data


def _task_like(like: str) -> tuple[Json, Family]:
    load_task(like)  # what is wrong with it is told, and not copied
    path, label = find_data("task", like, shipped("tasks"))
    document = read_toml(path, label)
    robot = document.data.get("robot")
    if not isinstance(robot, str):
        raise document.problem("robot", "must name a robot, or give the path of its file, in quotes")
    family = family_in(read_robot(robot, document.folder))
    data = dict(document.data)
    for key in ("robot", family.files.world_key):
        said = data.get(key)
        if isinstance(said, str) and said.endswith((".toml", ".csv")):
            data[key] = str((path.parent / said).resolve())
    return data, family


def _from(path: Path, named: str) -> str:
    """What a file at `path` calls a robot or a board that the user named from where they stand."""
    if not is_path(named):
        return named
    target, folder = user_path(named).resolve(), path.resolve().parent
    return str(target.relative_to(folder)) if target.is_relative_to(folder) else str(target)
