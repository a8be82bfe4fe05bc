"""Tasks by name or path: a task file names its robot and its board, and the robot's family builds the whole."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, TypeAlias

from ..files import Document, data_names, find_data, read_toml
from ..robots.library import family_of, read_robot
from ..robots.limbed import LimbedRobot
from ..robots.walker import WalkerRobot
from ..specs import field_names
from ..types import Json
from ..worlds.board import SHORT_KEYS
from ..worlds.library import read_board, read_ground
from .limbed import LimbedTask, TaskSpec
from .limbed_build import build_limbed_task
from .overrides import apply_overrides
from .parts import Naming, name_of
from .walker import WalkerTask, WalkerTaskSpec, build_walker_task

DATA: Final = Path(__file__).parent / "data"
Task: TypeAlias = LimbedTask | WalkerTask
"""A task of any family."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TaskFamily:
    """How the tasks of one family of robots are read."""

    world_key: str
    """The key under which a task names its world."""
    read_world: Callable[[str, Path | None], Document]
    """The world's document by name or path, relative to the task's folder."""
    build: Callable[[Document], Task]
    """The task of a merged document."""
    task_keys: tuple[str, ...]
    """Keys of a task file beside robot and world."""
    robot_keys: tuple[str, ...]
    """Keys of a robot file; an override may start with them."""
    short_keys: Mapping[str, str] = field(default_factory=dict)
    """Other words for keys of the world, for overrides."""


TASK_FAMILIES: Final[dict[str, TaskFamily]] = {
    "limbed": TaskFamily(
        world_key="board",
        read_world=read_board,
        build=build_limbed_task,
        task_keys=field_names(TaskSpec),
        robot_keys=tuple(name for name in field_names(LimbedRobot) if name != "sources"),
        short_keys={f"board.{short}": f"board.{key}" for short, key in SHORT_KEYS.items()},
    ),
    "walker": TaskFamily(
        world_key="ground",
        read_world=read_ground,
        build=build_walker_task,
        task_keys=field_names(WalkerTaskSpec),
        robot_keys=tuple(name for name in field_names(WalkerRobot) if name != "sources"),
    ),
}
"""The `family` of the task's robot -> how its tasks are read."""


def task_names(family: str | None = None) -> tuple[str, ...]:
    """Names of the tasks that come with Clamber; those of one family of robots, if it is named."""
    names = data_names(DATA)
    return names if family is None else tuple(name for name in names if _family_of_task(name) == family)


def _family_of_task(name: str) -> str:
    path, label = find_data("task", name, DATA)
    document = read_toml(path, label)
    return family_of(read_robot(name_of(document, "robot"), document.folder))


def load_task(name_or_path: str, overrides: Sequence[str] = ()) -> Task:
    """A task by its shipped name, such as "ladder", or from the user's TOML file.

    Args:
        name_or_path: Name, or a path that ends in .toml; robot and board may be paths relative to it.
        overrides: Texts "key=value", such as "start.y=6.2in", "board.ladder.rungs=100",
            "robot.limbs.right.l1=16cm", "motor.torque_limit=1500oz-in", or "board=h" for another board.

    Raises:
        UnknownNameError: If a name of task, robot or board does not exist.
        FileError: If a file cannot be read.
        SpecError: If a file or an override says something that cannot be used.
    """
    path, label = find_data("task", name_or_path, DATA)
    document = read_toml(path, label)
    merged, rest = _merge(document, overrides)
    return _overridden(merged, rest, merged.data["labels"]["robot"])


def change_task(task: Task, overrides: Sequence[str]) -> Task:
    """A task with values of it, its robot or its world overridden, such as "rules.reach_offset=1cm".

    Raises:
        SpecError: If an override says something that cannot be used.
    """
    return _overridden(Document(f"task '{task.name}'", task.document), overrides, f"robot of task '{task.name}'")


def _overridden(merged: Document, overrides: Sequence[str], label: str) -> Task:
    """The task of a merged document with overrides; `label` is what errors call the robot."""
    family = TASK_FAMILIES[family_of(merged.section("robot", label))]
    task_keys = (*family.task_keys, "robot", family.world_key)
    whole = apply_overrides(merged, overrides, task_keys, family.robot_keys, family.short_keys)
    return TASK_FAMILIES[family_of(whole.section("robot", label))].build(whole)


def task_from_document(document: Json, label: str = "stored task") -> Task:
    """The task that `Task.document` describes, in another process or from a stored plan.

    Raises:
        SpecError: If the document is not one that this version can build.
    """
    whole = Document(label, document)
    family = TASK_FAMILIES[family_of(whole.section("robot", f"{label} [robot]"))]
    return family.build(whole)


def _merge(document: Document, overrides: Sequence[str]) -> tuple[Document, list[str]]:
    """The task's document with its robot and world in place of their names, and the overrides still to apply."""
    naming = Naming.of(document, overrides, {"robot", *(family.world_key for family in TASK_FAMILIES.values())})
    robot = naming.read("robot", read_robot)
    family = TASK_FAMILIES[family_of(robot)]
    world = naming.read(family.world_key, family.read_world)
    return naming.merged(robot=robot, **{family.world_key: world}), naming.others
