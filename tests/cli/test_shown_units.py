"""What is printed and drawn is in the units of the task's files, or in those that `--units` chooses; plans are printed in words."""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from clamber.shown_units import IMPERIAL, SI, choose, units_of
from clamber.tasks import load_task, task_names

Clamber = Callable[..., tuple[int, str, str]]


@pytest.fixture(autouse=True)
def as_in_the_files() -> Iterator[None]:
    yield
    choose(None)


@pytest.mark.parametrize("name", task_names())
def test_units_are_those_of_the_step(name: str) -> None:
    step = load_task(name).document["step"]["length"]
    text = step if isinstance(step, str) else step["unit"]
    assert units_of(load_task(name).document) is (IMPERIAL if text.endswith("in") else SI)


def test_a_task_that_states_none_goes_by_its_world_and_then_by_its_robot() -> None:
    board = {"schema": "b", "holds": [{"x": "3 in", "y": {"value": 1.0, "unit": "in"}}]}
    robot = {"schema": "r", "l1": "10 cm"}
    assert units_of({"name": "9 cm of text", "robot": robot, "board": board}) is IMPERIAL
    assert units_of({"robot": robot}) is SI
    assert units_of({"start": {"x": "3 cm"}, "robot": robot, "board": board}) is SI
    assert units_of({}) is SI


@pytest.mark.parametrize(
    ("words", "there", "not_there"),
    [
        ((), ("648 oz-in", "x 9 in, y 60 in", "+2.358 in"), ("mm", "N m", " cm")),
        (("--units", "si"), ("N m, power", "x 22.86 cm, y 152.4 cm", "+59.9 mm"), ("oz-in", " in,")),
    ],
)
def test_check_has_one_system(
    clamber: Clamber, words: tuple[str, ...], there: tuple[str, ...], not_there: tuple[str, ...]
) -> None:
    code, out, _ = clamber("check", "ladder-hand", *words)
    assert code == 0
    figures = out.split("hold; goal reached")[1]  # the note before names the plan's file as it is written
    assert all(word in figures for word in there)
    assert not any(word in figures for word in not_there)


def test_the_choice_ends_with_its_command(clamber: Clamber) -> None:
    clamber("check", "ladder-hand", "--units", "si")
    assert "oz-in" in clamber("check", "ladder-hand")[1]


def test_a_metric_task_is_told_in_metres(clamber: Clamber) -> None:
    _, out, _ = clamber("check", "gecko-climb")
    assert " cm" in out and " mm" in out and " in" not in out.replace(" in ", "")
    assert "lbf" in clamber("check", "gecko-climb", "--units", "imperial")[1]


def test_pictures_follow(clamber: Clamber, tmp_path: Path) -> None:
    for words, unit in (((), "x [in]"), (("--units", "si"), "x [cm]")):
        picture = tmp_path / "start.svg"
        clamber("show", "ladder", "-o", str(picture), *words)
        assert unit in picture.read_text(encoding="utf-8")


def test_plans_are_words_and_codes_on_request(clamber: Clamber) -> None:
    plan = ("plan", "ladder", "--planner", "greedy", "-q")
    assert "grabs" in clamber(*plan)[1].splitlines()[-2], "the last line says whether it would be run"
    numbers = clamber(*plan, "--codes")[1].splitlines()[-2].split()
    assert all(number.isdecimal() for number in numbers)


@pytest.mark.slow
def test_a_long_plan_is_cut_with_a_count(clamber: Clamber, tmp_path: Path) -> None:
    wall = tmp_path / "wall.toml"
    clamber("new", "board", "--random", "--holds", "400", "--width", "1.5m", "--task", "-o", str(wall))
    code, out, _ = clamber("plan", str(wall), "--planner", "route", "-q")
    assert code == 0
    assert "actions more (-o FILE keeps all, --codes prints them)" in " ".join(out.split())
    assert len(out.splitlines()) < 20
    assert len(clamber("plan", str(wall), "--planner", "route", "-q", "--codes")[1].splitlines()) > 20
