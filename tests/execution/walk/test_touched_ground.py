"""What footfalls tell of ground that nobody knows."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from clamber.families.walker.execution.touched_ground import FREE, KEPT, TouchedGround

SLOPES = st.floats(-0.3, 0.3)


@given(SLOPES, SLOPES, st.floats(-1.0, 1.0), st.integers(0, 100))
def test_footfalls_of_a_plane_give_the_plane(along: float, across: float, height: float, seed: int) -> None:
    places = np.random.default_rng(seed).uniform(-0.5, 0.5, (12, 2))
    ground = TouchedGround()
    for x, y in places:
        ground.add(np.array((x, y)), height + along * x + across * y)
    assert ground.known
    there = np.array(((2.0, -1.0), (0.0, 0.3)))
    np.testing.assert_allclose(ground.heights(there), height + there @ (along, across), atol=1e-9)
    assert ground.rough == pytest.approx(0.0, abs=1e-9)


def test_it_is_a_little_rougher_than_the_footfall_farthest_off_the_plane() -> None:
    angles = np.radians(np.arange(0.0, 360.0, 60.0))
    ground = TouchedGround()
    for k, angle in enumerate(angles):  # saw teeth about a circle fit best to the level plane
        ground.add(np.array((np.cos(angle), np.sin(angle))), 0.02 * (-1.0) ** k)
    assert ground.rough == pytest.approx(0.02 * np.sqrt(6 / 3))
    np.testing.assert_allclose(ground.heights(np.array(((0.7, 3.0),))), 0.0, atol=1e-12)


def test_old_footfalls_are_forgotten_and_few_tell_nothing() -> None:
    ground = TouchedGround()
    for k in range(FREE + 1):
        assert not ground.known
        ground.add(np.array((0.1 * k, 0.0)), 5.0)
    for k in range(KEPT):
        ground.add(np.array((0.1 * k, 0.1 * (k % 2))), 1.0)
    assert ground.rough == pytest.approx(0.0, abs=1e-12)


def test_footfalls_in_a_line_tell_no_slope_across_it() -> None:
    ground = TouchedGround()
    for k in range(8):
        ground.add(np.array((0.1 * k, 0.0)), 0.01 * k)
    np.testing.assert_allclose(ground.heights(np.array(((0.2, 5.0),))), 0.02, atol=1e-9)
