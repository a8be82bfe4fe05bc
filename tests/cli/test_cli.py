"""The command line: exit codes, JSON on stdout and nothing else, messages in place of tracebacks."""

import json
import os
import sqlite3
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import clamber
from clamber.cli import main
from clamber.jobs.store import Store

PRINTED = Path(clamber.__file__).parent / "families" / "climber" / "data" / "plans"
H_GA = str(PRINTED / "h-ga.toml")
LADDER = str(PRINTED / "ladder-hand.toml")


class Answer:
    """What one run of the command gave."""

    def __init__(self, code: int, out: str, err: str) -> None:
        self.code, self.out, self.err = code, out, err

    @property
    def json(self) -> Any:
        return json.loads(self.out)


@pytest.fixture
def run(capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.setenv("COLUMNS", "80")

    def call(*words: str) -> Answer:
        capfd.readouterr()
        try:
            main(words)
            code = 0
        except SystemExit as left:
            code = left.code if isinstance(left.code, int) else 0 if left.code is None else 1
        out, err = capfd.readouterr()
        return Answer(code, out, err)

    return call


def python(*words: str) -> subprocess.CompletedProcess[str]:
    environment = os.environ | {"PYTHONPATH": str(Path(clamber.__file__).parents[1]), "COLUMNS": "80"}
    return subprocess.run([sys.executable, *words], capture_output=True, text=True, env=environment, timeout=120)


def test_help_and_version_load_no_numba() -> None:
    for word in ("--help", "--version"):
        code = (
            f"import sys\nfrom clamber.cli import main\ntry:\n    main(['{word}'])\nfinally:\n"
            "    heavy = {'numba', 'numpy', 'scipy', 'matplotlib', 'pydantic'} & set(sys.modules)\n"
            "    print('heavy:', sorted(heavy))"
        )
        told = python("-c", code)
        assert told.returncode == 0, told.stderr
        assert told.stdout.endswith("heavy: []\n")


def test_version_is_that_of_the_package(run: Any) -> None:
    assert run("--version").out == f"clamber {clamber.__version__}\n"


@pytest.mark.parametrize("command", ["list", "plan", "check", "show", "bench", "study"])
def test_every_command_has_help(run: Any, command: str) -> None:
    answer = run(command, "--help")
    assert answer.code == 0 and "Usage: clamber" in answer.out
    assert max(map(len, answer.out.splitlines())) <= 80


@pytest.mark.parametrize(
    ("kind", "name"), [("robots", "libra"), ("boards", "circle"), ("tasks", "modified-ladder"), ("planners", "genetic")]
)
def test_list_names_what_there_is(run: Any, kind: str, name: str) -> None:
    answer = run("list", kind)
    assert answer.code == 0
    assert name in [line.split()[0] for line in answer.out.splitlines()]


def test_check_of_a_plan_that_holds_leaves_with_0(run: Any) -> None:
    answer = run("check", LADDER, "--json")
    assert answer.code == 0
    told = answer.json
    assert (told["ok"], told["steps"], told["first_violation"], told["reached"]) == (True, 63, None, True)
    assert told["max_torque_oz_in"] == pytest.approx(648, rel=0.005)
    assert set(told["final"]) == {"x_in", "y_in", "theta_deg", "holds", "pose"}
    assert set(told["per_step"][0]) >= {"step", "action", "ok", "reason", "hold", "max_torque_oz_in"}
    assert [row["action"] for row in told["per_step"]][:4] == [0, 106, 301, 205]
    assert told["per_step"][1]["hold"] == 6


def test_check_of_a_plan_that_fails_leaves_with_1_and_says_where(run: Any) -> None:
    answer = run("check", H_GA, "--set", "start.y=6.2in", "--json")
    assert answer.code == 1
    first = answer.json["first_violation"]
    assert (first["step"], first["action"], first["check"]) == (120, 3, "reach")
    assert first["margin"] < 0 and "reach" in first["reason"]
    assert answer.json["nearest_rule"] == {"agree": 32, "of": 32}
    assert answer.json["per_step"][2] | {"margins": 0} == {
        "step": 3,
        "action": 293,
        "ok": True,
        "check": None,
        "reason": None,
        "hold": 4,
        "nearest": 4,
        "max_torque_oz_in": answer.json["per_step"][2]["max_torque_oz_in"],
        "power_W": answer.json["per_step"][2]["power_W"],
        "reported": [],
        "margins": 0,
    }


def test_all_goes_on_past_a_violation(run: Any) -> None:
    words = ("check", LADDER, "--set", "motor.torque_limit=600oz-in", "--json")
    stopped, went_on = run(*words), run(*words, "--all")
    assert stopped.code == went_on.code == 1
    assert len(stopped.json["per_step"]) < len(went_on.json["per_step"]) == 63
    assert stopped.json["first_violation"] == went_on.json["first_violation"]


def test_check_reads_well_in_80_columns_without_colour(run: Any) -> None:
    for words in (("check", H_GA, "--set", "start.y=6.2in"), ("check", H_GA, "--set", "start.y=6.2in", "--all")):
        answer = run(*words)
        assert answer.code == 1
        assert "\x1b" not in answer.out
        assert max(map(len, answer.out.splitlines())) <= 80
        assert "VIOLATED at step 120 of 120 (+y): reach is short by 0.04142 in" in answer.out
        assert "32 of 32 grabs" in answer.out
        assert "step sizes as the plan file says" in answer.out
        assert "limb_peg: 10 steps" in answer.out
    assert len(answer.out.splitlines()) > 120  # the last one had --all


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("check", "missing.json"), "missing.json: does not exist"),
        (("check", "missing.toml"), "missing.toml: does not exist"),
        (("check", LADDER, "--task", "leiter"), "no task is called 'leiter'"),
        (("check", LADDER, "--set", "start.y=6.2"), "start.y"),
        (("check", LADDER, "--set", "start.y"), "write key=value"),
        (("check", LADDER, "--set", "start.holds.right=3"), "two limbs are on hold 3"),
        (("check", LADDER, "--set", "start.y=30in"), "violates the hard check"),
        (("plan", "lader"), "did you mean 'ladder'"),
        (("plan", "ladder", "--planner", "genetik"), "no planner is called 'genetik'"),
        (("plan", "ladder", "--set", "step.length=-1in"), "step.length"),
        (("plan", "ladder", "--set", "goal.y_min=200in"), "from the nearest hold"),
        (("plan", "ladder", "-o", "no/such/folder/plan.json"), "does not exist"),
        (("plan", "ladder", "--seed", "-1"), "--seed"),
        (("plan", "ladder", "--evaluations", "0"), "--evaluations"),
        (("show", "leiter"), "no plan, task, walk, robot, board, world or ground is called 'leiter'"),
        (("show", "ladder-hans"), "did you mean 'ladder-hand'"),
        (("run", "slope-wak"), "no task, plan or walk is called 'slope-wak'"),
        (("trials", "slope-wak"), "did you mean 'slope-walk'"),
        (("show", "ladder", "--step", "3", "-o", "x.png"), "past the last step"),
        (("show", "ladder", "-o", "x.bmp"), "allowed are"),
        (("show", "ladder", "--torques", "-o", "x.png"), "needs the plan of a limbed robot"),
        (("list", "nonsense"), "nonsense"),
        (("bench", "nonsense"), "no benchmark is called 'nonsense'"),
        (("bench", "climb", "nonsense"), "no benchmark is called 'nonsense'"),
        (("bench", "climb", "-o", "x.png"), "a page is Markdown"),
        (("bench", "climb", "seeds", "--workers", "2"), "are for one of"),
        (("study", "nonsense"), "no study is called 'nonsense'"),
        (("nonsense",), "nonsense"),
    ],
)
def test_bad_input_leaves_with_2_and_one_message(
    run: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...], message: str
) -> None:
    monkeypatch.chdir(tmp_path)
    answer = run(*words)
    assert answer.code == 2
    assert answer.out == ""
    assert message in " ".join(answer.err.replace("│", " ").split())
    assert "Traceback" not in answer.err
    assert list(tmp_path.iterdir()) == []


def test_a_corrupt_plan_file_leaves_with_2(run: Any, tmp_path: Path) -> None:
    path = tmp_path / "plan.json"
    path.write_text('{"schema": "clamber-plan-1", "task": "ladder", "actions": [1]}')
    answer = run("check", str(path))
    assert answer.code == 2 and str(path) in answer.err and "actions.0" in answer.err


def test_a_search_without_success_leaves_with_1_and_says_how_far_it_came(run: Any, tmp_path: Path) -> None:
    output = tmp_path / "furthest.json"
    answer = run("plan", "ladder", "--evaluations", "20", "--threads", "1", "--json", "--quiet", "-o", str(output))
    assert answer.code == 1 and answer.err == ""
    assert answer.json["status"] == "stopped" and answer.json["furthest"]["stopped_by"]
    assert run("check", str(output), "--json").json["reached"] is False
    human = run("plan", "ladder", "--evaluations", "20", "--threads", "1")
    assert human.code == 1 and "no plan for 'ladder'" in human.out and "furthest:" in human.out


@pytest.mark.slow
def test_a_found_plan_is_written_checked_and_the_same_again(run: Any, tmp_path: Path) -> None:
    output = tmp_path / "plan.json"
    answer = run("plan", "ladder", "--seed", "1", "--json", "-o", str(output))
    told = answer.json
    assert answer.code == 0 and told["status"] == "found" and told["length"] == len(told["codes"])
    assert "layer" in answer.err
    checked = run("check", str(output), "--json")
    assert checked.code == 0 and checked.json["reached"] and checked.json["steps"] == told["length"]
    assert checked.json["max_torque_oz_in"] == pytest.approx(told["max_torque_oz_in"])
    again = run("plan", "ladder", "--seed", "1", "--json", "--quiet", "--threads", "1").json
    assert again | {"seconds": 0} == told | {"seconds": 0}


@pytest.mark.parametrize("words", [("ladder",), (LADDER,), (LADDER, "--step", "10"), (LADDER, "--torques")])
def test_show_draws_tasks_and_plans(run: Any, tmp_path: Path, words: tuple[str, ...]) -> None:
    path = tmp_path / "picture.png"
    answer = run("show", *words, "-o", str(path))
    assert answer.code == 0 and str(path) in answer.out
    assert path.read_bytes()[:4] == b"\x89PNG"


@pytest.mark.slow
@pytest.mark.parametrize(("suffix", "mark"), [(".gif", b"GIF8"), (".html", b"<!doc")])
def test_show_moves_plans(run: Any, tmp_path: Path, suffix: str, mark: bytes) -> None:
    path = tmp_path / f"plan{suffix}"
    assert run("show", LADDER, "-o", str(path)).code == 0
    assert path.read_bytes()[:10].lower().startswith(mark.lower())


def test_an_interrupt_leaves_with_130_without_a_traceback(run: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("clamber.planning.problem.plan_source.open_plan", interrupt)
    answer = run("check", LADDER)
    assert answer.code == 130 and "Traceback" not in answer.err


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--vary", "motor.torque=8Nm..9Nm"), "motor.torque = '8 Nm': unknown key"),
        (("--vary", "engine.torque_limit=8Nm..9Nm"), "unknown key; a key starts with"),
        (("--vary", "motor.torque_limit=9Nm..8Nm"), "the range is empty; the first end must be less than the second"),
        (("--vary", "motor.torque_limit=8Nm..9Nm:2", "--ray", "127.0.0.1:1"), "--ray 127.0.0.1:1: nothing answers there"),
        (("--vary", "motor.torque_limit=8Nm..9Nm:2", "--store", "other.db"), "holds the results of the sweep of 'h' over"),
        (("--vary", "motor.torque_limit=8Nm..9Nm:2", "--store", "plain.txt"), "is no store of results"),
        (("--vary", "motor.torque_limit=8Nm..9Nm:2", "--store", "old.db"), "has the schema 'clamber-jobs-0', not 'clamber-jobs-1'"),
    ],
)  # fmt: skip
def test_a_sweep_that_cannot_be_is_told_before_work_starts(
    words: tuple[str, ...], message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:  # fmt: skip
    if "--ray" in words:
        pytest.importorskip("ray")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("clamber.jobs.local.LocalProcesses.run", lambda *_: pytest.fail("work started"))
    (tmp_path / "plain.txt").write_text(
        "no database, but longer than the header of one, which has one hundred bytes\n" * 3
    )
    other = "the sweep of 'h' over motor.torque_limit"
    for name, title, schema in (("other", other, "clamber-jobs-1"), ("old", other, "clamber-jobs-0")):
        Store(tmp_path / f"{name}.db", "another", title, resume=False).__exit__(None, None, None)
        with sqlite3.connect(tmp_path / f"{name}.db") as file:
            file.execute("UPDATE about SET value = ? WHERE key = 'schema'", (schema,))
        file.close()
    with pytest.raises(SystemExit) as left:
        main(["sweep", "ladder", *words])
    assert left.value.code == 2
    told = " ".join(capsys.readouterr().err.split())
    assert message in told and "Traceback" not in told
