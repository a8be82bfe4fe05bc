"""The examples: numbered by idea, at most a hundred lines each, and each does what it says."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import clamber

EXAMPLES = Path(__file__).parents[2] / "examples"
SCRIPTS = sorted(EXAMPLES.glob("*.py"))
MOST_LINES = 100


def run(script: str, folder: Path) -> str:
    environment = os.environ | {"PYTHONPATH": str(Path(clamber.__file__).parents[1]), "MPLBACKEND": "agg"}
    words = [sys.executable, str(EXAMPLES / script), str(folder)]
    done = subprocess.run(words, capture_output=True, text=True, env=environment, timeout=900, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_they_are_numbered_by_idea_and_short() -> None:
    assert [int(path.name[:2]) for path in SCRIPTS] == list(range(1, len(SCRIPTS) + 1))
    for path in SCRIPTS:
        lines = path.read_text().splitlines()
        assert len(lines) <= MOST_LINES and max(map(len, lines)) <= 140, path.name
        assert lines[0].startswith('"""'), f"{path.name} says first what it shows"


def test_every_script_has_a_test_here() -> None:
    said = Path(__file__).read_text()
    assert all(path.name in said for path in SCRIPTS)


@pytest.mark.slow
def test_a_plan_is_proved_and_judged(tmp_path: Path) -> None:
    out = run("01_plan_a_climb.py", tmp_path)
    assert out.startswith("optimal: 30 actions; no plan has fewer than 30 actions")
    assert "OK, goal reached" in out and "(hard)" in out
    assert clamber.check(tmp_path / "ladder.json").reached
    assert (tmp_path / "ladder.png").stat().st_size > 10_000


@pytest.mark.slow
def test_an_own_robot_climbs_an_own_wall(tmp_path: Path) -> None:
    out = run("02_own_robot_and_wall.py", tmp_path)
    assert len(re.findall(r"; 0 odd$", out, re.MULTILINE)) == 3
    assert re.search(r"^found: \d+ actions$", out, re.MULTILINE)
    assert "l1 = 10cm: " in out and "violates the hard check" in out
    assert (tmp_path / "four-limbs.png").stat().st_size > 10_000


@pytest.mark.long
def test_five_holds_have_no_plan_and_the_reason_is_told(tmp_path: Path) -> None:
    out = run("03_five_holds_no_plan.py", tmp_path)
    assert re.match(r"infeasible: all \d+ reachable stances were seen and none meets the goal", out)
    assert "it opens with rules.min_supports: 3 -> 2" in out
    task = clamber.load_task(str(EXAMPLES / "five_holds" / "climb.toml"), ["rules.min_supports=2"])
    assert clamber.plan(task, "exact").status == "optimal"


@pytest.mark.slow
def test_a_printed_plan_is_climbed_on_pegs_that_are_off(tmp_path: Path) -> None:
    out = run("04_run_a_climb.py", tmp_path)
    assert out.startswith("done after") and " ok " in out
    assert (tmp_path / "climb.png").stat().st_size > 10_000


@pytest.mark.slow
def test_laws_are_compared_on_a_circle(tmp_path: Path) -> None:
    out = run("05_compare_controllers.py", tmp_path)
    assert re.findall(r"^  (\S+) +\d+\.\d+ mm off the circle", out, re.MULTILINE) == [
        "scct", "jacobian-transpose", "operational-space"
    ]  # fmt: skip
    assert (tmp_path / "circle.png").is_file() and len((tmp_path / "circle.csv").read_text().splitlines()) == 4


@pytest.mark.long
def test_a_walker_goes_up_a_slope(tmp_path: Path) -> None:
    out = run("06_walk_up_a_slope.py", tmp_path)
    assert out.startswith("done: ")
    tilt = re.search(r"never more than (\d+\.\d+) deg from level", out)
    assert tilt is not None and float(tilt[1]) < 1.0


@pytest.mark.slow
def test_an_own_planner_finds_a_plan_that_holds(tmp_path: Path) -> None:
    out = run("07_own_planner.py", tmp_path)
    found, best = (int(length) for length in re.findall(r"(\d+) actions", out))
    assert "carried out again: OK" in out and best <= found <= best + 5


@pytest.mark.slow
def test_a_robot_in_space_climbs_an_overhang_until_its_grips_are_too_weak(tmp_path: Path) -> None:
    out = run("08_robot_in_space.py", tmp_path)
    assert ": 0 odd" in out
    assert re.search(r"^found: \d+ actions$", out, re.MULTILINE) and "checked again: OK" in out
    grip = re.search(r"least grip left (\S+) N", out)
    assert grip is not None and float(grip[1]) > 0.0
    assert re.search(r"^9 N: .*violate .equilibrium", out, re.MULTILINE)
    assert (tmp_path / "overhang.png").stat().st_size > 20_000


@pytest.mark.slow
def test_our_controller_does_in_environments_what_no_torque_does_not(tmp_path: Path) -> None:
    pytest.importorskip("gymnasium")
    out = run("09_environments.py", tmp_path)
    for name in ("Climb", "Walk"):
        assert re.search(rf"^clamber/{name}-v0, noise none, idle: 0 of 1 done, return -", out, re.MULTILINE)
        assert re.search(rf"^clamber/{name}-v0, noise none, ours: 1 of 1 done, return 1\d\.", out, re.MULTILINE)
    assert len((tmp_path / "environments.csv").read_text().splitlines()) == 9


def test_the_own_planner_plans_for_walkers_too() -> None:
    import runpy

    plan = runpy.run_path(str(EXAMPLES / "07_own_planner.py"))["plan_widest"]
    result = plan(clamber.load_task("patch-walk"), width=100)
    assert result.has_plan and result.check().reached
