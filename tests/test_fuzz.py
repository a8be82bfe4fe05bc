"""Spoilt files of every kind and options of every command: taken or refused by name, never by a stray exception or a crash."""

import json
import math
import os
import random
import subprocess
import sys
import tomllib
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import clamber
from clamber.errors import ClamberError, FileError, SpecError
from clamber.families.climber.family import CLIMBER
from clamber.families.climber.planning.problem import LimbedProblem
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.climber.world.library import load_board
from clamber.planning.learning import load_macros
from clamber.planning.problem.arrays import ActionTable
from clamber.planning.problem.codes import MOVE, NEAREST, pack
from clamber.planning.problem.plan import Plan, load_plan
from clamber.tasks import load_task
from clamber.tasks.robots import load_robot
from fuzz_cases import lesson
from spoiling import spoilt, toml_file

PER_KIND = 500
BATCH = 125
NAMES = {
    "robot": ("libra", "gecko4"),
    "board": ("ladder", "circle", "gecko-wall", "h"),
    "task": ("ladder", "circle", "across", "gecko-climb"),
}
FOLDERS = {"robot": CLIMBER.data / "robots", "board": CLIMBER.data / "worlds", "task": CLIMBER.data / "tasks"}
STAY = ActionTable.build([("stay", [pack(0)], True)])
CASES = 10_000
"""Of commands and their files; `python tests/fuzz_server.py NUMBER` shows one."""
FAST_CASES = 300


def use(kind: str, path: Path) -> None:
    """All that is done with such a file before anything is planned."""
    if kind == "robot":
        assert odd_numbers(load_robot(str(path))) == []
    elif kind == "board":
        board = load_board(str(path))
        assert odd_numbers(board) == [] and len(set(board.numbers().tolist())) == len(board.holds)
    elif kind == "task":
        task = load_task(str(path))
        assert odd_numbers(task) == []
        if isinstance(task, LimbedTask):
            LimbedProblem(task, STAY, threads=1)
    else:
        plan = load_plan(path)
        plan.codes(plan.rebuild_task(str(path)), str(path))


def odd_numbers(value: Any, where: str = "") -> list[str]:
    """Where a value that was built from a file has a number that is none, or is not finite; a limit that is not stated may be infinite."""
    if isinstance(value, float):
        return [where] if math.isnan(value) or value == -math.inf else []
    if isinstance(value, tuple | list):
        return [found for k, each in enumerate(value) for found in odd_numbers(each, f"{where}.{k}")]
    if is_dataclass(value):
        return [
            found for each in fields(value) for found in odd_numbers(getattr(value, each.name), f"{where}.{each.name}")
        ]
    return []


def check(kind: str, path: Path, raw: bytes) -> bool:
    """Whether the file is taken; a refusal has to name the file, and the key if it is about one."""
    path.write_bytes(raw)
    try:
        use(kind, path)
    except ClamberError as error:
        if isinstance(error, SpecError):
            inner = kind == "plan" and error.file.split("/")[0] in {"robots", "worlds"}  # the label within its document
            assert path.name in error.file or inner, f"{error} does not name {path}"
            assert error.key, f"{error} names no key"
        if isinstance(error, FileError):
            assert path.name in error.path, f"{error} does not name {path}"
        assert str(error)
        return False
    return True


@pytest.fixture(scope="module")
def plan() -> dict[str, Any]:
    task = load_task("ladder", ("step.length=1in",))
    made = Plan.of_codes(task, np.array([pack(MOVE, 0, 2), pack(NEAREST, 2, 1), pack(MOVE, 0, 3)], np.int32), seed=3)
    data = made.to_json()
    assert isinstance(data, dict)
    return data


@pytest.mark.parametrize("batch", range(PER_KIND // BATCH))
@pytest.mark.parametrize("kind", ["robot", "board", "task"])
def test_a_spoilt_file_loads_or_is_refused_by_name(kind: str, batch: int, tmp_path: Path) -> None:
    for index in range(BATCH):
        rng = random.Random(f"{kind} {batch} {index}")
        data = tomllib.loads((FOLDERS[kind] / f"{rng.choice(NAMES[kind])}.toml").read_text())
        check(kind, tmp_path / f"{kind}-{batch}-{index}.toml", spoilt(rng, data, toml_file))


@pytest.mark.parametrize("batch", range(PER_KIND // BATCH))
def test_a_spoilt_plan_loads_or_is_refused_by_name(plan: dict[str, Any], batch: int, tmp_path: Path) -> None:
    for index in range(BATCH):
        rng = random.Random(f"plan {batch} {index}")
        data = json.loads(json.dumps(plan))
        check("plan", tmp_path / f"plan-{batch}-{index}.json", spoilt(rng, data, json.dumps))


@pytest.mark.parametrize("kind", ["robot", "board", "task"])
def test_the_files_are_fine_before_they_are_spoilt(kind: str, tmp_path: Path) -> None:
    for name in NAMES[kind]:
        data = tomllib.loads((FOLDERS[kind] / f"{name}.toml").read_text())
        assert check(kind, tmp_path / f"{name}.toml", toml_file(data).encode())


@pytest.mark.parametrize("kind", ["robot", "board", "task"])
def test_what_a_file_must_say_is_missed(kind: str, tmp_path: Path) -> None:
    for name in NAMES[kind]:
        data = tomllib.loads((FOLDERS[kind] / f"{name}.toml").read_text())
        for key in ("schema", "name"):
            left = {other: value for other, value in data.items() if other != key}
            assert not check(kind, tmp_path / f"{name}-{key}.toml", toml_file(left).encode())


def test_the_fuzzed_macros_are_such_as_are_read_and_odd_codes_reach_the_check(tmp_path: Path) -> None:
    file, task = tmp_path / "macros.json", load_task("ladder")
    lesson([pack(MOVE, 0, 2), pack(NEAREST, 2, 1)]).save(file)
    assert len(load_macros(file, task)) == 1
    lesson([542239545]).save(file)
    with pytest.raises(SpecError, match="must be the code of an action"):
        load_macros(file, task)


def fuzz(first: int, last: int) -> tuple[list[Any], Any]:
    """What failed of some cases, and what there is to say of all of them."""
    environment = os.environ | {"PYTHONPATH": str(Path(clamber.__file__).parents[1])}
    words = [sys.executable, str(Path(__file__).with_name("fuzz_server.py")), str(first), str(last)]
    ended = subprocess.run(words, env=environment, capture_output=True, text=True, timeout=3600, check=False)
    lines = [json.loads(line) for line in ended.stdout.splitlines()]
    assert lines, ended.stderr
    return lines[:-1], lines[-1]


def check_cases(first: int, last: int) -> None:
    failed, told = fuzz(first, last)
    assert [(one["number"], one["faults"], one["words"], one["said"][-600:]) for one in failed] == []
    assert told["cases"] == last - first and {"0", "1", "2"} <= set(told["codes"])
    assert told["slowest"] <= 10.0 and told["largest"] <= 1 << 30


@pytest.mark.slow
def test_some_cases_of_all_commands_end_as_they_should() -> None:
    check_cases(0, FAST_CASES)


@pytest.mark.long
@pytest.mark.parametrize("quarter", range(4))
def test_all_cases_of_all_commands_end_as_they_should(quarter: int) -> None:
    check_cases(quarter * CASES // 4, (quarter + 1) * CASES // 4)
