"""A task as files of its own: what a merged document says, taken apart into robot, world and task again."""

from typing import Final

from ..files import Document
from ..toml_text import toml_text
from ..types import Json
from .robots import family_in, read_robot, robot_names

PARTS: Final = ("schema", "name", "title")
"""Keys that a task's file begins with."""


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
