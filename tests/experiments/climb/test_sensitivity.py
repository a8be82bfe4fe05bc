"""What of the noise matters: found where it does, denied where it does not, left open where failures are too few."""

import math

import numpy as np
import pytest
from climbs_by_hand import climb

from clamber.families.climber.trials.noise import NOISE
from clamber.families.climber.trials.trial import ClimbTrial, error_trial
from clamber.trials.sensitivity import LEVEL, Effect, find_effects


def effects(trials: list[ClimbTrial]) -> dict[str, Effect]:
    return {effect.key: effect for effect in find_effects(NOISE, trials)}


def judged(n: int, rule: str) -> list[ClimbTrial]:
    """Climbs that fail by what they drew of payload."""
    fails = {
        "high": lambda v: v > 0.6,
        "low": lambda v: v < -0.6,
        "far": lambda v: abs(v) > 0.8,
        "near": lambda v: abs(v) < 0.2,
    }[rule]
    return [climb(seed, done=not fails(climb(seed).drawn["payload"])) for seed in range(n)]


@pytest.mark.parametrize("rule", ["high", "low", "far", "near"])
def test_the_key_that_decides_is_named_and_no_other(rule: str) -> None:
    told = effects(judged(120, rule))
    assert told["payload"].verdict == rule
    assert {key: effect.verdict for key, effect in told.items() if key != "payload"} == {
        key: "none" for key in NOISE if key != "payload"
    }


@pytest.mark.slow
def test_failures_by_chance_alone_are_seldom_blamed_on_a_key() -> None:
    wrong = 0
    for campaign in range(200):
        failed = np.random.default_rng([9, campaign]).random(60) < 0.2
        trials = [climb(60 * campaign + k, done=not bad) for k, bad in enumerate(failed)]
        wrong += any(effect.verdict not in ("none", "too few") for effect in find_effects(NOISE, trials))
    # at most 5 % of campaigns, and not more than four standard deviations above it
    assert wrong <= 200 * LEVEL + 4 * math.sqrt(200 * LEVEL * (1 - LEVEL))


@pytest.mark.parametrize("failures", [0, 1, 2, 24])
def test_with_hardly_a_failure_or_hardly_a_success_nothing_is_told(failures: int) -> None:
    ranked = sorted((climb(seed) for seed in range(24)), key=lambda one: one.drawn["payload"])
    trials = [climb(one.seed, done=k >= failures) for k, one in enumerate(ranked)]
    assert {effect.verdict for effect in find_effects(NOISE, trials)} == {"too few"}


def test_thirds_count_all_climbs_once_in_order() -> None:
    told = effects(judged(31, "high"))["payload"]
    assert [third.n for third in told.thirds] == [11, 10, 10]
    assert told.thirds[0].high < told.thirds[1].low < told.thirds[1].high < told.thirds[2].low
    assert sum(third.done for third in told.thirds) == sum(one.done for one in judged(31, "high"))
    assert told.thirds[0].done == 11
    assert told.thirds[0].interval[1] == 1.0
    assert told.share > 0.9


def test_keys_that_never_deviate_and_climbs_that_drew_nothing_are_left_out() -> None:
    trials = [climb(seed, drawn=climb(seed).drawn | {"friction": 0.0}) for seed in range(9)]
    assert "friction" not in effects(trials)
    assert len(effects(trials)) == len(NOISE) - 1
    assert effects([*trials, error_trial(9, "boom")])["payload"].thirds[0].n == 3
    assert find_effects(NOISE, []) == []
