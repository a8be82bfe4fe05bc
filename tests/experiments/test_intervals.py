"""Wilson's interval against values printed for it, and at its ends."""

import pytest

from clamber.trials.trial_runs import wilson_interval


@pytest.mark.parametrize(
    ("hits", "n", "low", "high"),
    [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0.0, 0.1611), (1, 29, 0.0061, 0.1718)],
)  # Newcombe (1998), Statistics in Medicine 17, Table I, method 3
def test_it_is_the_printed_one(hits: int, n: int, low: float, high: float) -> None:
    assert wilson_interval(hits, n) == pytest.approx((low, high), abs=5e-5)


@pytest.mark.parametrize("n", [1, 24, 300, 1000])
def test_its_ends_are_where_the_score_test_just_rejects(n: int) -> None:
    for hits in {0, 1, n // 2, n - 1, n}:
        low, high = wilson_interval(hits, n, z=2.0)
        for end in (low, high):
            if 0.0 < end < 1.0:
                assert abs(hits - n * end) == pytest.approx(2.0 * (n * end * (1.0 - end)) ** 0.5)
        mirrored = wilson_interval(n - hits, n, z=2.0)
        assert (low, high) == pytest.approx((1.0 - mirrored[1], 1.0 - mirrored[0]))


def test_nothing_seen_tells_nothing_and_all_seen_ends_at_one() -> None:
    assert wilson_interval(0, 0) == (0.0, 1.0)
    assert wilson_interval(24, 24) == (pytest.approx(24 / (24 + 1.959963984540054**2)), 1.0)
