"""Work begun ahead: what it compiles is found, what goes wrong in it is neither seen nor heard, and it never outlives who began it."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import clamber
from clamber.jobs import ahead as beginning
from clamber.jobs.ahead import ahead

HERE = Path(__file__).parent


@pytest.fixture(autouse=True)
def many_cores(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(beginning, "usable_cores", lambda: 8)
    monkeypatch.setenv("AHEAD_BY_HAND", str(tmp_path))
    monkeypatch.syspath_prepend(HERE)


def wait_for(file: Path) -> None:
    until = time.monotonic() + 60.0
    while not file.exists():
        assert time.monotonic() < until, f"no {file.name}"
        time.sleep(0.01)


def is_alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return Path(f"/proc/{process}/stat").read_text().split()[2] != "Z"


def start(folder: Path, *names: str) -> "subprocess.Popen[str]":
    """A process that begins functions ahead."""
    places = os.pathsep.join((str(Path(clamber.__file__).parents[1]), str(HERE)))
    environment = os.environ | {
        "PYTHONPATH": places,
        "CLAMBER_CACHE": str(folder / "cache"),
        "AHEAD_BY_HAND": str(folder),
    }
    words = [sys.executable, str(HERE / "ahead_by_hand.py"), *names]
    return subprocess.Popen(words, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


@pytest.mark.slow
@pytest.mark.skipif(beginning.usable_cores() < 2, reason="on one core nothing is begun")
def test_what_was_compiled_ahead_is_found(tmp_path: Path) -> None:
    assert start(tmp_path, "ahead_by_hand:compile_one").communicate(timeout=120) == ("2.0 0\n", "")


def test_what_raises_or_dies_is_neither_seen_nor_heard(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    with ahead(["ahead_by_hand:raise_aloud", "ahead_by_hand:die", "no_such_module:function"]):
        wait_for(tmp_path / "raised")
        wait_for(tmp_path / "died")
    assert capfd.readouterr() == ("", "")


def test_what_is_not_done_when_the_block_ends_is_given_up(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt), ahead(["ahead_by_hand:linger"]):
        wait_for(tmp_path / "lingers")
        raise KeyboardInterrupt
    assert not is_alive(int((tmp_path / "lingers").read_text()))


@pytest.mark.slow
@pytest.mark.skipif(beginning.usable_cores() < 2, reason="on one core nothing is begun")
def test_no_work_outlives_a_process_that_is_killed(tmp_path: Path) -> None:
    process = start(tmp_path, "ahead_by_hand:linger")
    assert process.stdout is not None and process.stdout.readline() == "lingers\n"
    worker = int((tmp_path / "lingers").read_text())
    assert is_alive(worker)
    process.send_signal(signal.SIGKILL)
    process.communicate()
    until = time.monotonic() + 30.0
    while is_alive(worker):
        assert time.monotonic() < until, "it lives on"
        time.sleep(0.01)


def test_one_core_is_left_to_the_block(monkeypatch: pytest.MonkeyPatch) -> None:
    begun: list[str] = []

    def begin(name: str) -> "subprocess.Popen[bytes]":
        begun.append(name)
        return subprocess.Popen([sys.executable, "-c", ""], stdin=subprocess.PIPE)

    monkeypatch.setattr(beginning, "_begin", begin)
    for cores in (1, 2, 3, 4):
        begun.clear()
        monkeypatch.setattr(beginning, "usable_cores", lambda cores=cores: cores)
        with ahead(["first", "second"]):
            assert begun == ["first", "second"][: cores - 1]


def test_without_room_for_another_process_the_block_runs_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    def begin(name: str) -> None:
        raise BlockingIOError("no more processes")

    monkeypatch.setattr(beginning, "_begin", begin)
    with ahead(["first"]) as nothing:
        assert nothing is None
