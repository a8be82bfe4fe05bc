"""Footholds away from edges: what touches tell, and where frames come to stand on tiles."""

import math

import numpy as np
import pytest
from spring_walks import BEST, stood
from springs_walker import flat, tiles

from clamber.control.gait import Y
from clamber.execution.walk import motions
from clamber.execution.walk.footholds import Touches, choose_footing
from clamber.execution.walk.settings import WalkSettings
from clamber.types import Floats

SIDE = 0.15
PROBE = 0.012


def edge_distances(feet: Floats) -> Floats:
    """How far feet are from the nearest edge of the tiles, shape (n,) [m]."""
    inside = feet[:, :2] % SIDE
    return np.asarray(np.minimum(inside, SIDE - inside).min(axis=1))


def test_touches_of_two_heights_have_an_edge_between_them() -> None:
    touches = Touches(0.003)
    touches.add(np.array(((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (2.0, 0.0, 0.0))))
    touches.add(np.array(((0.02, 0.0, 0.015), (1.02, 0.0, 0.002), (2.02, 0.0, 0.0))))
    assert len(touches.edges(0)) == 2  # each of both has the other
    assert touches.edges(1) == []  # 2 mm are even
    assert touches.clearance(0, np.array((0.01, 0.03))) == pytest.approx(0.03)
    assert touches.clearance(0, np.array((0.05, 0.0))) == pytest.approx(0.03)
    assert touches.clearance(1, np.zeros(2)) == math.inf
    assert not touches.even_about(0, np.array((0.01, 0.0)), 0.015)
    assert touches.even_about(1, np.array((1.01, 0.0)), 0.015)
    assert touches.known(2, np.array((2.01, 0.0)), 0.011)
    assert not touches.known(2, np.array((2.01, 0.01)), 0.011)
    touches.add_hole(2, np.array((2.04, 0.0, -0.06)))
    assert touches.clearance(2, np.array((2.03, 0.0))) == pytest.approx(0.0, abs=1e-12)


def test_on_even_ground_a_frame_stands_where_it_was_to_after_three_touches() -> None:
    walker, plant = stood(flat, settings=WalkSettings(probe=PROBE, clear=None))
    wish = walker.frames()[Y] + 0.03 * np.array((math.cos(BEST), math.sin(BEST), 0.0))
    motions.lift(walker, Y)
    found = choose_footing(walker, Y, wish)
    assert (found.touches, found.even, found.moved, found.without) == (4, True, 0.0, ())
    np.testing.assert_allclose(walker.frames()[Y], wish, atol=1e-3)
    assert np.all(plant.forces > 5.0)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_on_tiles_a_frame_stands_away_from_edges(seed: int) -> None:
    settings = WalkSettings(probe=PROBE, clear=None, most_probes=20)
    walker, plant = stood(tiles(SIDE, 0.02, seed), settings=settings, noise=0.0, seed=seed)
    motions.find_ground(walker)
    motions.level(walker)
    motions.settle(walker)
    motions.lift(walker, Y)
    found = choose_footing(walker, Y, walker.frames()[Y])
    feet = plant.truth().feet[Y]
    assert found.without == ()
    if found.even:  # else it says that it is not, and why
        uneven = [
            i
            for i, foot in enumerate(feet)
            if edge_distances(foot[None])[0] < 0.5 * PROBE - 2e-3 and _differs(plant.ground, foot, 0.004)
        ]
        assert uneven == []
    else:
        assert "edge near leg" in found.reason
    assert walker.stands[walker.of_frame(Y)].all()


def _differs(ground, foot: Floats, even: float) -> bool:  # type: ignore[no-untyped-def]
    """Whether the tiles about a foot differ in height by so much [m]."""
    angles = np.linspace(0, math.tau, 16, endpoint=False)
    ring = [ground(foot[0] + PROBE * math.cos(a), foot[1] + PROBE * math.sin(a)) for a in angles]
    return max(ring) - min(ring) > even
