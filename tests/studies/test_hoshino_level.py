"""Hoshino 1995, sections 4 and 5: the upper surface inclined by its legs, and kept level on a slope."""

import math

import numpy as np
import pytest

from clamber.families.walker.control.posture import slope_of
from clamber.studies.hoshino_1995.levelling import ANGLE, DIRECTIONS, compare_directions, equation_6, incline, steepest
from clamber.studies.library import OF_LEVELLING, STUDIES
from clamber.units import DEGREE

VERDICTS = {"fig-7": "holds", "fig-8": "holds", "fig-9": "holds"}


@pytest.mark.parametrize(("beta", "gamma"), [(0.1, 0.2), (-0.3, 0.05), (0.02, -0.4), (-0.2, -0.2)])
def test_the_search_for_the_steepest_direction_agrees_with_the_plates_normal(beta: float, gamma: float) -> None:
    """Uphill is against the level part of the normal R z, and the angle is the normal's from the vertical; alpha is 0."""
    normal = np.array((math.sin(beta) * math.cos(gamma), -math.sin(gamma), math.cos(beta) * math.cos(gamma)))
    eta, xi = steepest(beta, gamma)
    assert math.remainder(eta - math.atan2(-normal[1], -normal[0]), math.tau) == pytest.approx(0.0, abs=1e-7)
    assert xi == pytest.approx(math.acos(normal[2]), abs=1e-12)
    assert slope_of(beta, gamma)[1] == pytest.approx(xi, abs=1e-12)


def test_equation_6_gives_the_line_and_half_the_time_the_wrong_way_along_it() -> None:
    result = compare_directions()
    assert result.verdict == VERDICTS["fig-9"]
    assert result.numbers["equation 6 by arctan: part of the tilts in which it points downhill [-]"] == 0.5
    assert equation_6(-0.1, 0.05) == pytest.approx(slope_of(-0.1, 0.05)[0])
    assert abs(equation_6(0.1, 0.05) - slope_of(0.1, 0.05)[0]) == pytest.approx(math.pi)


@pytest.mark.slow
@pytest.mark.parametrize("legs", [3, 6])
def test_the_plate_is_inclined_to_a_tenth_of_a_degree_and_all_legs_end_together(legs: int) -> None:
    run = incline(legs)  # type: ignore[arg-type]
    assert len(run.begins) == len(DIRECTIONS) + 1
    for errors in (run.read_errors(), run.true_errors()):
        assert errors.max() < 0.1 * DEGREE
    assert run.uneven() < 0.03  # motors step by 0.1 mm
    wanted = run.wanted[np.searchsorted(run.trace.time, run.ends) - 1]
    angles = np.arccos(np.sqrt(1.0 - (np.sin(wanted) ** 2).sum(axis=1))) / DEGREE
    np.testing.assert_allclose(angles, [*[ANGLE] * len(DIRECTIONS), 0.0], atol=1e-9)


@pytest.mark.long
def test_results_on_levelling_keep_their_verdicts() -> None:
    results = {name: repeat() for name, repeat in OF_LEVELLING.items()}
    assert set(results) <= set(STUDIES["hoshino-1995"])
    assert {name: result.verdict for name, result in results.items()} == VERDICTS
    numbers = results["fig-8"].numbers
    for way in ("up", "across", "down"):
        level = float(numbers[f"{way}: least margin of balance [mm]"] or 0.0)
        assert float(numbers[f"{way}, not levelled: least margin of balance [mm]"] or 0.0) < level
