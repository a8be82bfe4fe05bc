"""When a walker's sensors tell of a fall, and when they do not."""

import numpy as np
import pytest

from clamber.families.walker.execution.falls import FallWatch
from clamber.types import Floats

PERIOD = 0.02
WEIGHT = 800.0
TRIPOD = np.array((260.0, 270.0, 270.0, 0.0, 0.0, 0.0))
TWO = np.array((400.0, 0.0, 400.0, 0.0, 0.0, 0.0))


def told_after(
    forces: Floats, *, tilted: float = 0.0, margin: float = 0.05, noise: float = 2.0, seed: int = 0
) -> float:
    """For how long a robot is as it is here, after it stood well, until a fall is told [s]; 3 s: it is not."""
    watch, rng = FallWatch(WEIGHT, PERIOD), np.random.default_rng(seed)
    for _ in range(50):
        assert not watch.see(TRIPOD + noise * rng.standard_normal(6), 0.0, lambda: 0.05)
    for k in range(150):
        if watch.see(forces + noise * rng.standard_normal(6), tilted, lambda: margin):
            return (k + 1) * PERIOD
    return 3.0


def test_a_robot_that_stands_well_does_not_fall() -> None:
    assert told_after(TRIPOD) == 3.0
    assert told_after(TRIPOD, margin=-0.01) == 3.0  # what the feet feel counts, not what is reckoned


@pytest.mark.parametrize("seed", range(10))
def test_a_centre_of_mass_at_the_edge_over_two_feet_is_a_fall_though_load_cells_are_noisy(seed: int) -> None:
    nearly = np.array((396.0, 8.0, 396.0, 0.0, 0.0, 0.0))  # the third foot still carries a hundredth of the weight
    assert told_after(nearly, margin=0.002, seed=seed) == 3.0
    # from 270 N the average takes 0.4 s to forget; a foot that empties slowly, as before a fall, is told sooner
    assert told_after(TWO, margin=0.002, seed=seed) < 0.7


def test_two_feet_that_carry_all_for_a_moment_are_no_fall_while_the_centre_of_mass_is_well_inside() -> None:
    assert told_after(TWO, margin=0.05) > 0.9
    assert told_after(TWO, margin=0.05) < 1.3


def test_feet_that_carry_nothing_and_a_plate_that_tilts_are_falls() -> None:
    assert told_after(np.zeros(6)) < 0.5
    assert told_after(TRIPOD, tilted=0.2) < 0.5
