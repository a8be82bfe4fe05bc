"""Batches over a Ray cluster: two nodes on loopback with a token; the same numbers, lost nodes, errors before work starts."""

import importlib.util
import json
import os
import secrets
import signal
import socket
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from jobs_by_hand import batch, square
from test_jobs import ran, rows_of, start_batch

import clamber
from clamber.families.climber.execution.executable_plan import climbable
from clamber.families.climber.planning.plans import thesis_code
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.climber.trials.noise import Noise
from clamber.families.climber.trials.trial import TrialSetup
from clamber.jobs import ClusterError, LocalProcesses, Outcome, RayCluster, cluster, map_items
from clamber.planning.axes import range_axis
from clamber.planning.problem.plan import Plan
from clamber.planning.sweep import Sweep, run_sweep
from clamber.tasks import load_task
from clamber.trials.trial_runs import run_trials

needs_ray = pytest.mark.skipif(importlib.util.find_spec("ray") is None, reason="Ray is optional")
FOLDERS = os.pathsep.join((str(Path(clamber.__file__).parents[1]), str(Path(__file__).parent)))
LOOPBACK = {
    "RAY_ENABLE_WINDOWS_OR_OSX_CLUSTER": "0",  # the setting with which Ray keeps all of itself on loopback
    "RAY_AUTH_MODE": "token",
    "RAY_AUTH_TOKEN": secrets.token_hex(16),
    "RAY_USAGE_STATS_ENABLED": "0",
}


def numbers(sweep: Sweep) -> list[dict[str, Any]]:
    """All but the time that it took."""
    return [{key: value for key, value in point.items() if key != "seconds"} for point in sweep.to_json()["points"]]


@pytest.fixture
def nodes(monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[RayCluster, Callable[[], None]]]:
    """A cluster of two nodes, and what kills the second one."""
    for key, value in LOOPBACK.items():
        monkeypatch.setenv(key, value)
    command = [sys.executable, str(Path(__file__).parent / "ray_by_hand.py")]
    process = subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=os.environ | {"PYTHONPATH": FOLDERS}
    )
    assert process.stdin is not None and process.stdout is not None
    address = process.stdout.readline().strip()

    def kill() -> None:
        assert process.stdin is not None and process.stdout is not None
        print("kill", file=process.stdin, flush=True)
        assert process.stdout.readline().strip() == "killed"

    yield RayCluster(address), kill
    process.stdin.close()
    process.wait(60)


@needs_ray
@pytest.mark.long
def test_a_cluster_runs_batches_as_local_workers_do(
    nodes: tuple[RayCluster, Callable[[], None]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    there, kill = nodes
    items: list[dict[str, Any]] = [{"n": n, "log": str(tmp_path / "log")} for n in range(8)]
    items += [{"n": 8, "die_once": str(tmp_path / "died")}, {"n": 9, "die": True}, {"n": 10, "raise": True}]
    told = map_items(square, items, executor=there)
    assert [one.result for one in told[:9]] == [{"square": n**2, "blas": "1"} for n in range(9)]
    assert told[8].tries == 2 and ran(tmp_path / "log") == Counter(range(8))
    assert told[9].error == "its worker on the cluster died 3 times, WorkerCrashedError" and told[9].tries == 3
    assert told[10].error == "ValueError: thirteen is not liked"

    killed: list[int] = []

    def kill_early(ended: int, total: int, outcome: Outcome) -> None:
        if ended == 5:
            killed.append(ended)
            kill()

    store, log = tmp_path / "store.db", tmp_path / "second"
    slow = [{"n": n, "sleep": 0.1, "log": str(log)} for n in range(40)]
    told = map_items(square, slow, executor=there, store=store, progress=kill_early)
    assert killed and [one.result["square"] for one in told if one.result] == [n**2 for n in range(40)]
    again = sum(ran(log).values()) - 40
    assert 0 <= again <= 2 * 2, "only what was in flight on the lost node may run twice"
    assert all(one.stored for one in map_items(square, slow, executor=there, store=store, resume=True))

    for stop in (signal.SIGINT, signal.SIGKILL):
        folder = tmp_path / stop.name
        folder.mkdir()
        process = start_batch(folder, 24, 0.1, there.address)
        while process.poll() is None and sum(ran(folder / "log").values()) < 8:
            time.sleep(0.005)
        process.send_signal(stop)
        process.communicate(timeout=60)
        assert process.returncode != 0, "stopped in the middle"
        time.sleep(0.5)  # its workers leave with it
        kept, before = rows_of(folder / "store.db"), ran(folder / "log")
        assert 0 < len(kept) < 24
        told = map_items(square, batch(folder, 24, 0.1), executor=there, store=folder / "store.db", resume=True)
        assert [one.result["square"] for one in told if one.result] == [n**2 for n in range(24)]
        assert all(ran(folder / "log")[n] == before[n] for n in kept), "a finished item was run again"

    with monkeypatch.context() as changed:
        changed.setattr(cluster, "release", lambda: {"clamber": "0.0", "files": "none"})
        with pytest.raises(ClusterError, match=r"another release: clamber .*, not 0\.0, files .*, not none"):
            map_items(square, [{"n": 1}], executor=there)
    with monkeypatch.context() as changed:
        changed.setenv("RAY_AUTH_TOKEN", "0" * 32)
        with pytest.raises(ClusterError, match="its token is missing or wrong; set RAY_AUTH_MODE=token"):
            there.check()


@needs_ray
@pytest.mark.long
def test_a_thousand_points_are_the_same_on_one_two_and_four_workers_and_on_two_nodes_of_which_one_is_lost(
    nodes: tuple[RayCluster, Callable[[], None]], tmp_path: Path
) -> None:
    there, kill = nodes
    axes = [range_axis("motor.torque_limit=2Nm..9Nm:40"), range_axis("board.ladder.spacing=5in..7in:25")]
    settings: dict[str, Any] = {
        "overrides": ("rules.max_hangs=0", "goal.y_min=9in", "board.ladder.rungs=5"),
        "options": {"max_stances": 5_000},
    }
    tables = [numbers(run_sweep("ladder", axes, workers=workers, **settings)) for workers in (1, 2, 4)]
    assert tables[0] == tables[1] == tables[2] and len(tables[0]) == 1000
    assert {"optimal", "no start"} <= {point["status"] for point in tables[0]}

    def kill_in_the_middle(ended: int, total: int, outcome: Outcome) -> None:
        if ended == total // 2:
            kill()

    lost = run_sweep(
        "ladder", axes, executor=there, store=tmp_path / "store.db", progress=kill_in_the_middle, **settings
    )
    assert numbers(lost) == tables[0]


@needs_ray
@pytest.mark.long
def test_climbs_are_the_same_on_a_cluster(nodes: tuple[RayCluster, Callable[[], None]], tmp_path: Path) -> None:
    there, _ = nodes
    task = load_task("ladder")
    assert isinstance(task, LimbedTask)
    strict = climbable(task)
    plan = Plan.of_codes(strict, [thesis_code(strict, number) for number in (300, 3)])
    setup = TrialSetup(task=strict, plan=plan, noise=Noise.of("usual"))
    here = run_trials(setup, range(6), executor=LocalProcesses(2))
    told = run_trials(setup, range(6), executor=there, store=tmp_path / "store.db")
    assert len(told.ended) == 6
    assert told.ended == here.ended


@pytest.mark.parametrize(
    ("address", "message"),
    [
        ("ray://10.0.0.5:10001", "is no address of a Ray cluster; write the HOST:PORT"),
        ("auto", "is no address of a Ray cluster"),
        ("127.0.0.1:99999", "is no address of a Ray cluster"),
        ("127.0.0.1:1", "nothing answers there"),
        ("no-such-host.invalid:6379", "nothing answers there"),
    ],
)
@needs_ray
def test_a_wrong_address_is_told_at_once(address: str, message: str) -> None:
    started = time.monotonic()
    with pytest.raises(ClusterError, match=message) as caught:
        map_items(square, [{"n": 1}], executor=RayCluster(address))
    assert str(caught.value).startswith(f"--ray {address}: ") and time.monotonic() - started < 30.0


def test_ray_that_is_not_installed_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "ray", None)
    told = r'Ray is not installed here; install it with: pip install "\.\[ray\]" in a clone of Clamber'
    with pytest.raises(ClusterError, match=told):
        map_items(square, [{"n": 1}], executor=RayCluster("127.0.0.1:6379"))


@pytest.mark.slow
@needs_ray
@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("raise RuntimeError('Version mismatch: the cluster was\\nstarted with Ray: 2.1')", "Version mismatch: the cluster was start"),
        ("import time; time.sleep(60)", "no Ray cluster answered within 1 s"),
        ("import os; os.abort()", "no Ray cluster answered"),
        ("import sys; print('InvalidAuthToken', file=sys.stderr, flush=True); os.abort()", "its token is missing or wrong"),
        ("pass", "the cluster has no cores"),
    ],
)  # fmt: skip
def test_what_goes_wrong_behind_an_open_port_is_told(
    body: str, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A stand-in for Ray does in the probe's process what the real one does to it."""
    (tmp_path / "ray.py").write_text(
        f"import os\ndef init(**_):\n    {body}\ndef cluster_resources():\n    return {{}}\ndef shutdown():\n    pass\n"
    )
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join((str(tmp_path), FOLDERS)))
    monkeypatch.setattr(cluster, "ANSWER", 1.0 if "sleep" in body else 20.0)
    with socket.create_server(("127.0.0.1", 0)) as listener, pytest.raises(ClusterError, match=message) as caught:
        RayCluster(f"127.0.0.1:{listener.getsockname()[1]}").check()
    assert "\n" not in str(caught.value)


def test_a_worker_of_another_release_runs_nothing(tmp_path: Path) -> None:
    item = json.dumps({"n": 1, "log": str(tmp_path / "log")})
    told = json.loads(cluster.run_there("jobs_by_hand:square", item, json.dumps({"clamber": "0.0", "files": "none"})))
    assert set(told) == {"release", "host"} and not (tmp_path / "log").exists()
