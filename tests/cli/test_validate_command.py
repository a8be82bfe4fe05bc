"""`clamber validate`: what it prints, writes and refuses."""

import json
from pathlib import Path
from typing import Any

import pytest

from clamber.planning.problem.plan import load_plan


@pytest.mark.slow
def test_a_plan_that_never_fails_comes_out_as_it_went_in(clamber: Any, example_folder: Path, tmp_path: Path) -> None:
    plan, out_file = example_folder / "two.json", tmp_path / "surer.json"
    code, out, err = clamber("validate", str(plan), "-n", "2", "--workers", "1", "--noise", "none", "-o", str(out_file))
    assert code == 0, err
    assert "2 of 2 climbs before, 2 after; 2 actions, now 2" in out
    assert "still fails" not in out
    assert load_plan(out_file).actions == load_plan(plan).actions


@pytest.mark.slow
def test_where_it_still_fails_is_told(clamber: Any) -> None:
    words = ("validate", "ladder-hand", "-n", "2", "--workers", "1", "--lessons", "0", "--seed", "3")
    code, out, _ = clamber(*words, "--noise", "none", "--noise", "peg_error=30mm", "--json", "-q")
    told = json.loads(out)
    assert code == 0
    assert told["climbs"] == 2 and told["climbed"] == told["climbed_before"] < 2 and told["lessons"] == []
    assert sum(len(fault["seeds"]) for fault in told["faults"]) == 2 - told["climbed"]
    assert {seed for fault in told["faults"] for seed in fault["seeds"]} <= {3, 4}


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("ladder",), "is a task"),
        (("no-such.json",), "does not exist"),
        (("ladder-hand", "--noise", "fog=3mm"), "fog"),
        (("h-hand", "--lessons", "0"), "step 19"),
        (("ladder-hand", "-n", "0"), "-n"),
    ],
)
def test_what_cannot_be_rehearsed_is_refused(clamber: Any, words: tuple[str, ...], says: str) -> None:
    code, out, err = clamber("validate", *words)
    assert code == 2 and out == ""
    assert says in err and "Traceback" not in err
