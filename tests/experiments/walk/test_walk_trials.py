"""Many walks: each by its seed alone, kept in a store, summed up."""

import json
from pathlib import Path
from typing import Any

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


def test_shares_count_walks_that_came_to_their_end_and_those_that_kept_their_balance() -> None:
    ended = [trial(), trial(seed=1, done=False, reason="fell", margin=None, off=None), trial(seed=2, margin=-0.01)]
    trials = WalkTrials(load_walk("level-walk"), named_walk_noise("none"), 3, ended)
    assert (trials.done, trials.balanced) == (2, 1)
    low, high = trials.interval
    assert 0.0 < low < 2 / 3 < high < 1.0
    assert trials.of("off").tolist() == [1e-3, 1e-3]
    assert trials.to_json()["n"] == 3
