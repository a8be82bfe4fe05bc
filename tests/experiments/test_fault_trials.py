"""Trials with a fault each: every one has a report, and the table by kind adds up."""

import json
from dataclasses import dataclass, replace
from typing import Any

import pytest

from clamber.benchmarks.climb_speed import two_rungs
from clamber.families.climber.trials.noise import Noise
from clamber.families.climber.trials.trial import TrialSetup, error_trial, run_trial, trial_of
from clamber.trials.fault_trials import ENDINGS, fault_rows
from clamber.types import Json


def setup() -> TrialSetup:
    task, plan = two_rungs()
    return TrialSetup(task=task, noise=Noise.of("usual"), plan=plan, replan=False)


def test_a_trial_with_a_fault_tells_which_when_and_how_it_ended() -> None:
    told = run_trial(replace(setup(), faults=("dead",)).item(4))
    fault = told["fault"]
    assert (fault["kind"], fault["where"].split()[1]) == ("dead", fault["where"].split()[1])
    assert fault["ending"] in ENDINGS
    assert fault["noticed"] is None or fault["noticed"] >= fault["start"]
    assert fault["early"] == []
    assert trial_of(told).fault == fault
    assert json.loads(json.dumps(told))["fault"] == fault
    assert told == run_trial(replace(setup(), faults=("dead",)).item(4))


@dataclass
class Tried:
    fault: Json | None


def tried(kind: str, ending: str, noticed: float | None = None, at: str = "") -> Tried:
    return Tried(
        {"kind": kind, "start": 2.0, "where": "a", "noticed": noticed, "at": at, "early": [], "ending": ending}
    )


def test_rows_by_kind_add_up_and_one_for_all() -> None:
    trials = [
        tried("stuck", "held", 2.5, "a"), tried("stuck", "fell", 4.5, "b"), tried("nan", "recovered", 2.01, "a"),
        tried("nan", "stopped safely"), Tried(error_trial(1, "x").fault),
    ]  # fmt: skip
    rows = {row.kind: row for row in fault_rows(trials)}
    assert list(rows) == ["error", "nan", "stuck", "all"]
    assert (rows["stuck"].n, rows["stuck"].noticed, rows["stuck"].located, rows["stuck"].delay) == (2, 2, 1, 1.5)
    assert rows["nan"].delay == pytest.approx(0.01)
    assert rows["all"].n == 5
    assert sum(rows["all"].endings.values()) == 5
    assert rows["all"].endings["error"] == 1
    assert rows["all"].to_json()["intervals"]["held"][0] > 0.0
    assert fault_rows([]) == ()


def test_a_fault_that_there_is_none_of_is_one_message(clamber: Any) -> None:
    code, out, err = clamber("trials", "ladder-hand", "--fault", "stuk", "-q")
    assert (code, out) == (2, "")
    assert "stuck" in err and "Traceback" not in err
    code, _, err = clamber("trials", "level-walk", "--fault", "hold", "-q")
    assert code == 2
    assert "hold" in err and "Traceback" not in err
