"""Machine code on disk: what is damaged is compiled anew, what others could have written is never loaded, and both are told."""

import json
import os
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from clamber import kernel_cache
from clamber.cli import doctor_facts, main
from clamber.sealed import FOREIGN, SealError, access_problem, read_sealed, write_sealed

APART = ("CLAMBER_BOUNDSCHECK", kernel_cache.TOLD)
BY_HAND = Path(__file__).with_name("kernel_cache_by_hand.py")


def run(cache: Path, *words: str) -> tuple[str, str]:
    """What a process prints that uses a kernel, with its cache in a folder: answers, then hits; and what it complains of."""
    environment = {name: value for name, value in os.environ.items() if name not in APART}
    done = subprocess.run(
        [sys.executable, str(BY_HAND), *words], env=environment | {"CLAMBER_CACHE": str(cache)}, capture_output=True,
        text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout.strip(), done.stderr


def files(cache: Path, suffix: str, kernel: str = "doubled") -> list[Path]:
    return sorted(cache.glob(f"kernels-*/*.{kernel}-*.{suffix}"))


@pytest.mark.slow
@pytest.mark.parametrize("suffix", ["nbi", "nbc"])
def test_a_damaged_file_is_compiled_anew_and_replaced(tmp_path: Path, suffix: str) -> None:
    cache, answers = tmp_path / "cache", "8.0 3.0 2.0 1.0 0.0"
    assert run(cache, "more") == (f"{answers} 0 0 0 0 0", "")
    for damage in ("cut", "garbage", "empty", "flipped"):
        (file,) = files(cache, suffix, damage)
        raw = file.read_bytes()
        half = len(raw) // 2
        file.write_bytes({
            "cut": raw[:half], "garbage": b"\x80\x05garbage.", "empty": b"",
            "flipped": raw[:half] + bytes([raw[half] ^ 1]) + raw[half + 1 :],
        }[damage])  # fmt: skip
    assert run(cache, "more") == (f"{answers} 1 0 0 0 0", "")
    assert run(cache, "more") == (f"{answers} 1 1 1 1 1", "")


class Bomb:
    """A pickle of it writes a file where it is loaded."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def __reduce__(self) -> Any:
        return Path.touch, (self.path,)


@pytest.mark.slow
@pytest.mark.parametrize("suffix", ["nbi", "nbc"])
@pytest.mark.parametrize("sealed", [False, True])
def test_a_pickle_that_others_could_have_written_is_never_loaded(tmp_path: Path, suffix: str, sealed: bool) -> None:
    cache, gone_off = tmp_path / "cache", tmp_path / "gone off"
    run(cache)
    (file,) = files(cache, suffix)
    bomb = pickle.dumps(Bomb(gone_off))
    if sealed:  # as whoever can write there would do it
        write_sealed(file, bomb)
        file.chmod(0o666)
    else:
        file.write_bytes(bomb)
    assert run(cache) == ("8.0 0", "")
    assert not gone_off.exists()
    assert run(cache) == ("8.0 1", "")


def test_a_file_of_another_user_or_under_another_name_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "file"
    write_sealed(file, b"content")
    assert read_sealed(file) == b"content"
    file.rename(tmp_path / "other")
    with pytest.raises(SealError, match="damaged"):
        read_sealed(tmp_path / "other")
    theirs = Path("/")
    if os.geteuid() == 0:
        theirs = file
        write_sealed(file, b"content")
        os.chown(file, 12345, -1)
        with pytest.raises(SealError, match="another user") as refused:
            read_sealed(file)
        assert refused.value.state == FOREIGN
    assert "belongs to another user" in str(access_problem(theirs.stat()))


def test_links_and_pipes_are_refused(tmp_path: Path) -> None:
    write_sealed(tmp_path / "file", b"content")
    (tmp_path / "link").symlink_to(tmp_path / "file")
    with pytest.raises(OSError):
        read_sealed(tmp_path / "link")
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(SealError, match="no regular file"):
        read_sealed(tmp_path / "pipe")


@pytest.mark.slow
@pytest.mark.parametrize("which", ["root", "kernels"])
def test_a_folder_that_others_can_write_is_not_used_and_one_line_says_so(tmp_path: Path, which: str) -> None:
    cache = tmp_path / "cache"
    run(cache)
    (code,) = files(cache, "nbc")
    folder = cache if which == "root" else code.parent
    before = code.stat().st_mtime_ns
    folder.chmod(0o777)
    answer, said = run(cache)
    assert answer == "8.0 0" and code.stat().st_mtime_ns == before
    (line,) = said.splitlines()
    assert str(folder) in line and "can be written by others (mode 777)" in line and "compiled anew" in line
    assert "chmod go-w" in line and "CLAMBER_CACHE" in line


def test_a_folder_that_cannot_be_made_is_told_in_one_line(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.touch()
    answer, said = run(file / "cache")
    assert answer == "8.0 0"
    (line,) = said.splitlines()
    assert str(file / "cache") in line and "compiled anew" in line and "CLAMBER_CACHE" in line


@pytest.mark.slow
def test_the_cache_is_its_users_alone_whatever_the_umask(tmp_path: Path) -> None:
    cache = tmp_path / "below" / "cache"
    assert run(cache, "open") == ("8.0 0", "")
    assert run(cache, "open") == ("8.0 1", "")
    assert all(path.stat().st_mode & 0o022 == 0 for path in [cache, *cache.rglob("*.nb[ci]")])


@pytest.fixture
def doctor(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Any:
    """`clamber doctor --json` with its cache in the folder "cache" of a test."""
    monkeypatch.setattr(doctor_facts, "gl", lambda: None)  # opens a display, if there is one
    monkeypatch.setenv("CLAMBER_CACHE", str(tmp_path / "cache"))

    def call() -> Any:
        with pytest.raises(SystemExit) as left:
            main(["doctor", "--json"])
        found = json.loads(capsys.readouterr().out)
        assert left.value.code == (1 if found["problems"] else 0)
        return found

    return call


@pytest.mark.slow
def test_doctor_tells_each_state_of_the_cache(tmp_path: Path, doctor: Any) -> None:
    cache = tmp_path / "cache"
    run(cache)
    found = doctor()
    assert found["kernels"]["state"] == "fine" and found["problems"] == []
    (code,) = files(cache, "nbc")
    raw = code.read_bytes()

    code.write_bytes(raw[:-7])
    found = doctor()
    assert found["kernels"]["state"] == "damaged" and found["kernels"]["damaged"] == [code.name]
    assert any(str(code) in line and "damaged" in line and "anew" in line for line in found["problems"])

    code.write_bytes(raw)
    code.chmod(0o666)
    found = doctor()
    assert found["kernels"]["state"] == "foreign" and found["kernels"]["foreign"] == [code.name]
    assert any(str(code) in line and "by others" in line for line in found["problems"])

    code.chmod(0o644)
    cache.chmod(0o775)
    found = doctor()
    assert found["kernels"]["state"] == "foreign" and not found["kernels"]["compiled"]
    assert any(str(cache) in line and "chmod go-w" in line for line in found["problems"])

    cache.chmod(0o755)
    assert doctor()["kernels"]["state"] == "fine"


def test_doctor_tells_of_a_cache_that_cannot_be_written(
    tmp_path: Path, doctor: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setenv("CLAMBER_CACHE", str(tmp_path / "file" / "cache"))
    found = doctor()
    assert found["kernels"]["state"] == "unwritable"
    assert any("compiled anew by every command" in line and "CLAMBER_CACHE" in line for line in found["problems"])


OUTSIDE = """
import numpy as np
from clamber.compiled import kernel

@kernel
def at(values, i):
    return values[i]

try:
    print(at(np.arange(3.0), 3) < 1e300, "unchecked")
except IndexError:
    print("checked")
"""


@pytest.mark.slow
def test_a_debug_build_checks_every_index_and_keeps_its_code_apart(tmp_path: Path) -> None:
    script, said = tmp_path / "script.py", []
    script.write_text(OUTSIDE)
    for checked in ("1", "0", "1", "0"):
        environment = os.environ | {"CLAMBER_CACHE": str(tmp_path / "cache"), "CLAMBER_BOUNDSCHECK": checked}
        done = subprocess.run(
            [sys.executable, str(script)], env=environment, capture_output=True, text=True, check=True
        )
        said.append(done.stdout.split()[-1])
    assert said == ["checked", "unchecked", "checked", "unchecked"]
    assert len(list((tmp_path / "cache").glob("kernels-*"))) == 2


@pytest.mark.slow
def test_a_kernel_whose_source_is_no_file_is_compiled_and_never_taken_for_another(tmp_path: Path) -> None:
    """As in a notebook's cell: what a kernel of its name did in another process cannot be asked."""
    answers = []
    for number in (1, 2):
        cell = (
            f"from clamber.compiled import kernel\n@kernel\ndef more(x):\n    return x + {number}.0\nprint(more(4.0))"
        )
        words = [sys.executable, "-c", f"exec(compile({cell!r}, '<cell 1>', 'exec'))"]
        environment = os.environ | {"CLAMBER_CACHE": str(tmp_path / "cache")}
        answers.append(
            subprocess.run(words, env=environment, capture_output=True, text=True, check=True).stdout.strip()
        )
    assert answers == ["5.0", "6.0"]
