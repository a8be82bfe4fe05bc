"""What many climbs say together."""

import json

import pytest
from climbs_by_hand import climb, setup_of

from clamber.families.climber.trials.trial import error_trial
from clamber.families.climber.trials.trial_summary import sum_up
from clamber.trials.trial_runs import Trials

UP = (300, 3, 3)
"""The bottom limb lets go, and the body goes up by 3 in twice: one rung."""


def test_success_times_and_causes_are_counted() -> None:
    ended = [climb(seed, seconds=20.0 + seed) for seed in range(5)]
    ended += [
        climb(5, done=False, outcome="missed", kind="grab", limb="left", step=2),
        climb(6, done=False, outcome="missed", kind="grab", limb="left", step=9),
        climb(7, done=False, seconds=900.0),
        error_trial(8, "ValueError: boom"),
    ]
    told = sum_up(Trials(setup_of(*UP), 12, ended, wall_seconds=100.0))
    assert (told.done, told.n, told.asked) == (5, 9, 12)
    first = told.causes[0]
    assert (first.words, first.n, first.steps, first.seeds) == ("missed: left grab", 2, (2, 9), (5, 6))
    assert [cause.words for cause in told.causes[1:]] == ["error", "fell: move"]
    assert sum(cause.n for cause in told.causes) == told.n - told.done
    assert told.seconds is not None and told.per_rung is not None
    assert told.seconds.median == 22.0  # of those that were carried out
    assert told.per_rung.median == pytest.approx(22.0)  # the plan's body goes 6 in
    assert told.speed == pytest.approx((sum(range(20, 25)) + 200.0 + 900.0) / 100.0)
    json.dumps(told.to_json(), allow_nan=False)


def test_hooks_that_were_brought_back_are_counted_with_what_became_of_their_climbs() -> None:
    ended = [climb(0), climb(1, recovered=2), climb(2, recovered=1, done=False), climb(3, recovered=1)]
    told = sum_up(Trials(setup_of(*UP), 4, ended))
    assert (told.recovered, told.recovering, told.saved) == (4, 3, 2)
    assert [told.to_json()[key] for key in ("recovered", "recovering", "saved")] == [4, 3, 2]


def test_without_a_success_or_a_way_there_are_no_times() -> None:
    none = sum_up(Trials(setup_of(300), 2, [climb(0, done=False)]))
    assert (none.seconds, none.per_rung, none.speed) == (None, None, None)
    assert sum_up(Trials(setup_of(300), 1, [climb(0)])).per_rung is None
    nothing = sum_up(Trials(setup_of(300), 3, []))
    assert (nothing.n, nothing.interval, nothing.pushes) == (0, (0.0, 1.0), None)
    json.dumps(nothing.to_json(), allow_nan=False)
