"""`clamber body`: what it prints, writes and refuses."""

import json
from functools import partial
from pathlib import Path
from typing import Any

import pytest


@pytest.fixture
def run(clamber: Any, monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.setenv("COLUMNS", "120")
    return partial(clamber, "body")


def test_a_circle_is_compared_and_drawn(run: Any, tmp_path: Path) -> None:
    picture = tmp_path / "circle.png"
    code, out, _ = run("circle", "--lap", "3", "--laps", "1", "--flaws", "ideal", "-o", str(picture))
    assert code == 0
    assert "scct" in out and "jacobian-transpose" in out and "radial rms" in out
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_json_says_when_a_hook_came_off_and_so_does_the_exit_code(run: Any) -> None:
    code, out, _ = run("push", "--force", "400N,0N", "-c", "scct", "--json")
    (told,) = json.loads(out)["controls"]
    assert code == 1
    assert told["unhooked_at"] > 0.0
    assert told["kp"] == [100.0, 50.0, 10.0] and told["kd"] == [10.0, 5.0, 1.0]


@pytest.mark.parametrize(
    ("words", "limit", "alpha"),
    [((), "thesis", 0.0), (("--alpha", "0.3"), "thesis", 0.3), (("--limit", "counted"), "counted", 0.3)],
)
def test_alpha_of_the_hook_limit_is_the_printed_one_unless_given(
    run: Any, words: tuple[str, ...], limit: str, alpha: float
) -> None:
    _, out, _ = run("push", "-c", "scct", "--json", *words)
    (told,) = json.loads(out)["controls"]
    assert (told["limit"], told["alpha"]) == (limit, alpha)


def test_trials_push_from_either_side(run: Any) -> None:
    code, out, err = run("push", "--trials", "2", "--limit", "thesis", "-c", "scct", "--json")
    trials = json.loads(out)["scct"]
    assert code == 0
    assert [trial["side"] for trial in trials] == [1, -1]
    assert "2 of 2 pushes" in err


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("circle", "-c", "sct"), "sct"),
        (("push-up", "--alpha", "-0.1"), "--alpha"),
        (("push-up", "--kp", "1,2"), "must be three numbers"),
        (("circle", "--limit", "thesi"), "thesis"),
        (("push", "--set", "backlsh=1deg"), "backlash"),
        (("circle", "-o", "x.doc"), ".doc"),
        (("push-up", "--height", "5 kg"), "5 kg"),
    ],
)
def test_mistakes_are_told_in_one_message(run: Any, words: tuple[str, ...], said: str) -> None:
    code, _, err = run(*words)
    assert code == 2
    assert said in err and "Traceback" not in err
