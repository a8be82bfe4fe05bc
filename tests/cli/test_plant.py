"""A plant in another process: a climb through it, whoever dies, and what is refused."""

import json
import os
import re
import select
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from jsonschema import Draft202012Validator

from clamber.benchmarks.plant_bench import SERVE, served
from clamber.cli.printed.library import schema_of
from clamber.execution.log_files import read_log
from clamber.families.climber.execution.climb_trace import ClimbTrace
from clamber.families.climber.execution.executable_plan import climbable
from clamber.families.climber.planning.plans import thesis_code
from clamber.families.climber.planning.task import LimbedTask
from clamber.planning.problem.plan import Plan
from clamber.tasks import load_task

PEGS = ("--noise", "peg_error=3mm", "--seed", "5")
PATIENCE = 120.0  # a busy machine may compile first [s]


def plan_file(folder: Path, *numbers: int) -> str:
    task = load_task("ladder", ())
    assert isinstance(task, LimbedTask)
    strict = climbable(task)
    Plan.of_codes(strict, [thesis_code(strict, number) for number in numbers]).save(folder / "plan.json")
    return str(folder / "plan.json")


def client(*words: str) -> "subprocess.Popen[str]":
    """`clamber run` in a process of its own that has begun to climb."""
    command = [sys.executable, "-c", SERVE, "run", *words]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stderr is not None
    for line in process.stderr:
        if line.startswith("action "):
            return process
    raise AssertionError(f"it never began: {process.communicate()}")


def said_until(stream: Any, word: str, patience: float = PATIENCE) -> str:
    """What a process says up to a line with a word, or for so long [s]."""
    said, until = "", time.monotonic() + patience
    while word not in said and time.monotonic() < until:
        if select.select([stream], [], [], 1.0)[0]:
            said += os.read(stream.fileno(), 4096).decode()
    return said


def moved(said: str) -> float:
    """How far a joint has moved in the hold that a server tells of [deg]."""
    match = re.search(r"held for 2 s: no joint has moved by more than ([0-9.]+) deg", said)
    assert match is not None, said
    return float(match[1])


@pytest.mark.slow
def test_a_climb_through_a_socket_is_the_same_climb_to_the_last_bit(clamber: Any, tmp_path: Path) -> None:
    plan, logs = plan_file(tmp_path, 191, 300), [tmp_path / "here.csv", tmp_path / "there.csv"]
    assert clamber("run", plan, "--plant", "volts", *PEGS, "-o", str(logs[0]), "-q")[0] == 0
    with served("ladder", *PEGS, "--once") as (server, address):
        code, out, _ = clamber("run", plan, "--plant", address, *PEGS, "-o", str(logs[1]), "-q", "--json")
        _, said = server.communicate(timeout=PATIENCE)
        assert server.returncode == 0, said
    assert code == 0
    report = json.loads(out)
    assert [action["outcome"] for action in report["actions"]] == ["ok", "ok"]
    here, there = (ClimbTrace.from_log(read_log(log)) for log in logs)
    assert len(here.time) > 200
    for key in ("time", "step", "believed", "aim", "angles", "torques", "holds", "carries", "true_pose", "true_angles"):
        assert np.array_equal(getattr(here, key), getattr(there, key)), key


@pytest.mark.slow
def test_a_client_that_is_killed_leaves_the_robot_on_its_pegs_and_the_next_one_climbs(
    clamber: Any, tmp_path: Path
) -> None:
    plan = plan_file(tmp_path, 191, 300)
    with served("ladder", *PEGS, "--socket", str(tmp_path / "robot")) as (server, address):
        first = client(plan, "--plant", address)
        first.send_signal(signal.SIGKILL)
        first.communicate()
        said = said_until(server.stderr, "held for")
        assert re.search(r"safe stop at tick \d+: its client is gone", said), said
        assert moved(said) < 1.0
        assert clamber("run", plan_file(tmp_path, 300), "--plant", address, *PEGS, "-q")[0] == 0


@pytest.mark.slow
def test_a_client_of_a_real_time_plant_that_is_killed_leaves_the_robot_on_its_pegs(tmp_path: Path) -> None:
    plan = plan_file(tmp_path, 300, 3)
    slowly = ("--real-time", "--pace", "0.4", "--set", "plant.delay=0", "--once")
    with served("ladder", *slowly) as (server, address):
        first = client(plan, "--plant", address)
        first.send_signal(signal.SIGKILL)
        first.communicate()
        _, said = server.communicate(timeout=PATIENCE)
        assert server.returncode == 1, "it tells that it had to stop"
        assert re.search(r"safe stop at tick \d+: (its client is gone|no command came for two ticks)", said), said
        assert moved(said) < 1.0


@pytest.mark.slow
def test_a_client_that_stalls_finds_a_real_time_plant_stopped(tmp_path: Path) -> None:
    plan, log = plan_file(tmp_path, 300, 3), tmp_path / "run.csv"
    with served("ladder", "--real-time", "--pace", "0.4", "--set", "plant.delay=0") as (server, address):
        stalled = client(plan, "--plant", address, "-o", str(log), "--json")
        said, until = "", time.monotonic() + PATIENCE
        while "safe stop" not in said and time.monotonic() < until:  # one that thinks has said so, and may be silent
            stalled.send_signal(signal.SIGCONT)
            time.sleep(0.05)
            stalled.send_signal(signal.SIGSTOP)
            said += said_until(server.stderr, "safe stop", patience=1.0)
        said += said_until(server.stderr, "held for")
        assert "no command came for two ticks" in said and moved(said) < 1.0
        stalled.send_signal(signal.SIGCONT)
        out, _ = stalled.communicate(timeout=PATIENCE)
    assert stalled.returncode == 1
    report = json.loads(out)
    assert report["reason"] == "stopped: the plant has made a safe stop: no command came for two ticks"
    assert ClimbTrace.from_log(read_log(log)).time[-1] == pytest.approx(report["seconds"])


@pytest.mark.slow
def test_a_server_that_is_killed_ends_the_run_with_a_reason_and_a_whole_log(tmp_path: Path) -> None:
    plan, log = plan_file(tmp_path, 191, 300), tmp_path / "run.csv"
    with served("ladder", *PEGS, "-q") as (server, address):
        climbing = client(plan, "--plant", address, *PEGS, "-o", str(log), "--json")
        server.send_signal(signal.SIGKILL)
        out, err = climbing.communicate(timeout=PATIENCE)
    assert climbing.returncode == 1
    report = json.loads(out)
    assert report["reason"].startswith("stopped: the plant's server is lost")
    assert report["actions"][-1]["outcome"] == "stopped"
    assert "Traceback" not in err
    trace = ClimbTrace.from_log(read_log(log))
    assert trace.time[-1] == pytest.approx(report["seconds"])
    assert trace.notes is not None and trace.notes["reason"] == report["reason"]


def test_a_served_plant_of_another_board_is_refused(clamber: Any, tmp_path: Path) -> None:
    with served("h", "-q") as (_, address):
        code, out, err = clamber("run", plan_file(tmp_path, 300), "--plant", address, "-q")
        assert (code, out) == (2, "")
        assert "its place is 'h'; must be 'ladder'" in err and "Traceback" not in err


@pytest.mark.slow
@pytest.mark.parametrize(("number", "code"), [(signal.SIGTERM, 143), (signal.SIGHUP, 129)])
def test_a_server_that_is_ended_stops_the_robot_safely_first_and_says_so(
    tmp_path: Path, number: signal.Signals, code: int
) -> None:
    plan = plan_file(tmp_path, 191, 300)
    with served("ladder", *PEGS, "--socket", str(tmp_path / "robot")) as (server, address):
        climbing = client(plan, "--plant", address, *PEGS, "--json")
        server.send_signal(number)
        out, _ = climbing.communicate(timeout=PATIENCE)
        _, said = server.communicate(timeout=PATIENCE)
    assert server.returncode == code
    assert re.search(rf"safe stop at tick \d+: its server ends \({number.name}\); the posture is held", said), said
    assert moved(said) < 1.0
    assert f"the server ends ({number.name}): nothing holds the robot any more" in said
    assert climbing.returncode == 1
    assert json.loads(out)["reason"] == "stopped: the plant has made a safe stop: its server ends"


@pytest.mark.slow
def test_an_operator_stops_a_climb_from_another_process_and_gives_the_robot_back(clamber: Any, tmp_path: Path) -> None:
    plan = plan_file(tmp_path, 191, 300)
    with served("ladder", *PEGS) as (server, address):
        climbing = client(plan, "--plant", address, *PEGS, "--json")
        code, out, _ = clamber("plant", "stop", address)
        assert code == 0 and re.match(r"stopped at tick \d+; an operator has stopped this plant", out), out
        assert json.loads(climbing.communicate(timeout=PATIENCE)[0])["reason"] == (
            "stopped: the plant has made a safe stop: an operator has stopped it"
        )
        assert moved(said_until(server.stderr, "held for")) < 1.0
        code, _, err = clamber("run", plan, "--plant", address, "-q")
        assert code == 2 and "an operator has stopped this plant; `clamber plant release` gives it back" in err
        for command in ("stop", "release"):
            code, out, _ = clamber("plant", command, address, "--json")
            schema = {"stop": schema_of("plant stop"), "release": schema_of("plant release")}[command]
            Draft202012Validator(schema).validate(json.loads(out))
            assert code == 0 and json.loads(out)["address"] == address
        assert json.loads(out)["said"] == "clients may start again"
        assert clamber("run", plan_file(tmp_path, 300), "--plant", address, *PEGS, "-q")[0] == 0


def test_who_may_not_read_the_servers_token_stops_nothing(clamber: Any, tmp_path: Path, monkeypatch: Any) -> None:
    with served("ladder", "-q") as (server, address):
        monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))  # another user's
        code, out, err = clamber("plant", "stop", address)
        assert (code, out) == (2, "") and "cannot read its token" in err
        assert server.poll() is None


def test_ctrl_c_ends_a_server_and_its_socket(tmp_path: Path) -> None:
    path = tmp_path / "robot"
    with served("ladder", "--socket", str(path)) as (server, address):
        assert address == f"unix:{path}" and path.exists()
        server.send_signal(signal.SIGINT)
        _, said = server.communicate(timeout=PATIENCE)
        assert server.returncode == 130 and "nothing holds the robot any more" in said
        assert not path.exists()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("run", "ladder", "--plant", "banana"), "torques, volts"),
        (("run", "ladder", "--plant", "tcp://10.0.0.1:4000"), "their own machine only"),
        (("run", "ladder", "--plant", "tcp://127.0.0.1:1", "--set", "plant.backlash=1deg"), "server's to set"),
        (("plant", "serve", "nowhere"), "ladder"),
        (("plant", "serve", "patch-walk"), "climber"),
        (("plant", "serve", "ladder", "--set", "plant.encoder_counts=0"), "encoder_counts"),
        (("plant", "serve", "ladder", "--pace", "2"), "--real-time"),
        (("plant", "serve", "ladder", "--socket", "a", "--port", "4000"), "--port"),
        (("plant", "serve", "ladder", "--socket", "/nowhere/at/all"), "cannot listen there"),
        (("plant", "serve", "ladder", "--dac-bits", "99"), "24"),
        (("plant", "serve", "ladder", "--noise", "peg_error=3"), "unit"),
    ],
)
def test_bad_input_is_one_message(clamber: Any, words: tuple[str, ...], said: str) -> None:
    code, out, err = clamber(*words)
    assert (code, out) == (2, "")
    assert said in err and "Traceback" not in err


def test_a_plan_for_a_plant_that_nobody_serves_moves_nothing(clamber: Any, tmp_path: Path) -> None:
    code, out, err = clamber("run", plan_file(tmp_path, 300), "--plant", "tcp://127.0.0.1:1", "-q")
    assert (code, out) == (2, "")
    assert "nothing answers there" in err


def test_with_json_the_server_says_where_it_listens_in_one_value() -> None:
    words = [sys.executable, "-c", SERVE, "plant", "serve", "ladder", "--json", "-q"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as server:
        try:
            told = json.loads(said_until(server.stdout, "}\n"))
            Draft202012Validator(schema_of("plant serve")).validate(told)
            assert told["address"].startswith("tcp://127.0.0.1:") and told["robot"] == "libra"
            server.send_signal(signal.SIGTERM)
            assert server.wait(timeout=PATIENCE) == 143
        finally:
            server.kill()  # what fails above must not leave it waiting for ever
