"""`clamber limb open-loop`: table, JSON, picture, exit codes, and mistakes in one line."""

import json
import math
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from clamber.limb_bench.open_loop import TRANSFORMS


@pytest.fixture
def run(clamber: Any) -> Any:
    return partial(clamber, "limb", "open-loop", "-q")


def test_every_transform_is_told_within_80_columns(run: Any) -> None:
    code, out, _ = run("--set", "backlash=2deg", "--set", "friction=0.5")
    assert code == 0
    assert max(map(len, out.splitlines())) <= 80
    assert all(name in out for name in TRANSFORMS)
    assert "backlash 2 deg" in out and "friction x 0.5" in out


def test_json_tells_the_first_motion_in_radians(run: Any) -> None:
    code, out, _ = run("--json", "-c", "jacobian-transpose", "-c", "scct")
    told = json.loads(out)
    assert code == 0
    assert set(told) == {"schema", "limb", "plant", "force", "direction", "renewed", "first", "transforms"}
    bent, straight = told["transforms"]
    assert abs(straight["turned"]) < math.radians(0.5)
    assert math.radians(6.0) < bent["turned"] < math.radians(9.0)


@pytest.mark.parametrize("suffix", ["png", "json"])
def test_files_are_written_as_their_suffix_says(run: Any, tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"open.{suffix}"
    code, out, _ = run("-o", str(path), "--seconds", "0.2")
    assert code == 0
    assert f"written to {path}" in out
    content = path.read_bytes()
    assert content.startswith(b"\x89PNG") if suffix == "png" else json.loads(content)["schema"] == "clamber-open-loop-1"


def test_a_limb_that_friction_holds_is_no_answer(run: Any) -> None:
    code, out, _ = run("--force", "1N", "-c", "scct", "--seconds", "0.2")
    assert code == 1
    assert "friction holds it" in out


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--force", "0"), "open-loop: force = 0.0: must be more than 0 N"),
        (("--direction", "down"), "direction = down"),
        (("-c", "joint-pd"), "no transform is called 'joint-pd'"),
        (("--plant", "ode", "--set", "backlash=2deg"), "backlash"),
        (("-o", "open.txt"), "open.txt"),
        (("--start", "1,0"), "out of reach"),
    ],
)
def test_a_mistake_is_one_line_and_leaves_no_file(
    run: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, words: tuple[str, ...], told: str
) -> None:
    monkeypatch.chdir(tmp_path)
    code, out, err = run(*words)
    assert (code, out) == (2, "")
    assert told in err and len(err.strip().splitlines()) == 1
    assert not list(tmp_path.iterdir())
