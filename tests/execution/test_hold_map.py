"""What hooks on their holds teach about the holds' places, the body's encoder and the joints' play."""

import numpy as np
import pytest

from clamber.families.climber.execution.hold_map import TIP_ERROR, HoldMap, TipDifference
from clamber.types import Floats

ERROR = 0.00635
KNOWN = 0.001
"""Standard deviation of a place that somebody has measured, along each axis [m]."""


def know(holds: HoldMap, *rows: int) -> None:
    """Count places as measured, by their order."""
    for k in rows:
        for axis in (2 * k, 2 * k + 1):
            holds._variance[axis, axis] = KNOWN**2


def drawn(rng: np.random.Generator) -> tuple[dict[int, Floats], dict[int, Floats]]:
    believed = {n: np.array((0.4572 * (n % 2), 0.1524 * (n // 2))) for n in range(8)}
    true = {n: place + rng.uniform(-ERROR, ERROR, 2) for n, place in believed.items()}
    return believed, true


def seen(place: Floats, by_angle: Floats | None = None, by_play: Floats | None = None) -> TipDifference:
    """A difference by exact sensors, or by such as are off."""
    none = np.zeros(2)
    return TipDifference(
        place,
        none if by_angle is None else by_angle,
        none if by_play is None else by_play,
        np.zeros((2, 4)),
        np.zeros(4),
    )


def loose(place: Floats, by_joints: Floats, error: float) -> TipDifference:
    """A difference by a joint that may be anywhere in its play, and three that are sure."""
    slopes = np.zeros((2, 4))
    slopes[:, 0] = by_joints
    return TipDifference(place, np.zeros(2), np.zeros(2), slopes, np.array((error, 0.0, 0.0, 0.0)))


def test_a_hold_gripped_beside_a_known_one_is_as_sure_as_the_measurement() -> None:
    believed, true = drawn(np.random.default_rng(1))
    holds = HoldMap(believed, ERROR)
    believed[0] = true[0].copy()
    know(holds, 0)
    holds.learn(1, 0, seen(true[1] - true[0]))
    prior = ERROR**2 / 3
    gain = prior / (prior + KNOWN**2 + TIP_ERROR**2)  # of a scalar filter
    before = np.array((0.4572, 0.0))
    np.testing.assert_allclose(believed[1] - before, gain * (true[1] - before), rtol=1e-9)
    assert holds.error(1) < 0.7 * ERROR
    assert holds.error(2) == pytest.approx(ERROR)


def test_what_is_learned_of_a_chain_of_holds_halves_their_error_on_average() -> None:
    before, after = [], []
    for seed in range(40):
        rng = np.random.default_rng(seed)
        believed, true = drawn(rng)
        before += [np.hypot(*(believed[n] - true[n])) for n in believed]
        holds = HoldMap(believed, ERROR)
        believed[0] = true[0].copy()
        know(holds, 0)
        for n in range(1, 8):
            holds.learn(n, n - 1, seen(true[n] - true[n - 1] + rng.normal(0.0, TIP_ERROR, 2)))
        after += [np.hypot(*(believed[n] - true[n])) for n in believed]
    assert np.mean(after) < 0.5 * np.mean(before)


def test_a_measurement_that_agrees_changes_no_place() -> None:
    believed, _ = drawn(np.random.default_rng(2))
    places = {n: place.copy() for n, place in believed.items()}
    holds = HoldMap(believed, ERROR)
    holds.learn(3, 2, seen(believed[3] - believed[2]))
    holds.learn(3, 5, seen(believed[3] - believed[5]))
    for n, place in places.items():
        np.testing.assert_allclose(believed[n], place, atol=1e-12)


def test_two_known_holds_tell_the_offset_of_the_bodys_encoder() -> None:
    believed, _ = drawn(np.random.default_rng(3))
    holds = HoldMap(believed, ERROR)
    know(holds, 0, 1)
    true = np.radians(0.4)
    span = believed[1] - believed[0]
    for _ in range(20):
        left = true - holds.offset  # the line between the tips is seen turned by what the offset is still off
        place = np.array(
            (span[0] * np.cos(left) - span[1] * np.sin(left), span[0] * np.sin(left) + span[1] * np.cos(left))
        )
        holds.learn(1, 0, seen(place, np.array((place[1], -place[0]))))
    width = float(np.hypot(*span))
    assert holds.offset == pytest.approx(true, abs=3 * np.sqrt(2) * KNOWN / width)
    assert holds.offset > 0.5 * true


def test_the_backlash_is_learned_from_tips_that_rest_on_known_sides() -> None:
    believed, _ = drawn(np.random.default_rng(4))
    holds = HoldMap(believed, ERROR, backlash=np.radians(1.6))
    know(holds, 0, 1)
    true, slope = np.radians(1.0), np.array((0.3, 0.1))
    for _ in range(20):
        place = believed[1] - believed[0] - slope * (true - holds.half_play)
        holds.learn(1, 0, seen(place, by_play=slope))
    assert holds.half_play == pytest.approx(true, abs=np.radians(0.1))


def test_a_hook_that_was_not_home_is_learned_anew_when_it_has_slid_in() -> None:
    believed, true = drawn(np.random.default_rng(5))
    holds = HoldMap(believed, ERROR)
    believed[0] = true[0].copy()
    know(holds, 0)
    for _ in range(5):
        holds.learn(1, 0, seen(true[1] - true[0] + np.array((0.0, 0.011))))
    holds.learn(1, 0, seen(true[1] - true[0]))
    np.testing.assert_allclose(believed[1], true[1], atol=0.0025)


def test_a_joint_that_rests_on_no_side_leaves_its_hold_in_doubt() -> None:
    believed, true = drawn(np.random.default_rng(6))
    holds = HoldMap(believed, ERROR)
    know(holds, 0)
    unsure = loose(true[1] - true[0], np.array((0.25, 0.0)), 0.02)  # 5 mm along x
    sure = holds.doubt(1, 0, seen(true[1] - true[0]))
    assert holds.doubt(1, 0, unsure) == pytest.approx(np.sqrt(sure**2 + 3 * 0.005**2))
    x_before, y_before = believed[1].copy()
    holds.learn(1, 0, unsure)
    assert abs(believed[1][0] - x_before) < 0.4 * abs(true[1][0] - true[0][0] + believed[0][0] - x_before)
    assert abs(believed[1][1] - y_before) > 0.7 * abs(true[1][1] - true[0][1] + believed[0][1] - y_before)


def test_two_known_holds_tell_where_in_its_play_a_loose_joint_is() -> None:
    believed, _ = drawn(np.random.default_rng(7))
    places = {n: place.copy() for n, place in believed.items()}
    holds = HoldMap(believed, ERROR)
    know(holds, 0, 1)
    slope, off = np.array((0.1, 0.28)), np.radians(1.3)
    tip = (
        believed[1] - believed[0] - slope * off
    )  # the joint is farther on than believed, so its tip seems short of the hold
    more = holds.learn(1, 0, loose(tip, slope, np.radians(1.2)))
    np.testing.assert_array_equal(more[1:], 0.0)
    assert more[0] == pytest.approx(off, rel=0.1)
    for n, place in places.items():
        np.testing.assert_allclose(believed[n], place, atol=5e-4)
