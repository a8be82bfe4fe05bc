"""The first start compiles and says so, with progress; the second compiles nothing. Told by the cache, not by a clock."""

import json
import os
import subprocess
import sys
from pathlib import Path
from threading import Event

import pytest

import clamber
from clamber.cli import main
from clamber.terminal import output


def run(cache: Path, *words: str) -> subprocess.CompletedProcess[str]:
    environment = os.environ | {
        "PYTHONPATH": str(Path(clamber.__file__).parents[1]), "CLAMBER_CACHE": str(cache), "COLUMNS": "80"
    }  # fmt: skip
    command = [sys.executable, "-c", "from clamber.cli import main; main()", *words, "--json"]
    return subprocess.run(command, capture_output=True, text=True, env=environment, timeout=900, check=True)


@pytest.mark.long
def test_the_second_start_compiles_nothing(tmp_path: Path) -> None:
    first = run(tmp_path, "check", "ladder-hand")
    files = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*.nbc")}
    assert files and "compiling the kernels" in first.stderr
    second = run(tmp_path, "check", "ladder-hand")
    assert {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*.nbc")} == files
    assert second.stderr == "" and second.stdout == first.stdout


@pytest.mark.long
def test_a_first_run_that_compiles_in_two_processes_does_the_same_as_the_second(
    tmp_path: Path, example_folder: Path
) -> None:
    first, second = (run(tmp_path / "cache", "run", str(example_folder / "two.json")) for _ in range(2))
    lines, warm = (
        [line for line in done.stderr.splitlines() if not line.startswith("preparing the climb")]
        for done in (first, second)
    )  # that is said once two seconds have gone, and in the end how long it took
    assert lines[0].startswith("compiling the kernels") and lines[-1].startswith("action 1 of 2")
    assert not [line for line in lines[1:-1] if "kernels compiled after" not in line] and max(map(len, lines)) <= 80
    assert len(warm) == 1 and lines[-1].startswith(warm[0])
    assert _without_wall_seconds(second.stdout) == _without_wall_seconds(first.stdout)


@pytest.mark.slow
def test_a_task_is_the_first_thing_that_is_ever_asked_for(tmp_path: Path) -> None:
    run(tmp_path / "cache", "new", "task", "--robot", "libra", "--board", "ladder", "-o", str(tmp_path / "mine.toml"))
    assert (tmp_path / "mine.toml").exists()


def _without_wall_seconds(told: str) -> dict[str, object]:
    return {name: value for name, value in json.loads(told).items() if name != "wall_seconds"}


class Compiling(Event):
    """An end that comes after some looks into the folder; before each look, kernels come into it."""

    def __init__(self, folder: Path, arrivals: list[int]) -> None:
        super().__init__()
        self.folder, self.arrivals = folder, arrivals

    def wait(self, timeout: float | None = None) -> bool:
        if not self.arrivals:
            return True
        there = len(list(self.folder.iterdir()))
        for k in range(self.arrivals.pop(0)):
            (self.folder / f"module.kernel{there + k}-1.py311.1.nbc").write_bytes(b"")
        return False


def test_compilation_is_told_of_while_kernels_come_and_not_longer(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output._tell_compilation(tmp_path, every=0.0, ended=Compiling(tmp_path, [0, 2, 3, 1, 0, 0]))
    lines = capsys.readouterr().err.splitlines()
    assert [line.split()[0] for line in lines] == ["compiling", "5", "6"]


@pytest.mark.slow
def test_a_plan_that_is_opened_for_a_run_does_not_compile_in_silence(tmp_path: Path) -> None:
    command = [sys.executable, "-c", "from clamber.cli import main; main()", "run", "ladder-hand"]
    environment = os.environ | {"CLAMBER_CACHE": str(tmp_path / "cache"), "COLUMNS": "200"}
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env=environment) as process:
        assert process.stderr is not None
        first = process.stderr.readline()
        process.kill()
    assert first.startswith("compiling the kernels")


def test_nothing_is_told_where_nothing_compiles(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "module.replay-1.py311.1.nbc").write_bytes(b"")
    output._tell_compilation(tmp_path, every=0.0, ended=Compiling(tmp_path, [0, 0, 0]))
    assert capsys.readouterr().err == ""


def test_what_is_told_ends_with_its_command() -> None:
    with pytest.raises(SystemExit):
        main(["check", "no-such-thing"])
    assert output._command_ended.is_set()
