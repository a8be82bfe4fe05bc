"""A plant's imperfections are checked where they are stated, and pushes come and go as stated."""

import math
import pickle

import pytest
from hypothesis import given
from hypothesis import strategies as st

from clamber.sim.limb_flaws import LimbFlaws, Push
from clamber.sim.plant_rules import PlantError


@pytest.mark.parametrize(
    ("key", "value", "allowed"),
    [
        ("damping", -1.0, "must be 0 or more"),
        ("friction", math.nan, "must be 0 or more, and finite"),
        ("backlash", -0.1, "must be 0 or more"),
        ("payload", math.inf, "must be 0 or more, and finite"),
        ("encoder_counts", -1, "must be a whole number"),
        ("encoder_counts", 400.5, "must be a whole number"),
        ("delay", 1.5, "must be a whole number"),
        ("delay", -1, "must be a whole number"),
        ("control_rate", 0.0, "must be more than 0 and at most 100000 Hz"),
        ("physics_rate", math.nan, "must be more than 0 and at most 100000 Hz"),
        ("control_rate", 300.0, "must divide the physics rate of 2000 Hz into whole steps"),
        ("control_rate", 4000.0, "must divide the physics rate"),
        ("backlahs", 0.1, "did you mean 'backlash'"),
    ],
)
def test_what_cannot_be_is_named_with_its_value_and_what_is_allowed(key: str, value: float, allowed: str) -> None:
    with pytest.raises(PlantError) as caught:
        LimbFlaws().with_changes(**{key: value})
    assert f"plant: {key} = " in str(caught.value)
    assert allowed in str(caught.value)
    assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)


@pytest.mark.parametrize("rate", [50.0, 200.0, 1000.0, 2000.0])
def test_a_period_is_a_whole_number_of_steps(rate: float) -> None:
    flaws = LimbFlaws(control_rate=rate)
    assert flaws.steps / flaws.physics_rate == pytest.approx(flaws.period, rel=1e-12)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"start": -1.0}, "must start at 0 s or later"),
        ({"end": 0.5}, "end after its start"),
        ({"rise": -0.1}, "push.rise = -0.1"),
        ({"x": math.nan}, "push.x = nan: must be a finite number"),
        ({"end": math.inf}, "push.end = inf: must be a finite number"),
    ],
)
def test_a_push_that_cannot_be_is_refused(changes: dict[str, float], words: str) -> None:
    with pytest.raises(PlantError, match=words):
        Push(**({"x": 1.0, "y": 2.0, "start": 1.0, "end": 2.0} | changes))


@given(st.floats(0.0, 4.0), st.floats(0.0, 0.5))
def test_a_push_never_leaves_its_line_nor_exceeds_its_size(time: float, rise: float) -> None:
    push = Push(x=3.0, y=-4.0, start=1.0, end=2.0, rise=rise)
    x, y = push.at(time)
    assert -4.0 * x == pytest.approx(3.0 * y) and 0.0 <= x <= 3.0
    if time <= 1.0 or time >= 2.0 + rise:
        assert (x, y) == (0.0, 0.0)
    if 1.0 + rise <= time <= 2.0 and 1.0 < time < 2.0 + rise:
        assert (x, y) == (3.0, -4.0)
