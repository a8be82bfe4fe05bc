"""`clamber doctor`: what it finds, and what it calls wrong."""

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import clamber
from clamber import kernel_cache
from clamber.cli import doctor_facts, main


def told(capsys: pytest.CaptureFixture[str]) -> Any:
    with pytest.raises(SystemExit) as left:
        main(["doctor", "--json"])
    found = json.loads(capsys.readouterr().out)
    assert left.value.code == (1 if found["problems"] else 0)
    return found


@pytest.fixture(autouse=True)
def no_gl(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(doctor_facts, "gl", lambda: None)  # opens a display, if there is one


def test_it_tells_this_version_and_this_python(capsys: pytest.CaptureFixture[str]) -> None:
    found = told(capsys)
    assert found["clamber"]["version"] == clamber.__version__
    assert found["python"]["executable"] == sys.executable
    assert found["machine"]["cores"] >= 1
    assert found["kernels"]["folder"] == str(kernel_cache.cache_folder())


def test_an_empty_cache_is_told_as_not_compiled(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CLAMBER_CACHE", str(tmp_path))
    old = tmp_path / "kernels-0123"
    old.mkdir()
    (old / "a.replay-1.nbc").write_bytes(b"0" * 100)
    kernels = told(capsys)["kernels"]
    assert not kernels["compiled"] and kernels["functions"] == 0
    assert (kernels["older_folders"], kernels["older_bytes"]) == (1, 100)
    kernel_cache.cache_folder().mkdir(exist_ok=True)
    (kernel_cache.cache_folder() / "a.replay-1.py311.1.nbc").write_bytes(b"0" * 7)
    kernels = told(capsys)["kernels"]
    assert kernels["compiled"] and kernels["bytes"] == 7


def test_a_cache_that_is_no_folder_is_wrong(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "file"
    file.write_text("")
    monkeypatch.setenv("CLAMBER_CACHE", str(file))
    assert any("CLAMBER_CACHE" in line for line in told(capsys)["problems"])


def test_a_cache_that_cannot_be_made_is_wrong(
    clamber: Callable[..., tuple[int, str, str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CLAMBER_CACHE", "/proc/nowhere")
    _, out, _ = clamber("doctor")
    assert "nothing is wrong" not in out
    assert "cannot be made" in out and "compiled anew by every command" in " ".join(out.split())


def test_a_missing_package_is_wrong_and_a_missing_extra_is_not(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    lines = ["numpy>=2.4", "no-such-need>=1", 'no-such-extra>=2; extra == "view"']
    monkeypatch.setattr("importlib.metadata.requires", lambda name: lines)
    found = told(capsys)
    assert found["required"]["no-such-need"] is None and found["required"]["numpy"] is not None
    assert found["optional"] == {"view": {"no-such-extra": None}}
    assert found["problems"] == ["no-such-need is not installed: pip install no-such-need"]


def test_a_driver_that_hangs_counts_as_none() -> None:
    def hang(*words: Any, **options: Any) -> Any:
        raise subprocess.TimeoutExpired("python", options["timeout"])

    assert GL(hang) is None


def test_the_first_way_that_opens_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("MUJOCO_GL", raising=False)

    def only_osmesa(words: Any, *, env: dict[str, str], **options: Any) -> Any:
        return subprocess.CompletedProcess(words, 0 if env["MUJOCO_GL"] == "osmesa" else 1)

    assert GL(only_osmesa) == "osmesa"


GL = doctor_facts.gl
"""As it is before the tests replace it."""


def test_it_fits_into_eighty_columns(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    with pytest.raises(SystemExit):
        main(["doctor"])
    out = capsys.readouterr().out
    assert "nothing is wrong" in out
    assert max(map(len, out.splitlines())) <= 80
