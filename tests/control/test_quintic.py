"""The quintic law from rest to rest against its closed forms."""

import numpy as np
import pytest

from clamber.control.quintic import quintic_share


def test_it_goes_from_nothing_to_all_and_stays_there() -> None:
    assert [quintic_share(part) for part in (-1.0, 0.0, 0.5, 1.0, 3.0)] == [0.0, 0.0, 0.5, 1.0, 1.0]


@pytest.mark.parametrize("part", [0.1, 0.37, 0.8])
def test_its_slope_is_that_of_the_closed_form(part: float) -> None:
    h = 1e-6
    slope = (quintic_share(part + h) - quintic_share(part - h)) / (2 * h)
    assert slope == pytest.approx(30 * part**2 * (1 - part) ** 2, rel=1e-8)


def test_what_is_left_mirrors_what_is_done() -> None:
    u = np.linspace(0.0, 1.0, 51)
    assert [quintic_share(v) + quintic_share(1.0 - v) for v in u] == pytest.approx(np.ones(51), abs=1e-14)


def test_it_starts_and_ends_without_a_jolt() -> None:
    h = 1e-4
    for end in (0.0, 1.0):
        assert abs(quintic_share(end + h) - 2 * quintic_share(end) + quintic_share(end - h)) / h**2 < 20 * h
