"""Section 6 of Hoshino and others: what its figures come to."""

import numpy as np
import pytest

from clamber.studies.hoshino_1995.tool_runs import DOFS, GAINS, RUNS, go, random_case
from clamber.studies.library import STUDIES

HOSHINO = STUDIES["hoshino-1995"]
VERDICTS = {"fig-10": "open", "equation-19": "differs"}
OF_THE_MEASURE = {"fig-11": "holds", "section-6-2": "holds"}


def test_figure_10_is_left_open_by_a_speed_that_is_not_printed() -> None:
    numbers = HOSHINO["fig-10"]().numbers
    ends = [numbers[f"{dof} dof: tool off the target at the end [mm]"] for dof in (4, 5, 10)]
    assert max(map(float, ends)) < 0.5  # type: ignore[arg-type]
    apart = {key: value for key, value in numbers.items() if "T_q of z" in key}
    assert list(apart.values()) == sorted(map(float, apart.values()))  # type: ignore[arg-type]
    assert HOSHINO["fig-10"]().verdict == VERDICTS["fig-10"]


def test_the_second_term_as_printed_often_lowers_the_measure() -> None:
    result = HOSHINO["equation-19"]()
    assert result.verdict == VERDICTS["equation-19"]
    assert result.numbers["right form: part of the postures in which V falls, most [-]"] == 0.0
    assert 0.1 < float(result.numbers["as printed: part of the postures in which V falls, most [-]"] or 0.0) < 0.6


@pytest.mark.parametrize("seed", range(3))
def test_means_grow_with_the_gain_and_with_the_freedoms(seed: int) -> None:
    start, way = random_case(seed)
    means = np.array([[go(dof, gain, start=start, way=way).measure.mean() for gain in GAINS] for dof in DOFS])
    assert (np.diff(means, axis=0) > 0.0).all()
    assert (np.diff(means, axis=1) > 0.0).all()


def test_a_random_case_is_the_same_each_time_and_ends_in_reach() -> None:
    for seed in range(5):
        start, way = random_case(seed)
        again, way_again = random_case(seed)
        np.testing.assert_array_equal(start, again)
        np.testing.assert_array_equal(way, way_again)
        assert go(4, 0.0, start=start, way=way, feedback=2.0).off_end < 1e-3


@pytest.mark.long
@pytest.mark.parametrize("name", OF_THE_MEASURE)
def test_the_claims_about_the_measure_hold_on_every_random_way(name: str) -> None:
    result = HOSHINO[name]()
    assert result.verdict == OF_THE_MEASURE[name]
    words = (
        "random ways of 60 on which the mean V grows from 0" if name == "fig-11" else "ways of 60 with a larger mean V"
    )
    counts = [value for key, value in result.numbers.items() if words in key]
    assert len(counts) in (4, 12)
    assert counts == [RUNS] * len(counts)
