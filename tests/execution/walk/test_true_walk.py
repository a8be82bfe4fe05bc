"""The trace of a walk against a plain plant, and margins of hulls against half-planes of a library."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from clamber.families.walker.execution.plant import WalkerPlant, WalkerSensed, WalkerTruth
from clamber.families.walker.execution.true_walk import ROWS, TracedPlant, hull_margins


class Counted:
    """A plant whose numbers are its ticks."""

    period = 0.1

    def __init__(self) -> None:
        self.ticks = 0
        self.inclines = np.zeros(2)

    def reset(self, *_: object) -> None:
        self.ticks = 0

    def sense(self) -> WalkerSensed:
        self.inclines[:] = 0.5 * self.ticks
        return WalkerSensed(0.0, np.zeros(3), np.zeros((2, 3)), np.zeros((2, 3)), self.inclines, np.zeros(0))

    def actuate(self, *_: object) -> None: ...

    def pause(self) -> None: ...

    def step(self) -> None:
        self.ticks += 1

    def truth(self) -> WalkerTruth:
        k = float(self.ticks)
        feet = k + np.arange(18.0).reshape(2, 3, 3)
        forces = np.zeros((2, 3, 3))
        forces[0, :, 2] = k
        return WalkerTruth(
            np.full(6, k),
            np.full(3, 2 * k),
            feet,
            np.zeros((2, 3), np.int32),
            forces,
            np.full(3, 3 * k),
            np.full(3, 4 * k),
            np.full(3, 5 * k),
        )


def test_every_tick_is_kept_as_it_truly_was() -> None:
    plant: WalkerPlant = TracedPlant(Counted())
    plant.reset(np.zeros(6), np.zeros(3), np.zeros((2, 3)), np.zeros(0))
    n = ROWS + 5  # beyond the first room
    for _ in range(n):
        plant.sense()
        plant.step()
    assert isinstance(plant, TracedPlant)
    trace = plant.trace()
    ticks = np.arange(n + 1.0)
    np.testing.assert_allclose(trace.time, 0.1 * ticks)
    np.testing.assert_array_equal(trace.pose[:, 3], ticks)
    np.testing.assert_array_equal(trace.feet[:, 1, 2, 0], ticks + 15)
    np.testing.assert_array_equal(trace.tool[:, 1], 4 * ticks)
    np.testing.assert_array_equal(trace.inclines[1:, 0], 0.5 * (ticks[1:] - 1))
    np.testing.assert_array_equal(trace.touching[3], [[1, 1, 1], [0, 0, 0]])
    plant.reset(np.zeros(6), np.zeros(3), np.zeros((2, 3)), np.zeros(0))
    assert len(plant.trace().time) == 1


@given(seed=st.integers(0, 1000), n=st.integers(3, 6))
def test_the_margin_is_that_of_the_nearest_side_of_the_hull(seed: int, n: int) -> None:
    rng = np.random.default_rng(seed)
    feet, point = rng.uniform(-1.0, 1.0, (6, 2)), rng.uniform(-1.0, 1.0, 2)
    stands = np.zeros(6, np.int32)
    stands[rng.permutation(6)[:n]] = 1
    hull = ConvexHull(feet[stands > 0])
    wanted = -(hull.equations @ np.append(point, 1.0)).max()
    found = hull_margins(feet[None], stands[None], point[None])
    assert found[0] == pytest.approx(wanted, abs=1e-12)


def test_two_feet_and_feet_in_line_have_no_inside() -> None:
    feet = np.array([[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 1.0]]] * 3)
    stands = np.array([[1, 1, 0, 0], [1, 1, 1, 0], [1, 1, 1, 1]])
    found = hull_margins(feet, stands, np.full((3, 2), 0.25))
    assert found[:2].tolist() == [-math.inf, -math.inf]
    assert found[2] == pytest.approx(0.25)


def test_tilt_is_the_angle_of_the_normal_to_the_vertical() -> None:
    plant = TracedPlant(Counted())
    plant.reset(np.zeros(6), np.zeros(3), np.zeros((2, 3)), np.zeros(0))
    trace = plant.trace()
    trace.pose[0, 3:] = 1.0, 0.1, 0.0
    assert trace.tilts[0] == pytest.approx(0.1)
    trace.pose[0, 3:] = 1.0, 0.0, -0.2
    assert trace.tilts[0] == pytest.approx(0.2)
