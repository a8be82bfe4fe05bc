"""Tasks by name or path: a task file names its robot and its board, and the robot's family builds the whole."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any, Protocol, runtime_checkable

from ..errors import OptionError
from ..family import Family, families
from ..files import Document, check_schema, data_names, find_data, read_toml
from ..types import Json
from .overrides import apply_overrides
from .parts import Naming
from .robots import family_in, read_robot, shipped
from .task_format import SCHEMA


@runtime_checkable
class Task(Protocol):
    """A task of any family."""

    @property
    def name(self) -> str:
        """Short name."""

    @property
    def title(self) -> str:
        """In one line."""

    @property
    def document(self) -> Json:
        """All that it was built from, with robot and world in place of their names."""

    @property
    def robot(self) -> Any:
        """The robot."""

    @property
    def world(self) -> Any:
        """The world."""

    @property
    def hashes(self) -> Mapping[str, str]:
        """Part -> hash of what its file says."""

    @property
    def start(self) -> Any:
        """Where the robot is before the first action."""

    @property
    def step(self) -> Any:
        """By how much one action moves the body."""

    @property
    def goals(self) -> Sequence[Any]:
        """In the order in which they are to be met."""


def task_names(family: str | None = None) -> tuple[str, ...]:
    """Names of the tasks that come with Clamber; those of one family of robots, if it is named."""
    chosen = [one.data for one in families() if one.data is not None and family in (None, one.name)]
    return tuple(sorted(name for data in chosen for name in data_names(data / "tasks")))


def task_family(name: str) -> str:
    """Name of the family of a task that comes with Clamber.

    Raises:
        KeyError: If there is no such task.
    """
    found = {task: one.name for one in families() if one.data is not None for task in data_names(one.data / "tasks")}
    return found[name]


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
    path, label = find_data("task", name_or_path, shipped("tasks"))
    document = read_toml(path, label)
    check_schema(document, SCHEMA)
    merged, rest = _merge(document, overrides)
    return _overridden(merged, rest, merged.data["labels"]["robot"])


def name_to_type(task: Task, under: Callable[[Any], Task] = lambda task: task) -> str:
    """The name by which commands take a shipped task that `under` has changed since; "TASK" where only its user knows its file."""
    known = load_task(task.name) if task.name in task_names() else None
    return task.name if isinstance(known, type(task)) and under(known).hashes == task.hashes else "TASK"


def check_task(task: Any, allowed: str = "give one of `clamber.load_task`") -> Task:
    """The task, if it is one.

    Raises:
        OptionError: Otherwise.
    """
    if not isinstance(task, Task):
        raise OptionError.of_value("task", task, "is no task", allowed)
    return task


def change_task(task: Task, overrides: Sequence[str]) -> Task:
    """A task with values of it, its robot or its world overridden, such as "rules.reach_offset=1cm".

    Raises:
        OptionError: If it is no task.
        SpecError: If an override says something that cannot be used.
    """
    check_task(task)
    return _overridden(Document(f"task '{task.name}'", task.document), overrides, f"robot of task '{task.name}'")


def _overridden(merged: Document, overrides: Sequence[str], label: str) -> Task:
    """The task of a merged document with overrides; `label` is what errors call the robot."""
    files = family_in(merged.section("robot", label)).files
    parts = f"{files.world_key}.holds."
    if files.listed_world is not None and any(text.strip().startswith(parts) for text in overrides):
        listed = files.listed_world(merged.section(files.world_key, label))
        merged = replace(merged, data={**merged.data, files.world_key: listed})
    task_keys = (*files.task_keys, "robot", files.world_key)
    whole = apply_overrides(merged, overrides, task_keys, files.robot_keys, files.short_keys)
    return _built(whole, family_in(whole.section("robot", label)))


def task_from_document(document: Json, label: str = "stored task") -> Task:
    """The task that `Task.document` describes, in another process or from a stored plan.

    Raises:
        SpecError: If the document is not one that this version can build.
    """
    whole = Document(label, document)
    return _built(whole, family_in(whole.section("robot", f"{label} [robot]")))


def _built(document: Document, family: Family) -> Task:
    task: Task = family.files.build(document)
    return task


def _merge(document: Document, overrides: Sequence[str]) -> tuple[Document, list[str]]:
    """The task's document with its robot and world in place of their names, and the overrides still to apply."""
    naming = Naming.of(document, overrides, {"robot", *(family.files.world_key for family in families())})
    robot = naming.read("robot", read_robot)
    files = family_in(robot).files
    world = naming.read(files.world_key, files.read_world)
    return naming.merged(robot=robot, **{files.world_key: world}), naming.others
