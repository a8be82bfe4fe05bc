"""Two thousand spoilt robot, board, task and plan files: each loads or is refused by name, never by a stray exception."""

import json
import math
import random
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from clamber.actions.codes import MOVE, NEAREST, pack
from clamber.actions.limbed_problem import LimbedProblem
from clamber.actions.plan import Plan, load_plan
from clamber.actions.table import ActionTable
from clamber.errors import ClamberError, FileError, SpecError
from clamber.robots import load_robot
from clamber.robots.library import DATA as ROBOTS
from clamber.tasks import load_task
from clamber.tasks.library import DATA as TASKS
from clamber.tasks.limbed import LimbedTask
from clamber.worlds import load_board
from clamber.worlds.library import DATA as BOARDS

PER_KIND = 500
BATCH = 125
NAMES = {
    "robot": ("libra", "gecko4"),
    "board": ("ladder", "circle", "gecko-wall", "h"),
    "task": ("ladder", "circle", "across", "gecko-climb"),
}
FOLDERS = {"robot": ROBOTS, "board": BOARDS, "task": TASKS}
STAY = ActionTable.build([("stay", [pack(0)], True)])
JUNK: tuple[Any, ...] = (
    math.nan, math.inf, -math.inf, 0, -1, 1, 2**31, -(2**63), 2**70, 10**400, 1e300, -1e300, 1e-320, 0.0, -0.0, True, False,
    "", " ", "nan in", "inf m", "-3 in", "3 parsec", "1e999 in", "3 in in", "3", "in", "9" * 300 + " m", "0 m", "1e300 m", "-1e9 m",
    "1e-300 m", "360 deg", "7 deg", "1e308 deg", "\x00", "é" * 50, "../../etc", "right", "nobody", "thesis", "x" * 5000,
    [], [[]], [1, 2, 3], ["1 in"], ["1 in", "2 in"], [["0 m", "0 m"]] * 3, {}, {"value": 1}, {"value": "a", "unit": "in"},
    {"value": math.nan, "unit": "in"}, {"value": 3, "unit": "in", "source": 4}, {"unit": []}, {"value": 10**400, "unit": "in"},
)  # fmt: skip


def toml(value: Any) -> str:
    """Plain data as a TOML value on one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float) and not math.isfinite(value):
        return "nan" if math.isnan(value) else ("inf" if value > 0 else "-inf")
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(k)} = {toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return json.dumps(value)


def toml_file(data: dict[str, Any]) -> str:
    return "".join(f"{json.dumps(key)} = {toml(value)}\n" for key, value in data.items())


def places(value: Any) -> list[tuple[Any, Any]]:
    """Every (container, key or index) of nested data."""
    keys: list[Any] = list(value) if isinstance(value, dict) else list(range(len(value)))
    found = [(value, key) for key in keys]
    for key in keys:
        if isinstance(value[key], dict | list):
            found += places(value[key])
    return found


def spoil_data(rng: random.Random, data: dict[str, Any]) -> None:
    """One change to the data: a key deleted, added, doubled or misspelt, a value of another kind or size, a table buried."""
    container, key = rng.choice(places(data))
    kind = rng.randrange(8)
    if kind == 0:
        del container[key]
    elif kind == 1 and isinstance(container, dict):
        container[rng.choice((f"{key}s", str(key).upper(), "?", "units", f"{key}.x"))] = container.pop(key)
    elif kind == 2 and isinstance(container, list):
        container.append(rng.choice((container[key], rng.choice(JUNK))))
    elif kind == 3:
        for _ in range(rng.choice((1, 5, 300))):
            container[key] = [container[key]] if rng.random() < 0.5 else {"value": container[key]}
    elif kind == 4 and isinstance(container[key], int | float) and not isinstance(container[key], bool):
        container[key] = container[key] * rng.choice((-1, 0, 1e-12, 1e12, 1e300, 1.5))
    elif kind == 5:
        other, name = rng.choice(places(data))
        container[key] = json.loads(json.dumps(other[name], default=str))
    else:
        container[key] = rng.choice(JUNK)


def spoil_text(rng: random.Random, text: str) -> bytes:
    """One change to the file's bytes: cut short, doubled, bits turned, junk put in, deeply nested."""
    raw = bytearray(text.encode())
    at = rng.randrange(len(raw))
    kind = rng.randrange(7)
    if kind == 0:
        return bytes(raw[:at])
    if kind == 1:
        lines = text.splitlines(keepends=True)
        line = rng.randrange(len(lines))
        return "".join([*lines[: line + 1], lines[line], *lines[line + 1 :]]).encode()
    if kind == 2:
        for _ in range(rng.choice((1, 10, 200))):
            raw[rng.randrange(len(raw))] ^= 1 << rng.randrange(8)
        return bytes(raw)
    if kind == 3:
        return bytes(raw[:at]) + rng.randbytes(rng.choice((1, 50, 1000))) + bytes(raw[at:])
    if kind == 4:
        bracket = rng.choice((b"[", b"{", b'{"a":'))
        return b"deep = " + bracket * rng.choice((10, 2000, 100000)) + bytes(raw)
    if kind == 5:
        return rng.choice(
            (b"", b"\x00" * 100, b"\xff\xfe" + text.encode("utf-16-le"), b"\xef\xbb\xbf" + bytes(raw), b"[]", b"null")
        )
    end = min(len(raw), at + rng.choice((1, 20, 500)))
    return bytes(raw[:at] + raw[end:])


def spoilt(rng: random.Random, data: dict[str, Any], write: Callable[[dict[str, Any]], str]) -> bytes:
    if rng.random() < 0.3:
        return spoil_text(rng, write(data))
    for _ in range(rng.choice((1, 1, 1, 2, 5))):
        if data:
            spoil_data(rng, data)
    try:
        return write(data).encode("utf-8", "surrogatepass")
    except (ValueError, RecursionError):  # a number or a nesting that cannot even be written
        return spoil_text(rng, json.dumps(str(data)[:1000]))


def use(kind: str, path: Path) -> None:
    """All that is done with such a file before anything is planned."""
    if kind == "robot":
        load_robot(str(path))
    elif kind == "board":
        load_board(str(path))
    elif kind == "task":
        task = load_task(str(path))
        if isinstance(task, LimbedTask):
            LimbedProblem(task, STAY, threads=1)
    else:
        plan = load_plan(path)
        plan.codes(plan.rebuild_task(str(path)), str(path))


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
    taken = 0
    for index in range(BATCH):
        rng = random.Random(f"{kind} {batch} {index}")
        data = tomllib.loads((FOLDERS[kind] / f"{rng.choice(NAMES[kind])}.toml").read_text())
        taken += check(kind, tmp_path / f"{kind}-{batch}-{index}.toml", spoilt(rng, data, toml_file))
    assert 0 < taken < BATCH


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
