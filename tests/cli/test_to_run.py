"""Plans that can be carried out: `clamber plan --to-run`, and what `plan` and `check` say of plans that `clamber run` refuses."""

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import TypeAlias

import pytest
from jsonschema import Draft202012Validator

from clamber.cli.printed.library import schema_of
from clamber.family import family_of
from clamber.tasks import load_task, task_names
from clamber.trials.work import open_work

Run: TypeAlias = Callable[..., tuple[int, str, str]]
HOPELESS = "rules.max_hangs=0"
"""Leaves `gap` without a plan."""


def test_plan_and_check_name_the_limit_that_stops_a_run_and_what_makes_a_plan_without(
    clamber: Run, tmp_path: Path
) -> None:
    plan = str(tmp_path / "p.json")
    code, out, _ = clamber("plan", "ladder", "--planner", "genetic", "-o", plan, "-q")
    assert code == 0
    assert "to run: refused, step 18: left grabs 15: hook is -1.996 lbf" in out
    assert "for one that can be carried out: this command with --to-run" in out
    code, out, _ = clamber("check", plan)
    assert code == 0
    assert "to run: refused, step 18" in out
    assert "for one that can be carried out: clamber plan ladder --to-run" in out
    code, _, err = clamber("run", plan, "-q")
    assert code == 2
    assert "step 18: left grabs 15: hook is -1.996 lbf" in err and "clamber plan ladder --to-run" in err
    for command in (("check", plan), ("run", plan, "-q"), ("trials", plan, "-q")):
        told = " ".join(clamber(*command, "--units", "si")[1:])
        assert "step 18: left grabs 15: hook is -8.879 N" in told, command


def test_the_limit_of_a_walkers_plan_is_in_the_units_that_are_asked_for(clamber: Run, tmp_path: Path) -> None:
    plan = str(tmp_path / "p.json")
    assert clamber("plan", "patch-walk", "--planner", "greedy", "-o", plan, "-q")[0] == 0
    for units, unit in (("si", " mm"), ("imperial", " in")):
        out = " ".join(clamber("check", plan, "--set", "rules.balance=60mm", "--units", units)[1].split())
        told = re.search(r"to run: refused, step \d+: balance is short by [\d.]+( \w+) \(", out)
        assert told is not None and told[1] == unit


@pytest.mark.slow
@pytest.mark.parametrize("task", ["gap", "patch-walk"])
def test_a_plan_made_to_run_is_carried_out(clamber: Run, tmp_path: Path, task: str) -> None:
    plan = str(tmp_path / "p.json")
    code, out, _ = clamber("plan", task, "--to-run", "-o", plan, "-q")
    assert code == 0, out
    assert "to run: nothing speaks against it" in out
    said = json.loads(clamber("check", plan, "--json")[1])
    assert said["ok"] and said["to_run"] == {"ok": True, "objection": None, "command": None}
    code, out, _ = clamber("run", plan, "-q")
    assert code == 0, out


def test_json_says_whether_a_run_would_be_refused(clamber: Run, tmp_path: Path) -> None:
    plan = str(tmp_path / "p.json")
    code, out, _ = clamber("plan", "ladder", "--set", "step.length=2.5in", "-o", plan, "-q", "--json")
    assert code == 0
    Draft202012Validator(schema_of("plan")).validate(json.loads(out))
    checked = json.loads(clamber("check", plan, "--json")[1])["to_run"]
    assert checked == json.loads(out)["to_run"]
    assert checked["ok"] is (checked["objection"] is None)


def test_without_a_plan_that_can_be_carried_out_nothing_is_written(clamber: Run, tmp_path: Path) -> None:
    plan = tmp_path / "p.json"
    code, out, err = clamber("plan", "gap", "--set", HOPELESS, "--to-run", "-o", str(plan), "-q")
    assert (code, out) == (1, "")
    assert "no plan for 'gap' that hooks can be trusted with" in err
    assert not plan.exists()


def test_it_plans_as_run_does_with_no_options_of_other_searches(clamber: Run) -> None:
    code, _, err = clamber("plan", "gap", "--to-run", "--width", "10")
    assert code == 2
    assert "--width" in err and "as `clamber run` does" in err


MANY = "is for 3 limbs, and 'gecko4' has 4 that grip"


def test_a_robot_with_more_limbs_than_climbers_control_knows_is_carried_out_in_space(
    clamber: Run, tmp_path: Path
) -> None:
    plan, low = str(tmp_path / "p.json"), ("--set", "goal.y_min=45 cm")
    code, out, err = clamber("run", "gecko-climb", *low)
    assert code == 0 and "carried out: 'gecko-climb'" in out
    assert MANY in err and "carried out as a robot in space" in err
    assert clamber("plan", "gecko-climb", *low, "--to-run", "-q", "-o", plan)[0] == 0
    assert clamber("run", plan, "-q")[0] == 0
    code, out, err = clamber("run", "gecko-climb", "--force", "--set", "plant.law=none", "-q")
    assert code == 2 and "motor_limits" in err  # of the climber's own plant


def test_a_plan_of_a_robot_that_climbers_control_does_not_know_is_refused(clamber: Run, tmp_path: Path) -> None:
    plan = str(tmp_path / "p.json")
    code, out, _ = clamber("plan", "gecko-climb", "--planner", "greedy", "-q", "-o", plan)
    assert code == 0 and MANY in " ".join(out.split()) and "--to-run" not in out
    for command in ("run", "trials"):
        code, out, err = clamber(command, plan, "-q")
        assert (code, out) == (2, "")
        assert MANY in err and "--force" in err


def test_three_weak_limbs_are_refused_before_anything_is_searched_for(clamber: Run, tmp_path: Path) -> None:
    """Two holds would not keep the robot to its wall while the third limb swings."""
    robot, wall, task = (str(tmp_path / name) for name in ("r.toml", "w.toml", "t.toml"))
    assert clamber("new", "robot", "--limbs", "3", "-o", robot)[0] == 0
    assert clamber("new", "board", "-o", wall)[0] == 0
    assert clamber("new", "task", "--robot", robot, "--board", wall, "-o", task)[0] == 0
    for words in (("run", task, "-q"), ("plan", task, "--to-run", "-q")):
        code, out, err = clamber(*words, "--set", "motor.torque_limit=3 N m")
        assert (code, out) == (1, "")
        assert "asks up to 4 N m of every joint" in err and "gives 3 N m" in err and "nothing has moved" in err


def test_that_climbs_of_a_robot_are_not_tried_is_said_before_it_is_planned() -> None:
    note = open_work("ladder", settings=("weight=45 N",)).note
    assert note is not None
    assert note.startswith("'libra' is none of the robots with which climbs are tried (libra, libra-grippers, as they ")
    assert note.endswith("docs/own-robot.md says which robots do")
    assert all(open_work(tried).note is None for tried in ("ladder", "gap", "wall-gripper", "patch-walk", "slope-walk"))


def test_motors_are_asked_for_as_much_as_the_robot_is_heavy(clamber: Run, tmp_path: Path) -> None:
    plan = str(tmp_path / "p.json")
    for torque, weight, asked in ((5, 40, "asks up to 7.99 N m"), (5, 25, None), (8, 80, "asks up to 16 N m")):
        changed = ("--set", f"motor.torque_limit={torque} N m", "--set", f"weight={weight} N")
        assert clamber("plan", "ladder", *changed, "--planner", "greedy", "-q", "-o", plan)[0] == 0
        told = " ".join(clamber("check", plan)[1].split())
        assert (asked in told) if asked else ("N m of every joint" not in told)


@pytest.mark.long
@pytest.mark.parametrize("task", [name for name in task_names() if family_of(load_task(name)).dynamics is not None])
def test_no_shipped_task_is_planned_to_run_and_refused(clamber: Run, tmp_path: Path, task: str) -> None:
    plan = str(tmp_path / "p.json")
    planned, said, _ = clamber("plan", task, "--to-run", "-o", plan, "-q")
    assert planned in (0, 1), said
    if planned == 0:
        code, out, err = clamber("run", plan, "-q")
        assert code in (0, 1), err
        assert Path(plan).is_file() and load_task(task).name in out
