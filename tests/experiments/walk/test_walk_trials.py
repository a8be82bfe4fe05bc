"""Many walks: each by its seed alone, kept in a store, summed up."""

import json
from pathlib import Path
from typing import Any

import pytest

from clamber.experiments.walk.noise import named_walk_noise
from clamber.experiments.walk.trials import WalkTrial, WalkTrials, run_walk_trial, run_walk_trials
from clamber.jobs import LocalProcesses
from clamber.tasks.walks import load_walk

SHORT = "way.0.distance=3cm"


def trial(**changes: Any) -> WalkTrial:
    plain = {
        "seed": 0, "done": True, "reason": "", "seconds": 10.0, "steps": 2, "tilt": 0.001, "margin": 0.06, "off": 1e-3,
        "turned": 0.0, "kicks": 0,
    }  # fmt: skip
    return WalkTrial(**(plain | changes))


def test_a_trial_is_the_same_again_by_its_seed() -> None:
    walk = load_walk("level-walk", [SHORT])
    noise = named_walk_noise("usual").to_json() | {"inclinometer_offset": 0.0}  # no calibration
    item = {"document": walk.document, "plant": [], "noise": noise, "seed": 5}
    first, again, other = run_walk_trial(item), run_walk_trial(item), run_walk_trial(item | {"seed": 6})
    assert first == again
    assert first["done"], first["reason"]
    assert first["tilt"] != other["tilt"]
    assert json.loads(json.dumps(first)) == first


def test_trials_are_kept_and_taken_from_their_store(tmp_path: Path) -> None:
    walk, noise, store = load_walk("level-walk", [SHORT]), named_walk_noise("none"), tmp_path / "walks.db"
    crew = LocalProcesses(1)
    one = run_walk_trials(walk, noise, range(1), executor=crew, store=store)
    told: list[int] = []
    two = run_walk_trials(
        walk, noise, range(2), executor=crew, store=store, resume=True, told=lambda trials: told.append(len(trials.ended))
    )  # fmt: skip
    assert [each.seed for each in two.ended] == [0, 1]
    assert two.ended[0] == one.ended[0]
    assert two.done == 2
    assert told[-1] <= 2


@pytest.mark.slow
def test_a_point_that_is_held_is_measured_in_every_trial() -> None:
    walk = load_walk("slope-walk", ("hold={ x='5 cm', y='0.3 m', z='0.6 m', within='4 cm' }", "way.0.distance=10cm"))
    noise = named_walk_noise("usual").to_json() | {"inclinometer_offset": 0.0}
    told = WalkTrial(**run_walk_trial({"document": walk.document, "plant": [], "noise": noise, "seed": 1}))
    assert told.done, told.reason
    assert told.held_way == pytest.approx(0.08, abs=2e-3)
    assert told.held_error is not None and 1e-5 < told.held_error < 5e-3


def test_shares_count_walks_that_came_to_their_end_and_those_that_kept_their_balance() -> None:
    ended = [trial(), trial(seed=1, done=False, reason="fell", margin=None, off=None), trial(seed=2, margin=-0.01)]
    trials = WalkTrials(load_walk("level-walk"), named_walk_noise("none"), 3, ended)
    assert (trials.done, trials.balanced) == (2, 1)
    low, high = trials.interval
    assert 0.0 < low < 2 / 3 < high < 1.0
    assert trials.of("off").tolist() == [1e-3, 1e-3]
    assert trials.to_json()["n"] == 3
