"""How the files of one family of robots are read, what task files of all have in common, and a task taken apart into files again."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from ..errors import describe_choices
from ..files import Document, content_hash
from ..notebook import Pictured
from ..specs import spec
from ..toml_text import toml_text
from ..types import Json
from .robots import family_in, read_robot, robot_names


@spec
class ReadTask(Pictured):
    """A task with everything resolved, SI units; each family adds what it is made of."""

    name: str
    title: str
    document: Json = field(default_factory=dict)
    """Robot, world and task as read, with overrides applied, plain data: a worker rebuilds the task from it."""
    hashes: Mapping[str, str] = field(default_factory=dict)
    """"robot", the world's key, "task" -> SHA-256 of that part of `document`."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TaskFormat:
    """Robots, worlds and tasks of one family, from documents."""

    build_robot: Callable[[Document], Any]
    """The robot of a document."""
    robot_spec: type[Any]
    """What a robot file says, as a dataclass."""
    world_key: str
    """The key under which a task names its world, such as "board"."""
    read_world: Callable[[str, Path | None], Document]
    """The world's document by name or path, relative to the task's folder."""
    build: Callable[[Document], Any]
    """The task of a merged document."""
    task_spec: type[Any]
    """What a task file says beside robot and world, as a dataclass."""
    task_keys: tuple[str, ...]
    """Keys of a task file beside robot and world."""
    robot_keys: tuple[str, ...]
    """Keys of a robot file; an override may start with them."""
    listed_world: Callable[[Document], Json] | None = None
    """A world's document with what a generator makes of it written out, so that overrides reach each part; None: it has no generators."""
    short_keys: Mapping[str, str] = field(default_factory=dict)
    """Other words for keys of the world, for overrides."""


SCHEMA: Final = "clamber-task-1"


def hashes_of(document: Document, parts: Mapping[str, Document]) -> dict[str, str]:
    """Each part, and "task" for the rest -> SHA-256 of it."""
    rest = {key: value for key, value in document.data.items() if key not in {*parts, "labels"}}
    return {name: content_hash(part.data) for name, part in parts.items()} | {"task": content_hash(rest)}


def check_angle(angle: float, document: Document) -> None:
    """Make sure that steps of an angle [rad] fill a turn.

    Raises:
        SpecError: Otherwise.
    """
    steps = math.tau / angle
    if abs(steps - round(steps)) > 1e-9 * steps:
        allowed = f"must divide a turn; {steps:.6g} steps fill one, so take '{360 / max(1, round(steps)):.6g} deg'"
        raise document.problem("step.angle", allowed)


def check_hard(hard: Sequence[str], known: Sequence[str], document: Document) -> None:
    """Make sure that hard checks are known ones, each named once.

    Raises:
        SpecError: Otherwise.
    """
    for name in hard:
        if name not in known:
            raise document.problem("rules.hard", f"unknown check '{name}'; {describe_choices(name, tuple(known))}")
    if len(set(hard)) < len(hard):
        raise document.problem("rules.hard", "names a check twice")


PARTS: Final = ("schema", "name", "title")
"""Keys a task's file begins with."""


def task_files(document: Json, name: str) -> dict[str, str]:
    """Names of files -> their texts: the task, its world, and its robot unless it is as one that comes with Clamber.

    The files name each other, so they stay together. What a world's document leaves to other files, such as a table of holds, stays there.

    Args:
        document: A task's, with robot and world in place of their names (`Task.document`).
        name: Of the task, and of what its files are called: letters, digits, "-" and "_".
    """
    robot = document["robot"]
    world_key = family_in(Document(name, robot)).files.world_key
    world_file = f"{name}-{world_key}.toml"
    files = {world_file: toml_text(document[world_key] | {"name": f"{name}-{world_key}"})}
    robot_name = robot["name"]
    if robot_name not in robot_names() or read_robot(robot_name).data != robot:
        robot_name = f"{name}-robot.toml"
        files[robot_name] = toml_text(robot)
    said = {key: document[key] for key in PARTS if key in document} | {"name": name}
    rest = {key: value for key, value in document.items() if key not in {*said, "robot", world_key, "labels"}}
    files[f"{name}.toml"] = toml_text(said | {"robot": robot_name, world_key: world_file} | rest)
    return files
