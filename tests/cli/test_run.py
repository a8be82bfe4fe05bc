"""`clamber run`: what it prints, writes and refuses."""

import json
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from clamber.execution.log_files import read_log
from clamber.families.climber.execution.climb_trace import ClimbTrace
from clamber.families.climber.execution.executable_plan import climbable
from clamber.families.climber.planning.plans import thesis_code
from clamber.families.climber.planning.task import LimbedTask
from clamber.planning.problem.plan import Plan, load_plan
from clamber.tasks import load_task


@pytest.fixture
def run(clamber: Any) -> Any:
    return partial(clamber, "run")


def plan_file(folder: Path, *numbers: int, changes: tuple[str, ...] = ()) -> str:
    task = load_task("ladder", changes)
    assert isinstance(task, LimbedTask)
    strict = climbable(task)
    Plan.of_codes(strict, [thesis_code(strict, number) for number in numbers]).save(folder / "plan.json")
    return str(folder / "plan.json")


def test_a_plan_is_carried_out_and_its_log_holds_the_report(run: Any, tmp_path: Path) -> None:
    plan, log = plan_file(tmp_path, 300, 3), tmp_path / "run.mcap"
    code, out, err = run(plan, "-o", str(log), "--json")
    said = json.loads(out)
    assert code == 0, said["reason"]
    assert [action["outcome"] for action in said["actions"]] == ["ok", "ok"]
    assert "action 1 of 2" in err
    trace = ClimbTrace.from_log(read_log(log))
    assert trace.notes is not None
    assert trace.notes["actions"] == said["actions"]
    assert trace.true_pose is not None


def test_the_table_fits_and_names_every_kind_of_action(run: Any, tmp_path: Path) -> None:
    code, out, _ = run(plan_file(tmp_path, 300, 3, 4), "--set", "plant.backlash=1deg", "--peg-error", "1mm", "-q")
    assert code == 0, out
    assert "climbed: 3 actions" in out
    assert "release" in out and "move" in out
    assert max(map(len, out.splitlines())) <= 80


def test_one_run_leaves_log_picture_and_plan(run: Any, tmp_path: Path) -> None:
    plan, kept = plan_file(tmp_path, 300, 3), tmp_path / "kept.json"
    files = [tmp_path / name for name in ("run.mcap", "run.png", "run.csv")]
    code, out, _ = run(plan, *(word for file in files for word in ("-o", str(file))), "--save-plan", str(kept), "-q")
    assert code == 0
    for file in files:
        assert f"written: {file}" in out
        assert file.stat().st_size > 1000
    assert load_plan(kept).actions == load_plan(Path(plan)).actions


def test_a_plan_that_is_refused_moves_nothing_and_leaves_with_2(run: Any, tmp_path: Path) -> None:
    plan, log = plan_file(tmp_path, 300, 3, 3, 3, 3, 3, 3), tmp_path / "run.mcap"
    code, out, err = run(plan, "-o", str(log), "-q")
    assert (code, out) == (2, "")
    assert "step" in err and "--force" in err and "Traceback" not in err
    assert not log.exists()


def test_a_forced_plan_that_falls_leaves_with_1_and_a_whole_log(run: Any, tmp_path: Path) -> None:
    plan, log = plan_file(tmp_path, 300, *([2] * 8)), tmp_path / "run.mcap"
    code, out, _ = run(plan, "-o", str(log), "--json", "--force", "-q")
    said = json.loads(out)
    assert code == 1
    assert said["reason"].startswith("fell")
    assert said["forced"]
    trace = ClimbTrace.from_log(read_log(log))
    assert trace.time[-1] == pytest.approx(said["seconds"])
    assert trace.notes is not None and trace.notes["forced"] == said["forced"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("ladder", "--set", "plant.backlsh=1deg"), "backlash"),
        (("ladder", "--set", "plant.backlash=banana"), "backlash"),
        (("ladder", "--peg-error", "3"), "unit"),
        (("ladder", "--planner", "magic"), "genetic"),
        (("ladder", "-o", "run.txt"), ".mcap"),
        (("patch-walk", "--peg-error", "3mm"), "--peg-error"),
        (("nowhere",), "ladder"),
        (("missing.json",), "missing.json"),
    ],
)
def test_bad_input_is_one_message(run: Any, words: tuple[str, ...], said: str) -> None:
    code, out, err = run(*words, "-q")
    assert (code, out) == (2, "")
    assert said in err and "Traceback" not in err


def test_pegs_off_by_less_than_nothing_are_refused(run: Any) -> None:
    code, _, err = run("ladder", "--peg-error", "-3mm", "-q")
    assert code == 2
    assert "peg" in err
