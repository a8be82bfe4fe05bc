"""`clamber trials`: what it prints, writes and refuses."""

import json
import math
import sqlite3
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from clamber.execution.log_files import read_log
from clamber.families.climber.execution.climb_trace import ClimbTrace
from clamber.families.climber.execution.executable_plan import climbable
from clamber.families.climber.planning.plans import thesis_code
from clamber.families.climber.planning.task import LimbedTask
from clamber.planning.problem.plan import Plan
from clamber.tasks import load_task
from clamber.trials.trial_runs import PairingError, Trials


def plan_file(folder: Path, *numbers: int) -> str:
    task = load_task("ladder")
    assert isinstance(task, LimbedTask)
    strict = climbable(task)
    Plan.of_codes(strict, [thesis_code(strict, number) for number in numbers]).save(folder / "plan.json")
    return str(folder / "plan.json")


@pytest.mark.slow
def test_trials_are_counted_stored_drawn_and_any_of_them_climbed_again(clamber: Any, tmp_path: Path) -> None:
    plan, store = plan_file(tmp_path, 300, 3), str(tmp_path / "trials.db")
    words = ("trials", plan, "-n", "3", "--seed", "5", "--workers", "1", "--store", store)
    code, out, err = clamber(*words, "-o", str(tmp_path / "trials.png"))
    assert code == 0, out
    assert "3 of 3 climbs of 'ladder' succeeded: 100.0 % (43.9 to 100.0 %, 95 %)" in out
    assert "too few failures to tell" in out
    assert "1 of 3: 1 climbed" in err
    assert max(len(line) for line in out.splitlines() if not line.startswith("written")) <= 80
    assert (tmp_path / "trials.png").read_bytes().startswith(b"\x89PNG")
    _, out, _ = clamber(*words, "--resume", "--json", "-q")
    stored = {trial["seed"]: trial for trial in json.loads(out)["trials"]}
    assert sorted(stored) == [5, 6, 7]
    log = tmp_path / "climb.mcap"
    code, out, err = clamber("trials", plan, "--replay", "6", "--store", store, "-o", str(log), "--json", "-q")
    assert (code, err) == (0, "")
    assert json.loads(out)["trial"] == stored[6]
    with sqlite3.connect(store) as file:
        file.execute("UPDATE items SET result = json_set(result, '$.seconds', 1.0)")
    _, _, err = clamber("trials", plan, "--replay", "6", "--store", store, "-q")
    assert "the store's trial 6 went otherwise" in err
    trace = ClimbTrace.from_log(read_log(log))
    assert trace.time[-1] == pytest.approx(stored[6]["seconds"])
    assert trace.notes is not None and trace.notes["seed"] == 6


def test_a_run_with_the_noise_and_seed_of_a_trial_is_that_trial(clamber: Any, tmp_path: Path) -> None:
    plan = plan_file(tmp_path, 300, 3)
    _, trial, _ = clamber("trials", plan, "--replay", "9", "--json", "-q")
    _, run, _ = clamber("run", plan, "--noise", "usual", "--seed", "9", "--json", "-q")
    told, same = json.loads(trial), json.loads(run)
    assert told["true_pose"] == same["true_pose"]
    assert told["actions"] == same["actions"]
    _, other, _ = clamber("run", plan, "--noise", "usual", "--seed", "10", "--json", "-q")
    assert json.loads(other)["true_pose"] != same["true_pose"]


@pytest.mark.usefixtures("in_this_process")
def test_failed_climbs_are_told_with_their_cause_and_leave_with_1(clamber: Any, tmp_path: Path) -> None:
    plan = plan_file(tmp_path, 300, *([4] * 8))
    words = ("trials", plan, "-n", "1", "--workers", "1", "-q")
    code, out, err = clamber(*words)
    assert (code, out) == (2, "")
    assert "step" in err and "--force" in err
    code, out, _ = clamber(*words, "--force")
    assert code == 1
    assert "forced in spite of step" in out
    assert "0 of 1 climbs" in out and "fell: move" in out and "seed 0: fell: " in out
    assert max(map(len, out.splitlines())) <= 80


@pytest.mark.usefixtures("in_this_process")
def test_a_success_that_is_asked_for_decides_how_it_leaves(clamber: Any, tmp_path: Path) -> None:
    words = ("trials", plan_file(tmp_path, 300), "-n", "2", "--workers", "1", "-q", "--json")
    assert clamber(*words, "--at-least", "34%")[0] == 0  # Wilson's bound of 2 in 2 is 34.2 %
    assert clamber(*words, "--at-least", "35%")[0] == 1


@pytest.mark.slow
@pytest.mark.usefixtures("in_this_process")
def test_two_plans_are_compared_with_the_same_seeds(clamber: Any, tmp_path: Path) -> None:
    good, fallen, store = plan_file(tmp_path, 300), tmp_path / "falls", tmp_path / "trials.db"
    fallen.mkdir()
    falls = plan_file(fallen, 300, *([4] * 8))
    words = ("trials", good, "--against", falls, "-n", "2", "--force", "--workers", "1", "-q", "--store", str(store))
    code, out, _ = clamber(*words)
    assert code == 0
    assert "2 of 2 climbs" in out and "0 of 2 climbs" in out
    assert " ".join(out.split()).endswith(
        "both done 0, only the first 2, only the second 0, neither 0; p = 0.5 (sign test, two-sided)"
    )
    assert (tmp_path / "trials-against.db").exists()
    code, out, _ = clamber(*words, "--resume", "--json", "--at-least", "99%")
    told = json.loads(out)
    assert code == 1 and told["paired"] == {"both": 0, "first": [0, 1], "second": [], "neither": 0, "p": 0.5}
    assert (told["first"]["done"], told["second"]["done"]) == (2, 0)


@dataclass(frozen=True)
class Done:
    seed: int
    done: bool


@given(
    st.dictionaries(st.integers(0, 40), st.booleans(), min_size=1),
    st.dictionaries(st.integers(0, 40), st.booleans(), min_size=1),
)
def test_a_comparison_is_over_shared_seeds_and_the_same_from_either_side(
    one: dict[int, bool], other: dict[int, bool]
) -> None:
    setup: Any = None
    mine, theirs = (Trials(setup, len(each), [Done(*pair) for pair in each.items()]) for each in (one, other))
    if not one.keys() & other.keys():
        with pytest.raises(PairingError, match="no seed in common"):
            mine.against(theirs)
        return
    paired, back = mine.against(theirs), theirs.against(mine)
    assert (paired.first, paired.second, paired.both, paired.p) == (back.second, back.first, back.both, back.p)
    n, fewer = len(paired.first) + len(paired.second), min(len(paired.first), len(paired.second))
    assert paired.both + paired.neither + n == len(one.keys() & other.keys())
    tail = sum(math.comb(n, k) for k in range(fewer + 1)) / 2**n
    assert paired.p == pytest.approx(min(1.0, 2.0 * tail))


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("ladder", "--against", "missing.json"), "missing.json"),
        (("ladder", "--against", "h", "--replay", "3"), "--against"),
        (("ladder", "--noise", "frction=30%"), "friction"),
        (("ladder", "--noise", "friction=30mm"), "ratio"),
        (("ladder-hand", "--noise", "hook_play=2mm"), "all that there is"),
        (("ladder", "--planner", "magic"), "genetic"),
        (("ladder", "-o", "trials.gif"), ".png"),
        (("ladder", "--replay", "3", "-o", "trials.txt"), ".mcap"),
        (("ladder", "--resume"), "--store"),
        (("ladder", "--at-least", "3"), "100 %"),
        (("ladder", "--task", "h"), "--task"),
        (("ladder", "--set", "plant.backlsh=1deg"), "backlash"),
        (("missing.json",), "missing.json"),
        (("ladder-hand", "--ray", "nowhere"), "--ray"),
    ],
)
def test_bad_input_is_one_message(clamber: Any, words: tuple[str, ...], said: str) -> None:
    code, out, err = clamber("trials", *words, "-q")
    assert (code, out) == (2, "")
    assert said in err and "Traceback" not in err


@pytest.mark.usefixtures("in_this_process")
def test_a_store_of_other_trials_is_refused(clamber: Any, tmp_path: Path) -> None:
    plan, store = plan_file(tmp_path, 300), str(tmp_path / "trials.db")
    words = ("trials", plan, "-n", "1", "--workers", "1", "--store", store, "-q")
    assert clamber(*words)[0] == 0
    code, _, err = clamber(*words, "--resume", "--noise", "friction=10%")
    assert code == 2
    assert "holds the results of trials of 'ladder' with noise" in err
    code, _, err = clamber(*words)
    assert code == 2
    assert "resume" in err
