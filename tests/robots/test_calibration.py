"""Sizes of the mechanism from what is printed of it."""

import math

import numpy as np
import pytest

from clamber.families.walker.robot.calibration import (
    FAMILIES,
    HOSHINO_1995,
    OURS,
    Published,
    Sizes,
    fit_families,
    fit_family,
    fit_of,
    measure_sizes,
)

DEG = math.pi / 180.0
MM = 1e-3


def test_equal_circles_meet_all_three_printed_numbers_with_two_sizes() -> None:
    """The two angles alone have a closed form, 2 R sin((60 - theta) / 2) = the drawn-in length, or that and the stroke."""
    radius = 0.250 / (2.0 * (math.sin(39 * DEG) - math.sin(6 * DEG)))
    drawn_in = 2.0 * radius * math.sin(6 * DEG)
    by_angles = fit_of(Sizes(radius, 1.0, -60 * DEG, drawn_in))
    assert (by_angles.least / DEG, by_angles.most / DEG) == (pytest.approx(-18, abs=1e-9), pytest.approx(48, abs=1e-9))
    assert round(by_angles.step / MM) == 160  # the third comes out by itself, to the last place printed
    found = fit_family(FAMILIES[0], HOSHINO_1995, 3)
    assert found.misfit < 0.02
    assert found.sizes.radius == pytest.approx(radius, abs=0.1 * MM)
    assert found.sizes.shortest == pytest.approx(drawn_in, abs=0.1 * MM)
    assert abs(found.first) / DEG == pytest.approx(30.0, abs=1e-3)


def test_the_robot_file_rounds_to_what_is_printed() -> None:
    ours = fit_of(Sizes(238.4 * MM, 1.0, -60 * DEG, 50 * MM))
    assert ours.misfit < 0.15
    assert (ours.least / DEG, ours.most / DEG) == (pytest.approx(-17.98, abs=0.005), pytest.approx(47.96, abs=0.005))


@pytest.mark.parametrize("seed", range(5))
def test_sizes_come_back_from_their_own_numbers(seed: int) -> None:
    rng = np.random.default_rng(seed)
    sizes = Sizes(rng.uniform(0.2, 0.3), 1.0, -60 * DEG, rng.uniform(0.04, 0.06))
    least, most, step, _ = measure_sizes(sizes, HOSHINO_1995, OURS)
    published = Published(least=least, most=most, step=step)
    found = min((fit_family(FAMILIES[0], published, k) for k in range(3)), key=lambda fit: fit.misfit)
    assert found.misfit < 1e-4
    assert found.sizes.radius == pytest.approx(sizes.radius, rel=1e-5)


@pytest.mark.slow
def test_rivals_with_more_free_sizes_fit_too_and_other_readings_do_not() -> None:
    rivals = {(one.family.name, one.family.reading): one for one in fit_families(seeds=range(4))}
    ours = rivals["equal circles, neighbouring tips", OURS]
    assert (ours.good, ours.seeds) == (4, 4)
    assert rivals["circles of two sizes, any offset", OURS].good > 0
    others = rivals["circles of two sizes, any offset", OURS].fits
    assert max(fit.sizes.radius for fit in others) > 1.2 * min(fit.sizes.radius for fit in others)
    assert rivals["the same, drawn-in length 0", OURS].good == 0
    for (_, reading), one in rivals.items():
        assert reading == OURS or one.fits[0].misfit > 1.0


def test_equal_seeds_give_equal_fits() -> None:
    assert fit_family(FAMILIES[3], HOSHINO_1995, 2) == fit_family(FAMILIES[3], HOSHINO_1995, 2)
