"""Files to start from: every key of a spec is there once, told, and states what it says when its "#" is taken away."""

import re
import tomllib
from dataclasses import MISSING, fields, is_dataclass
from pathlib import Path
from typing import Any, get_args, get_origin, get_type_hints

import pytest

from clamber.cli.starters import EXAMPLES, board_starter, robot_starter, task_starter
from clamber.errors import ClamberError
from clamber.families.climber.planning.task import Goal, TaskSpec
from clamber.families.climber.robot.robot import LimbedRobot
from clamber.families.climber.world.board import BoardSpec
from clamber.families.climber.world.library import load_board
from clamber.families.walker.planning.task import WalkerTaskSpec
from clamber.families.walker.robot import WalkerRobot
from clamber.families.walker.world.ground import Ground, read_ground
from clamber.spec_text import LEFT_OUT, allowed, keys_of, spec_text
from clamber.tasks import load_task
from clamber.tasks.robots import load_robot, read_robot

LINE = re.compile(r"^(#?)([A-Za-z_][A-Za-z0-9_]*) = ")
HEADING = re.compile(r"^(#?)\[\[?([A-Za-z_.]+)\]\]?$")


def written_keys(text: str) -> set[str]:
    """Dotted keys of every line that states one, or would without its "#"."""
    found, path = set(), ""
    for line in text.splitlines():
        if heading := HEADING.match(line):
            path = f"{heading[2]}."
        elif key := LINE.match(line):
            found.add(path + key[2])
    return found


def spec_keys(cls: Any, path: str = "") -> set[str]:
    """Dotted keys of a spec by its fields alone; lists of small tables are keys themselves."""
    found = set()
    for field in fields(cls):
        if field.name in LEFT_OUT:
            continue
        inner = table_of(get_type_hints(cls)[field.name])
        if inner is None:
            found.add(path + field.name)
        else:
            found |= spec_keys(inner, f"{path}{field.name}.")
    return found


def table_of(kind: Any) -> Any:
    """The spec that gets headings of its own."""
    if is_dataclass(kind):
        return kind
    options = [each for each in get_args(kind) if each not in (type(None), Ellipsis)]
    if len(options) != 1 or not is_dataclass(options[0]):
        deep = [each for each in options if get_origin(each) is tuple]
        return table_of(deep[0]) if len(options) == 1 and deep else None
    is_list = get_origin(kind) is tuple
    nested = any(is_dataclass(each) for each in get_type_hints(options[0]).values())
    return options[0] if not is_list or nested else None


@pytest.mark.parametrize(
    ("cls", "data"),
    [
        (LimbedRobot, read_robot("gecko4").data),
        (WalkerRobot, read_robot("hoshino").data),
        (TaskSpec, {"name": "t"}),
        (WalkerTaskSpec, {"name": "t"}),
        (BoardSpec, {"name": "b"}),
        (Ground, read_ground("terrace").data),
    ],
)
def test_every_key_of_a_spec_is_written(cls: Any, data: Any) -> None:
    text = spec_text(cls, data, header="A file.")
    expected = spec_keys(cls)
    told_once = {key for key in expected if key.startswith("limbs.elbow.")}  # told at the shoulder, the other joint
    assert written_keys(text) >= expected - told_once
    assert written_keys(text) <= expected


@pytest.mark.parametrize("name", ["gecko4", "libra", "hoshino"])
def test_it_states_what_the_document_states(name: str) -> None:
    data = read_robot(name).data
    cls = WalkerRobot if data["family"] == "walker" else LimbedRobot
    stated = {key: value for key, value in data.items() if key not in ("schema", "family")}
    assert tomllib.loads(spec_text(cls, data, header="A robot.")) == stated


def test_above_every_key_stand_its_meaning_and_what_is_allowed(tmp_path: Path) -> None:
    text = robot_starter(tmp_path / "mine.toml", 4, None).text
    before = text[: text.index("\nweight = ")].splitlines()[-2:]
    assert " ".join(before).replace("# ", "") == (
        "Whole weight, taken at the body's origin [N]. Force with its unit (N, kN, ozf, lbf, kgf), more than 0 N. Must be given."
    )
    assert max(map(len, text.splitlines())) <= 140


@pytest.mark.parametrize("limbs", range(2, 9))
def test_a_robot_to_start_from_loads(tmp_path: Path, limbs: int) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(robot_starter(path, limbs, None).text)
    robot = load_robot(str(path))
    assert isinstance(robot, LimbedRobot) and len(robot.limbs) == limbs and robot.name == "mine"


def test_each_key_of_a_robot_can_be_stated_by_taking_its_sign_away(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    text = robot_starter(path, 4, None).text
    lines = text.splitlines()
    unstated = [index for index, line in enumerate(lines) if (match := LINE.match(line)) and match[1]]
    assert len(unstated) > 5
    for index in unstated:
        path.write_text("\n".join((*lines[:index], lines[index][1:], *lines[index + 1 :])))
        load_robot(str(path))


@pytest.mark.parametrize("name", ["gecko4", "libra", "hoshino"])
def test_a_robot_like_another_is_the_other_by_another_name(tmp_path: Path, name: str) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(robot_starter(path, None, name).text)
    import dataclasses

    assert dataclasses.replace(load_robot(str(path)), name=name) == load_robot(name)


def test_a_board_to_start_from_loads_and_each_generator_can_take_the_place_of_its_holds(tmp_path: Path) -> None:
    path = tmp_path / "wall.toml"
    text = board_starter(path, None).text
    path.write_text(text)
    assert len(load_board(str(path)).holds) == 40
    stated = re.sub(r"^holds = \[\n.*?^\]\n", "", text, flags=re.DOTALL | re.MULTILINE)
    for generator in ("ladder", "grid", "random"):
        with_one, inside = [], False
        for line in stated.splitlines():
            if heading := HEADING.match(line):
                inside = heading[2] == generator
            uncover = inside and re.match(r"#[\[a-z_]", line)
            with_one.append(line[1:] if uncover else line)
        path.write_text("\n".join(with_one))
        assert load_board(str(path)).holds


def test_each_key_of_a_board_can_be_stated(tmp_path: Path) -> None:
    path = tmp_path / "wall.toml"
    lines = board_starter(path, None).text.splitlines()
    top = lines[: next(index for index, line in enumerate(lines) if HEADING.match(line))]
    for index, line in enumerate(top):
        if (match := LINE.match(line)) and match[1]:
            path.write_text("\n".join((*top[:index], line[1:], *top[index + 1 :])))
            load_board(str(path))


PAIRS = {"theta_min": "theta_max", "turns": "centre"}
"""Keys of a goal that are stated together."""
NEEDS_A_LIMB = {"in_use", "feet", "keep"}


def test_a_task_to_start_from_loads_and_each_of_its_keys_can_be_stated(tmp_path: Path) -> None:
    for name, made in (
        ("mine.toml", robot_starter(tmp_path / "mine.toml", 4, None)),
        ("wall.toml", board_starter(tmp_path / "wall.toml", None)),
    ):
        (tmp_path / name).write_text(made.text)
    path = tmp_path / "climb.toml"
    robot, board = str(tmp_path / "mine.toml"), str(tmp_path / "wall.toml")
    text = task_starter(path, robot, board, None, ()).text
    path.write_text(text)
    task = load_task(str(path))
    assert task.robot.name == "mine" and task.world.name == "wall"
    lines = text.splitlines()
    tried = []
    for index, line in enumerate(lines):
        match = LINE.match(line)
        if not match or not match[1] or match[2] in NEEDS_A_LIMB | set(PAIRS.values()):
            continue
        changed = list(lines)
        changed[index] = line[1:]
        partner = PAIRS.get(match[2])
        if partner is not None:
            at = next(i for i in range(index, len(lines)) if lines[i].startswith(f"#{partner} = "))
            changed[at] = lines[at][1:]
        path.write_text("\n".join(changed))
        try:
            load_task(str(path))
        except ClamberError as error:
            raise AssertionError(f"{line}: {error}") from None
        tried.append(match[2])
    assert {"max_power", "branch", "region", "turns", "seed"} <= set(tried)


def test_examples_name_keys_that_there_are() -> None:
    known: dict[str, set[str]] = {}

    def visit(cls: Any) -> None:
        known.setdefault(cls.__name__, set()).update(key.name for key in keys_of(cls))
        for key in keys_of(cls):
            if key.inner is not None:
                visit(key.inner)

    for cls in (LimbedRobot, WalkerRobot, TaskSpec, WalkerTaskSpec, BoardSpec):
        visit(cls)
    assert all(key in known[cls] for cls, key in EXAMPLES)


def test_allowed_names_bounds_units_and_choices() -> None:
    kinds = {key.name: key.kind for key in keys_of(Goal)}
    assert allowed(kinds["x_min"]) == "length with its unit (m, cm, mm, in, ft)"
    assert allowed(kinds["region"]).startswith("a list, each a list of 2, each length")
    assert all(key.meaning or key.name == "name" for key in keys_of(Goal))
    assert all(key.default is not MISSING for key in keys_of(Goal))
