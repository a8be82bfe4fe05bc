"""How legs share load: planes, strain, and what sinking in does."""

import math

import numpy as np
import pytest

from clamber.control.loads import plane_slope, sink_together, sink_unevenly, strain_of
from clamber.types import Floats

SIX = np.ones(6, np.int32)


def spread(seed: int) -> tuple[Floats, Floats]:
    rng = np.random.default_rng(seed)
    return rng.uniform(-0.3, 0.3, (6, 2)), rng.uniform(50.0, 300.0, 6)


def test_the_slope_is_that_of_the_plane_through_what_counts() -> None:
    places, _ = spread(0)
    stands = np.array([1, 0, 1, 1, 1, 0], np.int32)
    loads = 100.0 + places @ np.array((30.0, -70.0))
    loads[stands == 0] = 999.0
    np.testing.assert_allclose(plane_slope(places, loads, stands), (30.0, -70.0), atol=1e-9)
    assert plane_slope(places, loads, np.array([1, 1, 0, 0, 0, 0], np.int32)) == (0.0, 0.0)
    line = np.outer(np.arange(6.0), (0.1, 0.2))
    assert plane_slope(line, loads, SIX) == (0.0, 0.0)


def test_the_slope_is_that_of_least_squares() -> None:
    places, loads = spread(5)
    fit = np.linalg.lstsq(np.column_stack([np.ones(6), places]), loads, rcond=None)[0]
    np.testing.assert_allclose(plane_slope(places, loads, SIX), fit[1:], rtol=1e-9)


def test_what_legs_carry_beyond_their_share_is_no_force_and_no_moment() -> None:
    places, loads = spread(1)
    stands = np.array([1, 1, 1, 1, 1, 0], np.int32)
    over = strain_of(places, loads, stands)
    assert over[5] == 0.0
    assert over.sum() == pytest.approx(0.0, abs=1e-9)
    np.testing.assert_allclose(over @ places, 0.0, atol=1e-9)
    even = (loads - over)[:5]
    other = even + 10.0 * np.linalg.svd(np.column_stack([np.ones(5), places[:5]]).T)[2][3]  # same force, same moment
    assert np.sum(even**2) < np.sum(other**2)
    assert not strain_of(places, loads, np.array([1, 1, 1, 0, 0, 0], np.int32)).any()


@pytest.mark.parametrize("heading", [0.0, 0.7, -2.5])
def test_three_feet_sink_by_their_own_loads_whatever_the_heading(heading: float) -> None:
    places, loads = spread(2)
    stands, give = np.array([1, 1, 1, 0, 0, 0], np.int32), 7e-6
    heights, slope = np.zeros(6), np.zeros(2)
    sink_unevenly(1.0, give, heading, places, loads, stands, slope, heights)
    np.testing.assert_allclose(heights[:3], -give * (loads[:3] - loads[:3].mean()), rtol=1e-9)
    assert not heights[3:].any()
    again = heights.copy()
    assert sink_unevenly(1.0, give, heading, places, loads, stands, slope, heights) == pytest.approx(
        (0.0, 0.0), abs=1e-9
    )
    np.testing.assert_allclose(heights, again, atol=1e-15)


def test_shares_of_sinking_add_up_to_the_whole() -> None:
    places, loads = spread(3)
    whole, parts = np.zeros(6), np.zeros(6)
    slope_whole, slope_parts = np.zeros(2), np.zeros(2)
    sink_unevenly(1.0, 7e-6, 0.3, places, loads, SIX, slope_whole, whole)
    for _ in range(200):
        sink_unevenly(0.1, 7e-6, 0.3, places, loads, SIX, slope_parts, parts)
    np.testing.assert_allclose(parts, whole, atol=1e-12)


def test_on_a_slope_feet_sink_in_along_the_normal() -> None:
    places, loads = spread(4)
    give, angle = 7e-6, math.radians(10.0)
    heights = math.tan(angle) * places[:, 0]
    anchors, felt, before = places.copy(), np.zeros(6), heights.copy()
    down = sink_together(1.0, give, loads * math.cos(angle), SIX, felt, anchors, heights)
    np.testing.assert_allclose(anchors[:, 0] - places[:, 0], give * loads * math.cos(angle) ** 3 * math.tan(angle))
    np.testing.assert_allclose(anchors[:, 1], places[:, 1])
    np.testing.assert_allclose(heights, before - down)
    np.testing.assert_allclose(felt, loads * math.cos(angle))
    assert down == pytest.approx(give * loads.mean() * math.cos(angle) ** 3)
