"""The filter of inclinometers and legs: how well it levels, what it leaves out, what it learns."""

import math

import numpy as np
import pytest

from clamber.families.walker.control.inclination import Inclination, InclinometerTrust
from clamber.families.walker.control.posture import inclines_of_tilt, tilt_of_inclines
from clamber.types import Floats

PERIOD = 0.02
DEGREE = math.pi / 180


class Readings:
    """Two inclinometers with filtered noise, as a sensor's first-order low-pass leaves it."""

    def __init__(self, seed: int, noise: float = 0.05 * DEGREE, late: float = 0.2) -> None:
        self.random, self.noise, self.share = np.random.default_rng(seed), noise, PERIOD / late
        self.wander = noise * self.random.standard_normal(2)
        self.seen: Floats | None = None

    def read(self, inclines: Floats) -> Floats:
        self.seen = inclines.copy() if self.seen is None else self.seen + self.share * (inclines - self.seen)
        kick = self.noise * math.sqrt(2 * self.share - self.share**2)
        self.wander = (1 - self.share) * self.wander + kick * self.random.standard_normal(2)
        return self.seen + self.wander


@pytest.mark.slow
def test_a_tilt_that_the_legs_do_not_tell_is_found_as_well_as_the_filter_says() -> None:
    errors, said = [], 0.0
    for seed in range(60):
        inclination, sensor = Inclination(InclinometerTrust(), PERIOD), Readings(seed)
        true = np.array((0.08, -0.05)) * DEGREE
        believed = np.zeros(2)  # inclines
        for _ in range(round(9.0 / PERIOD)):
            turn = inclination.see(sensor.read(true), *tilt_of_inclines(*believed))
            tilt = np.array(tilt_of_inclines(*believed)) + turn
            believed = np.array(inclines_of_tilt(*tilt))
        errors.append(believed - true)
        said = inclination.unsure
    spread = float(np.sqrt(np.mean(np.square(errors))))
    assert spread < 0.03 * DEGREE
    assert spread == pytest.approx(said, rel=0.4)  # neither boastful nor shy: 120 samples of one deviation


def test_a_moving_plate_is_not_taken_for_late_inclinometers() -> None:
    """The legs tell all of the motion; the readings lag by 0.2 s, which at this speed is 0.16 deg."""
    inclination, sensor = Inclination(InclinometerTrust(noise=1e-6, drift=1e-5), PERIOD), Readings(0, noise=0.0)
    tilt = np.array((0.1, 0.0))
    worst = 0.0
    for _ in range(round(9.0 / PERIOD)):
        tilt[0] -= 0.014 * PERIOD
        turn = inclination.see(sensor.read(np.array(inclines_of_tilt(*tilt))), *tilt)
        worst = max(worst, abs(turn[0]))
    assert worst < 0.002 * DEGREE


def test_frozen_readings_change_nothing_and_doubt_makes_the_next_ones_count() -> None:
    inclination = Inclination(InclinometerTrust(), PERIOD)
    inclination.see(np.zeros(2), 0.0, 0.0)
    inclination.frozen = True
    assert inclination.see(np.full(2, 0.1), 0.0, 0.0) == (0.0, 0.0)
    inclination.frozen = False
    small = abs(inclination.see(np.full(2, 0.01), 0.0, 0.0)[0])
    other = Inclination(InclinometerTrust(), PERIOD)
    other.see(np.zeros(2), 0.0, 0.0)
    other.doubt(1.0 * DEGREE)
    assert abs(other.see(np.full(2, 0.01), 0.0, 0.0)[0]) > 5.0 * small


@pytest.mark.parametrize("give", [0.0, 7e-6, 2e-5])
def test_how_far_feet_sink_in_is_learned_from_loads_that_shift(give: float) -> None:
    inclination, sensor = Inclination(InclinometerTrust(), PERIOD), Readings(3)
    inclination.learns = True
    true, believed, slope = np.zeros(2), np.zeros(2), np.zeros(2)
    for k in range(round(60.0 / PERIOD)):
        now = 200.0 * np.array((math.sin(0.3 * k * PERIOD), math.cos(0.2 * k * PERIOD) - 1.0))  # [N/m]
        change, slope = now - slope, now
        true -= give * change
        believed -= inclination.give * change
        inclination.sink(-change)
        turn = inclination.see(sensor.read(true), *tilt_of_inclines(*believed))
        believed = np.array(inclines_of_tilt(*(np.array(tilt_of_inclines(*believed)) + turn)))
    assert inclination.give == pytest.approx(give, abs=1.5e-6)
    assert np.abs(believed - true).max() < 0.05 * DEGREE


def test_a_foot_that_slips_off_something_is_believed_within_seconds_even_by_a_sure_filter() -> None:
    def error_after(seconds: float, trust: InclinometerTrust) -> float:
        inclination, sensor, believed = Inclination(trust, PERIOD), Readings(1), np.zeros(2)
        for k in range(round((60.0 + seconds) / PERIOD)):
            true = np.array((0.5, 0.0)) * DEGREE * (k * PERIOD > 60.0)
            turn = inclination.see(sensor.read(true), *tilt_of_inclines(*believed))
            believed = np.array(inclines_of_tilt(*(np.array(tilt_of_inclines(*believed)) + turn)))
        return float(np.abs(believed - true).max())

    assert error_after(2.0, InclinometerTrust()) < 0.1 * DEGREE
    assert error_after(2.0, InclinometerTrust(surprise=1e6)) > 0.2 * DEGREE


@pytest.mark.parametrize(
    "key", ["noise", "time_constant", "drift", "start", "give", "give_doubt", "give_drift", "surprise"]
)
def test_trust_that_is_negative_or_endless_is_refused(key: str) -> None:
    for value in (-1.0, math.inf, math.nan):
        with pytest.raises(ValueError, match=key):
            InclinometerTrust(**{key: value})
