"""What a walker finds out about itself: offsets of inclinometers by turning, and the give of its feet by shifting load."""

import math

import numpy as np
import pytest
from spring_walks import stood
from springs_walker import slope

from clamber.families.walker.control.gait import DELTA
from clamber.families.walker.execution import motions
from clamber.families.walker.execution.calibrate import calibrate, feel_give, offsets_from, shift_load


def test_offsets_and_slope_are_told_apart_by_two_headings() -> None:
    offsets, uphill = np.array((0.003, -0.002)), np.array((0.01, 0.02))
    headings = (-0.3, 0.7)
    turned = [np.array(((math.cos(a), math.sin(a)), (-math.sin(a), math.cos(a)))) @ uphill for a in headings]
    np.testing.assert_allclose(offsets_from([offsets + each for each in turned], headings), offsets, atol=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2))
def test_turning_over_the_y_frame_finds_offsets_on_a_slope(seed: int) -> None:
    tilt, offsets = math.radians(8.0), np.radians((0.3, -0.2))
    walker, plant = stood(slope(tilt, 0.6), tilt=tilt, uphill=0.6, offsets=tuple(offsets), seed=seed)
    motions.level(walker)
    assert math.degrees(plant.tilt()) > 0.2  # level by inclinometers that are off
    off = calibrate(walker)
    np.testing.assert_allclose(off, offsets, atol=math.radians(0.03))
    motions.settle(walker, 8.0)
    assert math.degrees(plant.tilt()) < 0.06
    assert walker.stands.all()
    np.testing.assert_allclose(walker.arm, walker.robot.arm.rest)  # type: ignore[union-attr]


@pytest.mark.parametrize("give", [0.0, 7e-6, 1.5e-5])
def test_the_arm_tells_how_far_feet_sink_in(give: float) -> None:
    walker, _ = stood(give=give, seed=5)
    motions.settle(walker, 4.0)
    feel_give(walker)
    assert walker.inclination.give == pytest.approx(give, abs=5e-6)  # believed to be 1e-5 before


@pytest.mark.parametrize(("give", "seed"), [(7e-6, 6), (7e-6, 7), (1.5e-5, 8)])
def test_a_frame_that_shifts_tells_more_closely_how_far_feet_sink_in(give: float, seed: int) -> None:
    walker, _ = stood(give=give, seed=seed)
    motions.settle(walker, 4.0)
    motions.lift(walker, DELTA)
    home = walker.frames()[DELTA].copy()
    shift_load(walker)
    unsure = walker.inclination.unsure_give
    assert unsure < 8e-7  # 1e-5 before
    assert abs(walker.inclination.give - give) < 3.0 * unsure
    np.testing.assert_allclose(walker.frames()[DELTA], home, atol=1e-4)
