"""A task taken apart into files is the same task when it is read again."""

from pathlib import Path

import pytest

from clamber.errors import SpecError
from clamber.tasks import load_task
from clamber.tasks.library import task_names
from clamber.tasks.task_format import task_files


def written(folder: Path, files: dict[str, str]) -> None:
    for name, text in files.items():
        (folder / name).write_text(text)


@pytest.mark.parametrize("name", task_names())
def test_files_of_a_task_are_read_as_the_same_task(name: str, tmp_path: Path) -> None:
    task = load_task(name)
    files = task_files(task.document, "mine")
    written(tmp_path, files)
    again = load_task(str(tmp_path / "mine.toml"))
    assert (again.goals, again.start, again.rules) == (task.goals, task.start, task.rules)
    assert again.robot == task.robot
    assert (
        again.world.holds == task.world.holds
        if hasattr(task.world, "holds")
        else again.world.patches == task.world.patches
    )
    assert not any("robot" in file for file in files)  # it comes with Clamber


def test_a_robot_that_was_changed_gets_a_file_of_its_own(tmp_path: Path) -> None:
    task = load_task("ladder", ["motor.torque_limit=9Nm"])
    files = task_files(task.document, "weak")
    assert set(files) == {"weak.toml", "weak-board.toml", "weak-robot.toml"}
    written(tmp_path, files)
    assert load_task(str(tmp_path / "weak.toml")).robot == task.robot


@pytest.mark.parametrize("between", ["[[1], 2]", "['x']", "[1.5]"])
def test_holds_that_a_start_is_between_are_numbers(between: str) -> None:
    with pytest.raises(SpecError, match=r"start\.between = \[.*: must be a list of numbers of holds"):
        load_task("ladder", [f"start.between={between}"])
