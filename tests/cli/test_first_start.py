"""The first start compiles and says so, with progress; the second compiles nothing. Told by the cache, not by a clock."""

import os
import subprocess
import sys
from pathlib import Path
from threading import Event

import pytest

import clamber
from clamber.cli import main, output


def run(cache: Path) -> subprocess.CompletedProcess[str]:
    environment = os.environ | {
        "PYTHONPATH": str(Path(clamber.__file__).parents[1]), "CLAMBER_CACHE": str(cache), "COLUMNS": "80"
    }  # fmt: skip
    words = [sys.executable, "-c", "from clamber.cli import main; main()", "check", "ladder-hand", "--json"]
    return subprocess.run(words, capture_output=True, text=True, env=environment, timeout=900, check=True)


@pytest.mark.slow
def test_the_second_start_compiles_nothing(tmp_path: Path) -> None:
    first = run(tmp_path)
    files = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*.nbc")}
    assert files and "compiling the kernels" in first.stderr
    second = run(tmp_path)
    assert {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*.nbc")} == files
    assert second.stderr == "" and second.stdout == first.stdout


def test_progress_counts_what_is_there_until_the_kernel_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("CLAMBER_CACHE", str(tmp_path))
    from clamber import compiled

    folder = compiled.cache_folder()
    folder.mkdir()
    naps: list[float | None] = []

    class Compiling(Event):
        def wait(self, timeout: float | None = None) -> bool:
            naps.append(timeout)
            name = "replay" if len(naps) == 3 else f"kernel{len(naps)}"
            (folder / f"module.{name}-1.py311.1.nbc").write_bytes(b"")
            return False

    output._tell_compilation("replay", output.stderr(), every=0.0, ended=Compiling())
    lines = capsys.readouterr().err.splitlines()
    assert [line.split()[0] for line in lines] == ["1", "2", "3", "compiled"]
    assert len(naps) == 3


def test_progress_falls_silent_with_its_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("CLAMBER_CACHE", str(tmp_path))
    ended = Event()
    ended.set()
    output._tell_compilation("replay", output.stderr(), every=0.0, ended=ended)
    assert capsys.readouterr().err == ""
    with pytest.raises(SystemExit):
        main(["check", "no-such-thing"])
    assert output._command_ended.is_set()


def test_nothing_is_told_where_nothing_compiles(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("CLAMBER_CACHE", str(tmp_path))
    from clamber import compiled

    compiled.cache_folder().mkdir()
    (compiled.cache_folder() / "module.replay-1.py311.1.nbc").write_bytes(b"")
    output.announce_compilation("replay")
    output.announce_compilation("replay", quiet=True)
    assert capsys.readouterr().err == ""
