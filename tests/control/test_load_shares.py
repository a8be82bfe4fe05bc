"""Shares of a load that no leg has to pull for: the conditions of the smallest sum of squares."""

import numpy as np
import pytest

from clamber.control.load_shares import over_share
from clamber.control.loads import strain_of
from clamber.types import Floats

SIX = np.ones(6, np.int32)
ANGLES = np.radians((90.0, 210.0, 330.0, 30.0, 150.0, 270.0))
FEET = 0.2384 * np.column_stack([np.cos(ANGLES), np.sin(ANGLES)])
WEIGHT, LEAST = 1000.0, 15.0


def carried(centre: Floats) -> Floats:
    """Loads of six feet that carry a weight over a place, strained against each other at random."""
    arms = np.column_stack([np.ones(6), FEET])
    even = arms @ np.linalg.solve(arms.T @ arms, WEIGHT * np.array((1.0, *centre)))
    strain = strain_of(FEET, np.random.default_rng(0).uniform(-50.0, 50.0, 6), SIX)
    loads: Floats = even + strain
    return loads


@pytest.mark.parametrize("away", [0.0, 0.05, 0.1])
def test_where_every_leg_bears_enough_the_shares_are_the_plane_s(away: float) -> None:
    loads = carried(np.array((away, 0.0)))
    np.testing.assert_array_equal(over_share(FEET, loads, SIX, LEAST), strain_of(FEET, loads, SIX))


@pytest.mark.parametrize("seed", range(20))
def test_shares_are_the_most_even_of_all_in_which_no_leg_pulls(seed: int) -> None:
    rng = np.random.default_rng(seed)
    angle, away = rng.uniform(0.0, 2.0 * np.pi), rng.uniform(0.13, 0.17)
    loads = carried(away * np.array((np.cos(angle), np.sin(angle))))
    shares = loads - over_share(FEET, loads, SIX, LEAST)
    assert (loads - strain_of(FEET, loads, SIX)).min() < LEAST  # the plane would have one pull
    arms = np.column_stack([np.ones(6), FEET])
    np.testing.assert_allclose(arms.T @ shares, arms.T @ loads, atol=1e-9)
    assert shares.min() >= LEAST - 1e-9
    bound = shares < LEAST + 1e-9
    plane = arms @ np.linalg.lstsq(arms[~bound], shares[~bound], rcond=None)[0]
    np.testing.assert_allclose(shares[~bound], plane[~bound], atol=1e-9)
    assert (plane[bound] <= LEAST).all()  # Kuhn and Tucker: a plane, and at the bound only what it would have below


def test_a_load_that_only_two_legs_could_carry_is_left() -> None:
    assert not over_share(FEET, carried(np.array((0.0, 0.2383))), SIX, LEAST).any()


def test_legs_that_do_not_stand_have_no_share() -> None:
    stands = np.array((1, 1, 1, 1, 1, 0), np.int32)
    loads = np.array((400.0, 5.0, 200.0, 300.0, 90.0, 0.0))
    over = over_share(FEET, loads, stands, LEAST)
    assert over[5] == 0.0
    assert over.sum() == pytest.approx(0.0, abs=1e-9)
    np.testing.assert_allclose(over @ FEET, 0.0, atol=1e-9)
