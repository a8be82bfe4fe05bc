"""`clamber new` and `clamber check`: from nothing to a plan, boards from tables and pictures, and what is wrong with a file."""

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from clamber.cli import main
from clamber.families.climber.world.library import load_board
from clamber.tasks import load_task
from clamber.units import INCH
from tiers import first_fast

Run = Callable[..., tuple[int, str, str]]


@pytest.fixture
def run(capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Run:
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.chdir(tmp_path)

    def call(*words: str) -> tuple[int, str, str]:
        capfd.readouterr()
        try:
            main(words)
            code: Any = 0
        except SystemExit as left:
            code = left.code
        out, err = capfd.readouterr()
        assert "Traceback" not in err
        return int(code or 0), out, err

    return call


@pytest.mark.slow
@pytest.mark.parametrize("limbs", ["4", "3", "6"])
def test_from_nothing_to_a_plan_in_five_commands(run: Run, tmp_path: Path, limbs: str) -> None:
    for words in (
        ("new", "robot", "--limbs", limbs, "-o", "mine.toml"),
        ("new", "board", "-o", "wall.toml"),
        ("new", "task", "--robot", "mine.toml", "--board", "wall.toml", "-o", "climb.toml"),
        ("check", "climb.toml"),
        ("plan", "climb.toml", "--planner", "greedy", "-o", "plan.json", "-q"),
    ):
        code, out, err = run(*words)
        assert code == 0, (words, out, err)
    code, out, _ = run("check", "plan.json", "--json")
    verdict = json.loads(out)
    assert code == 0 and verdict["kind"] == "plan" and verdict["reached"]
    # four limbs and more are none for the control of climbers and climb in space; three are tried, without a promise
    assert verdict["to_run"]["ok"] == (limbs == "3")
    code, out, err = run("run", "climb.toml", "-q")
    if limbs == "3":
        assert code == 1 and "not climbed" in out
    else:
        assert code == 0 and "carried out: 'climb'" in out, err


@pytest.mark.parametrize("limbs", first_fast([2, 3, 4, 6, 8], 3))
def test_a_new_task_starts_where_every_check_likes_it_in_units_of_the_robot(run: Run, limbs: int) -> None:
    assert run("new", "robot", "--limbs", str(limbs), "-o", "mine.toml")[0] == 0
    assert run("new", "board", "-o", "wall.toml")[0] == 0
    assert run("new", "task", "--robot", "mine.toml", "--board", "wall.toml", "-o", "climb.toml")[0] == 0
    code, out, _ = run("check", "climb.toml", "--json")
    found = json.loads(out)
    assert code == 0 and found["odd"] == []
    margins = {margin["check"]: margin["margin"] for margin in found["margins"]}
    assert all(margin["holds"] for margin in found["margins"])
    assert margins["clearance"] > 0.04  # the body's origin is on no peg
    assert margins["support"] == limbs - 1  # one must hold, and all do
    text = Path("climb.toml").read_text()
    assert 'length = "7.5 cm"' in text and 'theta = "0 deg"' in text and ' in"' not in text


def test_a_new_task_for_a_robot_in_inches_is_in_inches(run: Run) -> None:
    assert run("new", "robot", "-o", "mine.toml")[0] == 0
    robot, metric = Path("mine.toml"), re.compile(r'value = ([-\d.]+), unit = "cm"')
    robot.write_text(metric.sub(lambda one: f'value = {float(one[1]) / 2.54:.9g}, unit = "in"', robot.read_text()))
    assert run("new", "board", "-o", "wall.toml")[0] == 0
    assert run("new", "task", "--robot", "mine.toml", "--board", "wall.toml", "-o", "climb.toml")[0] == 0
    said = load_task("climb.toml").document
    assert said["step"]["length"] == "3 in"
    assert said["start"]["x"].endswith(" in") and said["goal"]["y_min"].endswith(" in")


def test_what_a_start_violates_is_named_where_it_is_called_all_right(run: Run) -> None:
    code, out, _ = run("check", "ladder")
    assert code == 0
    assert "the start holds, but violates limb_limb (only reported); nothing is odd" in " ".join(out.split())


def test_files_made_beside_each_other_can_be_moved_together(run: Run, tmp_path: Path) -> None:
    (tmp_path / "here").mkdir()
    for words in (
        ("new", "robot", "-o", "here/mine.toml"),
        ("new", "board", "-o", "here/wall.toml"),
        ("new", "task", "--robot", "here/mine.toml", "--board", "here/wall.toml", "-o", "here/climb.toml"),
    ):
        assert run(*words)[0] == 0
    (tmp_path / "here").rename(tmp_path / "there")
    assert run("check", "there/climb.toml")[0] == 0


def test_nobody_loses_a_file_that_is_there(run: Run, tmp_path: Path) -> None:
    (tmp_path / "robot.toml").write_text("mine")
    code, _, err = run("new", "robot")
    assert code == 2 and "is there already" in err and (tmp_path / "robot.toml").read_text() == "mine"
    assert run("new", "robot", "--force")[0] == 0
    assert (tmp_path / "robot.toml").read_text().startswith("# A robot (limbed)")


@pytest.mark.parametrize(
    "words",
    [
        "plan ladder -o mine.toml",
        "plan ladder --history mine.toml",
        "learn ladder -o mine.TOML",
        "reach five_holds -o mine.toml",
        "export libra -o mine.xml",
        "export libra -o mine.urdf",
        "show ladder -o mine.urdf",
        "limb identify log.csv -o mine.toml",
        "bench boards -o mine.toml",
    ],
)
def test_nothing_that_people_write_is_replaced_by_a_result(run: Run, tmp_path: Path, words: str) -> None:
    mine = tmp_path / words.split()[-1]
    mine.write_text("mine")
    code, _, err = run(*words.split())
    assert code == 2 and f"{mine.name}: " in err and "Traceback" not in err
    assert mine.read_text() == "mine"


def test_a_robot_is_exported_again_over_its_file_when_that_is_asked_for(run: Run, tmp_path: Path) -> None:
    words = ("export", "libra", "-o", "libra.urdf")
    assert [run(*words)[0], run(*words)[0], run(*words, "--force")[0]] == [0, 2, 0]
    assert run("export", "ladder-hand", "-o", "plan.csv")[0] == run("export", "ladder-hand", "-o", "plan.csv")[0] == 0


@pytest.mark.parametrize("there", ["mine.toml", "mine-board.toml"])
def test_no_random_board_is_written_over_a_file_that_is_there(run: Run, tmp_path: Path, there: str) -> None:
    (tmp_path / there).write_text("mine")
    words = ("new", "board", "--random", "--holds", "40", "--task", "-o", "mine.toml")
    code, _, err = run(*words)
    assert code == 2 and f"{there}: is there already" in err and "--force" in err
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {there: "mine"}
    assert run(*words, "--force")[0] == 0
    assert (tmp_path / there).read_text() != "mine"


def test_a_walker_and_its_task_can_be_started_from(run: Run) -> None:
    assert run("new", "robot", "--like", "hoshino", "-o", "six.toml")[0] == 0
    assert run("new", "task", "--like", "terrace-walk", "-o", "over.toml")[0] == 0
    text = Path("over.toml").read_text()
    Path("over.toml").write_text(text.replace('robot = "hoshino"', 'robot = "six.toml"'))
    code, out, _ = run("check", "over.toml", "--json")
    found = json.loads(out)
    assert code == 0 and found["facts"]["robot"] == "six"
    assert [margin["check"] for margin in found["margins"]] == ["stroke", "singular", "foothold", "balance", "legs"]


def test_a_table_of_coordinates_becomes_a_board(run: Run, tmp_path: Path) -> None:
    (tmp_path / "holds.csv").write_text("# by tape\nx,y\n0,0\n30,0\n\n15,20.5\n")
    assert run("new", "board", "--csv", "holds.csv", "--unit", "cm", "--radius", "8mm", "-o", "wall.toml")[0] == 0
    board = load_board("wall.toml")
    np.testing.assert_allclose(board.positions(), [[0.0, 0.0], [0.3, 0.0], [0.15, 0.205]], atol=1e-12)
    assert {hold.radius for hold in board.holds} == {0.008}


def test_a_picture_of_a_wall_becomes_a_board_with_y_up(run: Run, tmp_path: Path) -> None:
    pixels = np.array([(120, 840), (220, 740), (20, 640)])
    (tmp_path / "points.csv").write_text("x [px], y [px]\n" + "".join(f"{x},{y}\n" for x, y in pixels))
    assert run("new", "board", "--pixels", "points.csv", "--scale", "3.2mm", "-o", "wall.toml")[0] == 0
    board = load_board("wall.toml")
    np.testing.assert_allclose(board.positions(), 0.0032 * np.array([(100, 0), (200, 100), (0, 200)]), atol=1e-9)
    words = ("--pixels", "points.csv", "--scale", "3.2mm", "--origin", "120,740", "-o", "moved.toml")
    assert run("new", "board", *words)[0] == 0
    moved = load_board("moved.toml").positions() - board.positions()
    np.testing.assert_allclose(moved, np.broadcast_to(0.0032 * np.array((-100, -100)), (3, 2)), atol=1e-9)


@pytest.mark.parametrize(
    ("table", "words", "said"),
    [
        ("1,2\n3,x\n", ("--csv", "p.csv", "--unit", "cm"), "p.csv:2: y = 'x'; state a finite number without a unit"),
        ("1,2\n3\n", ("--csv", "p.csv", "--unit", "cm"), "p.csv:2: has 1 columns; each line is x, y"),
        ("1,2\n", ("--csv", "p.csv"), "p.csv: does not say its unit"),
        ("1,2\n", ("--csv", "p.csv", "--unit", "px"), "units of length are m, cm, mm, in, ft"),
        ("", ("--csv", "p.csv", "--unit", "cm"), "p.csv: has no points"),
        ("1,2\n\n1,2.1\n", ("--csv", "p.csv", "--unit", "cm"), "p.csv:3: hold 2; holds 1 and 2 (lines 1 and 3) overlap"),
        ("1,2\n3,4\n", ("--pixels", "p.csv", "--scale", "1mm"), "p.csv:2: hold 2; holds 1 and 2 (lines 1 and 2) overlap"),
        ("x [cm],y [cm]\n1,2\n", ("--pixels", "p.csv", "--scale", "1mm"), "names the unit 'cm'"),
        ("1,2\n", ("--pixels", "p.csv", "--scale", "0mm"), "--scale = '0mm': must be more than 0 m"),
        ("1,2\n", ("--pixels", "p.csv", "--scale", "3"), "lacks its unit"),
        ("1,2\n", ("--pixels", "p.csv", "--scale", "3mm", "--origin", "1"), "must be two numbers of pixels"),
        ("1,2\n", ("--csv", "none.csv", "--unit", "cm"), "none.csv: does not exist"),
        ("1,2\n", ("--pixels", "p.csv"), "needs the size of a pixel"),
        ("1,2\n", ("--csv", "p.csv", "--pixels", "p.csv"), "are different ways to a board"),
        ("1,2\n", ("--unit", "cm"), "is for --csv"),
        ("1,2\n", ("--radius", "3mm"), "is for --csv and --pixels"),
    ],
)  # fmt: skip
def test_a_bad_table_is_told_by_file_and_line(
    run: Run, tmp_path: Path, table: str, words: tuple[str, ...], said: str
) -> None:
    (tmp_path / "p.csv").write_text(table)
    code, _, err = run("new", "board", *words, "-o", "wall.toml")
    plain = re.sub(r"[│╭╮╰╯─]", " ", err)
    assert code == 2 and said in " ".join(plain.split()), err
    assert not (tmp_path / "wall.toml").exists()


def test_a_task_on_a_table_can_be_planned(run: Run, tmp_path: Path) -> None:
    rows = [(15 * column + 7.5 * (row % 2), 15 * row) for row in range(6) for column in range(4)]
    (tmp_path / "holds.csv").write_text("x [cm], y [cm]\n" + "".join(f"{x},{y}\n" for x, y in rows))
    words = ("new", "board", "--csv", "holds.csv", "--task", "--set", "robot=gecko4", "-o", "climb.toml")
    assert run(*words)[0] == 0
    assert run("plan", "climb.toml", "--planner", "greedy", "-q")[0] == 0


@pytest.mark.parametrize(
    ("name", "kind"),
    [("libra", "robot"), ("hoshino", "robot"), ("gecko-wall", "board"), ("terrace", "ground"), ("ladder", "task"),
     ("terrace-walk", "task"), ("slope-walk", "walk"), ("ladder-hand", "plan")],
)  # fmt: skip
def test_what_comes_with_clamber_is_in_order_and_its_kind_is_told(run: Run, name: str, kind: str) -> None:
    code, out, _ = run("check", name, "--json")
    found = json.loads(out)
    assert code == 0 and found["kind"] == kind and found["ok"] and not found.get("odd")
    code, out, _ = run("check", name)
    assert code == 0 and max(map(len, out.splitlines())) <= 80


def test_a_start_that_does_not_hold_is_told_with_every_margin(run: Run) -> None:
    code, out, _ = run("check", "ladder", "--set", "start.y=2ft", "--json")
    found = json.loads(out)
    violated = [margin["check"] for margin in found["margins"] if margin["hard"] and not margin["holds"]]
    assert code == 1 and not found["ok"] and violated == ["reach"]
    code, _, err = run("plan", "ladder", "--set", "start.y=2ft", "-q")
    assert code == 2 and "violates the hard check 'reach'" in err
    reach = next(margin["margin"] for margin in found["margins"] if margin["check"] == "reach")
    assert f"by {-reach / INCH:.4g} in" in err


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('schema = "clamber-robot-2"\n', "schema = 'clamber-robot-2': must be one of clamber-robot-1, clamber-task-1"),
        ("weight = 3\n", "thing.toml: schema: must be one of"),
        ("x = = 3\n", "is not valid TOML"),
        (
            'schema = "clamber-robot-1"\nfamily = "flying"\n',
            "family = 'flying': must be one of limbed, spatial, walker",
        ),
        (
            'schema = "clamber-board-1"\nname = "b"\n',
            "a board states exactly one of 'holds', [ladder], [grid], [random]",
        ),
    ],
)
def test_a_broken_file_is_told_by_key(run: Run, tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "thing.toml").write_text(text)
    code, _, err = run("check", "thing.toml")
    assert code == 2 and said in " ".join(err.split())


def test_a_wrong_value_is_told_with_what_is_allowed(run: Run, tmp_path: Path) -> None:
    assert run("new", "robot", "-o", "mine.toml")[0] == 0
    text = Path("mine.toml").read_text()
    Path("mine.toml").write_text(
        text.replace('weight = { value = 20, unit = "N"', 'weight = { value = 20, unit = "kg"')
    )
    code, _, err = run("check", "mine.toml")
    assert code == 2 and "mine.toml: weight" in err and "allowed are N, kN, ozf, lbf, kgf" in " ".join(err.split())


def test_options_of_plans_are_refused_elsewhere(run: Run) -> None:
    assert run("check", "libra", "--all")[0] == 2
    assert run("check", "libra", "--task", "ladder")[0] == 2
    assert run("check", "libra", "--set", "weight=3N")[0] == 2
    assert run("check", "nothing-like-it")[0] == 2
