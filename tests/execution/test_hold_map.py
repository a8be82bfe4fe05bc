"""What hooks on their holds teach about the holds' places."""

import numpy as np
import pytest

from clamber.execution.climb.hold_map import KNOWN, TIP_ERROR, HoldMap
from clamber.types import Floats

ERROR = 0.00635


def drawn(rng: np.random.Generator) -> tuple[dict[int, Floats], dict[int, Floats]]:
    believed = {n: np.array((0.4572 * (n % 2), 0.1524 * (n // 2))) for n in range(8)}
    true = {n: place + rng.uniform(-ERROR, ERROR, 2) for n, place in believed.items()}
    return believed, true


def test_a_hold_gripped_beside_a_known_one_is_as_sure_as_the_measurement() -> None:
    believed, true = drawn(np.random.default_rng(1))
    holds = HoldMap(believed, ERROR)
    believed[0] = true[0].copy()
    holds.know([0])
    holds.learn(1, {0: true[1] - true[0]})
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
        holds.know([0])
        for n in range(1, 8):
            holds.learn(n, {n - 1: true[n] - true[n - 1] + rng.normal(0.0, TIP_ERROR, 2)})
        after += [np.hypot(*(believed[n] - true[n])) for n in believed]
    assert np.mean(after) < 0.5 * np.mean(before)


def test_a_measurement_that_agrees_changes_no_place() -> None:
    believed, _ = drawn(np.random.default_rng(2))
    places = {n: place.copy() for n, place in believed.items()}
    holds = HoldMap(believed, ERROR)
    holds.learn(3, {2: believed[3] - believed[2], 5: believed[3] - believed[5]})
    for n, place in places.items():
        np.testing.assert_allclose(believed[n], place, atol=1e-12)
