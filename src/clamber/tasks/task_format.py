"""How the files of one family of robots are read."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..files import Document


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
    short_keys: Mapping[str, str] = field(default_factory=dict)
    """Other words for keys of the world, for overrides."""
