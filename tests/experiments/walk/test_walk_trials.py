"""Many walks: each by its seed alone, kept in a store, summed up."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from clamber.families.walker.planning import load_walk
from clamber.families.walker.planning.task import WalkerTask
from clamber.families.walker.trials.noise import WalkNoise
from clamber.families.walker.trials.planned import careful
from clamber.families.walker.trials.trials import WalkSetup, WalkTrial, WalkTrials, run_walk_trial
from clamber.jobs import LocalProcesses, StoreError
from clamber.planning.planners import plan_task
from clamber.tasks import load_task
from clamber.trials.trial_runs import run_trials, wilson_interval

SHORT = "way.0.distance=3cm"


def trial(**changes: Any) -> WalkTrial:
    plain = {
        "seed": 0, "done": True, "reason": "", "seconds": 10.0, "steps": 2, "tilt": 0.001, "margin": 0.06, "off": 1e-3,
        "turned": 0.0, "kicks": 0,
    }  # fmt: skip
    return WalkTrial(**(plain | changes))


@pytest.mark.slow
def test_a_trial_is_the_same_again_by_its_seed() -> None:
    walk = load_walk("level-walk", [SHORT])
    noise = WalkNoise(WalkNoise.of("usual").widths | {"inclinometer_offset": 0.0})  # no calibration
    setup = WalkSetup(walk, noise)
    first, again, other = (run_walk_trial(setup.item(seed)) for seed in (5, 5, 6))
    assert first == again
    assert first["done"], first["reason"]
    assert first["tilt"] != other["tilt"]
    assert json.loads(json.dumps(first)) == first


@pytest.mark.slow
@pytest.mark.usefixtures("in_this_process")
def test_trials_are_kept_and_taken_from_their_store(tmp_path: Path) -> None:
    setup, store = WalkSetup(load_walk("level-walk", [SHORT]), WalkNoise.of("none")), tmp_path / "walks.db"
    crew = LocalProcesses(1)
    one = run_trials(setup, range(1), executor=crew, store=store)
    told: list[int] = []
    two = run_trials(
        setup, range(2), executor=crew, store=store, resume=True, told=lambda trials: told.append(len(trials.ended))
    )  # fmt: skip
    assert [each.seed for each in two.ended] == [0, 1]
    assert two.ended[0] == one.ended[0]
    assert two.done == 2
    assert told[-1] <= 2


@pytest.mark.slow
def test_a_plan_is_walked_by_every_seed_and_kept_in_the_store(tmp_path: Path) -> None:
    task = careful(load_walker_task("terrace-walk", "goal.x_min=2cm", "goal.x_max=8cm", "goal.y_min=-2cm", "goal.y_max=2cm",
                                    "goal.theta_min=-1deg", "goal.theta_max=1deg"))  # fmt: skip
    result = plan_task(task, "exact")
    assert result.has_plan
    setup, store = WalkSetup(task, WalkNoise.of("none"), (), result.plan, planned=True), tmp_path / "walks.db"
    assert setup.stored_plan(store) is None
    trials = run_trials(setup, range(2), executor=LocalProcesses(1), store=store)
    assert [trial.done for trial in trials.ended] == [True, True], trials.ended
    assert all((trial.off or 1.0) < 5e-3 for trial in trials.ended)  # from where the plan ends
    asked_anew = replace(setup, plan=None)
    assert asked_anew.stored_plan(store) == result.plan
    with pytest.raises(StoreError):
        replace(setup, plan=None, plant=("friction=50%",)).stored_plan(store)


def load_walker_task(name: str, *settings: str) -> WalkerTask:
    task = load_task(name, settings)
    assert isinstance(task, WalkerTask)
    return task


@pytest.mark.slow
def test_a_point_that_is_held_is_measured_in_every_trial() -> None:
    walk = load_walk("slope-walk", ("hold={ x='5 cm', y='0.3 m', z='0.6 m', within='4 cm' }", "way.0.distance=10cm"))
    noise = WalkNoise(WalkNoise.of("usual").widths | {"inclinometer_offset": 0.0})
    told = WalkTrial(**run_walk_trial(WalkSetup(walk, noise).item(1)))
    assert told.done, told.reason
    assert told.held_way == pytest.approx(0.08, abs=2e-3)
    assert told.held_error is not None and 1e-5 < told.held_error < 5e-3


def test_shares_count_walks_that_came_to_their_end_and_those_that_kept_their_balance() -> None:
    ended = [trial(), trial(seed=1, done=False, reason="fell", margin=None, off=None), trial(seed=2, margin=-0.01)]
    trials = WalkTrials(WalkSetup(load_walk("level-walk"), WalkNoise.of("none")), 3, ended)
    assert (trials.done, trials.balanced) == (2, 1)
    low, high = trials.interval
    assert 0.0 < low < 2 / 3 < high < 1.0
    assert trials.of("off").tolist() == [1e-3, 1e-3]
    assert trials.to_json()["n"] == 3


def test_a_walk_is_level_if_it_came_to_its_end_and_was_so_all_the_way() -> None:
    tilts = (0.099, 0.101, 0.05, 0.02)
    ended = [trial(seed=k, tilt=math.radians(tilt), done=k != 3) for k, tilt in enumerate(tilts)]
    trials = WalkTrials(WalkSetup(load_walk("level-walk"), WalkNoise.of("none")), 4, ended)
    assert trials.level == 2
    assert trials.to_json()["level"] == 2


def test_causes_gather_walks_that_ended_alike() -> None:
    reasons = ("fell: the robot tips", "step 4: refused: too far", "step 9: refused: too long", "lost: 30 mm away", "")
    ended = [trial(seed=k, done=not reason, reason=reason, steps=k) for k, reason in enumerate(reasons)]
    causes = WalkTrials(WalkSetup(load_walk("level-walk"), WalkNoise.of("none")), 5, ended).causes()
    assert [(cause.words, cause.n, cause.steps, cause.seeds) for cause in causes] == [
        ("refused", 2, (1, 2), (1, 2)), ("fell", 1, (0,), (0,)), ("lost", 1, (3,), (3,)),
    ]  # fmt: skip
    assert causes[0].reason == reasons[1]
    assert causes[0].interval == wilson_interval(2, 5)
