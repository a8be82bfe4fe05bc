"""Encoders and motors: counts, speed by difference, delay of whole samples, hold, torque limits and torque-speed lines."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from clamber.limb_bench.bench_limb import bench_limb
from clamber.sim.bench_limb import BenchLimb
from clamber.sim.electronics import limit_torques
from clamber.sim.limb_electronics import LimbElectronics
from clamber.sim.limb_flaws import LimbFlaws
from clamber.sim.plant_rules import PlantError
from clamber.sim.plants import PLANTS


@pytest.fixture(scope="module")
def leg() -> BenchLimb:
    return bench_limb()


def read(
    electronics: LimbElectronics, angles: list[float], speeds: tuple[float, float] = (0.0, 0.0)
) -> list[np.ndarray]:
    out = []
    for angle in angles:
        electronics.read(np.array([[angle, -angle]]), np.array([speeds]))
        out.append(electronics.states[0].copy())
    return out


@given(st.floats(-3.0, 3.0))
def test_an_encoder_tells_the_nearest_count_of_its_motor_turn(leg: BenchLimb, angle: float) -> None:
    electronics = LimbElectronics(leg.chain, LimbFlaws(encoder_counts=400), leg.gears, 1)
    (state,) = read(electronics, [angle])
    counts = state[0] * 400 * leg.gears / math.tau
    np.testing.assert_allclose(counts, np.round(counts), atol=1e-6)
    assert np.all(np.abs(state[0] - (angle, -angle)) <= 0.5 * math.tau / (400 * leg.gears) * (1 + 1e-9))


def test_a_count_of_a_geared_motor_is_smaller_by_the_gear(leg: BenchLimb) -> None:
    electronics = LimbElectronics(leg.chain, LimbFlaws(encoder_counts=400), leg.gears, 1)
    seen = np.unique([state[0, 0] for state in read(electronics, list(np.linspace(0.0, 1e-3, 2000)))])
    np.testing.assert_allclose(np.diff(seen), math.tau / (400 * 574), rtol=1e-9)


def test_without_a_speed_sensor_the_speed_is_the_difference_of_counts(leg: BenchLimb) -> None:
    flaws = LimbFlaws(encoder_counts=400)
    electronics = LimbElectronics(leg.chain, flaws, leg.gears, 1)
    angles = list(np.cumsum(np.random.default_rng(0).uniform(-0.01, 0.01, 50)))
    states = read(electronics, angles, speeds=(99.0, 99.0))
    assert not states[0][1].any(), "the first reading has nothing to compare with"
    for before, after in pairwise(states):
        np.testing.assert_allclose(after[1], (after[0] - before[0]) / flaws.period, atol=1e-9)


def test_a_perfect_encoder_tells_angle_and_speed_as_they_are(leg: BenchLimb) -> None:
    (state,) = read(LimbElectronics(leg.chain, LimbFlaws(), leg.gears, 1), [0.123456789], speeds=(0.5, -0.25))
    assert state.tolist() == [[0.123456789, -0.123456789], [0.5, -0.25]]


@pytest.mark.parametrize("delay", [0, 1, 2, 5])
@pytest.mark.parametrize("counts", [0, 400])
def test_a_reading_is_late_by_whole_samples(leg: BenchLimb, delay: int, counts: int) -> None:
    angles = list(np.random.default_rng(1).uniform(-1.0, 1.0, 20))
    now, late = (
        read(LimbElectronics(leg.chain, LimbFlaws(encoder_counts=counts, delay=k), leg.gears, 1), angles)
        for k in (0, delay)
    )
    for k in range(20):
        assert np.array_equal(late[k], now[max(0, k - delay)]), "until the first is through, it is the first"


@pytest.mark.parametrize("name", PLANTS)
@pytest.mark.parametrize("delay", [0, 3])
def test_a_plant_senses_what_was_true_so_many_samples_ago(name: str, delay: int, leg: BenchLimb) -> None:
    plant = PLANTS[name](leg.chain, LimbFlaws(delay=delay), gears=leg.gears)
    plant.reset(leg.q0)
    true = []
    for k in range(30):
        true.append(plant.truth().states.copy())
        assert np.array_equal(plant.sense().states, true[max(0, k - delay)])
        plant.actuate(np.array([[3.0 * math.sin(k), 2.0]]))
        plant.step()


@given(st.floats(-60.0, 60.0), st.floats(-5.0, 5.0))
def test_a_motor_gives_no_more_than_its_limit_and_its_line(wanted: float, speed: float) -> None:
    limit, no_load = 21.0, 3.0
    out = np.zeros((1, 1))
    args = (np.array([limit]), np.array([no_load]), np.array([100.0]), 0.0, out, np.zeros((1, 1)))
    limit_torques(np.array([[wanted]]), np.array([[speed]]), *args)
    given_torque = out[0, 0]
    assert abs(given_torque) <= limit
    assert given_torque <= max(-limit, limit * (1.0 - speed / no_load)) + 1e-12
    assert given_torque >= min(limit, -limit * (1.0 + speed / no_load)) - 1e-12
    limit_torques(np.array([[-wanted]]), np.array([[-speed]]), *args)
    assert out[0, 0] == -given_torque


@given(st.floats(-60.0, 60.0), st.floats(-4.0, 4.0), st.floats(0.0, 0.01), st.floats(-1.0, 1.0))
def test_a_torque_that_may_be_held_is_right_at_every_speed_within_reach(
    wanted: float, speed: float, time: float, part: float
) -> None:
    now, then = np.zeros((1, 1)), np.zeros((1, 1))
    motor = (np.array([21.0]), np.array([3.0]), np.array([100.0]))
    if limit_torques(np.array([[wanted]]), np.array([[speed]]), *motor, time, now, np.zeros((1, 1))):
        limit_torques(
            np.array([[wanted]]), np.array([[speed + part * 100.0 * time]]), *motor, 0.0, then, np.zeros((1, 1))
        )
        assert now[0, 0] == then[0, 0]


@pytest.mark.parametrize("name", PLANTS)
@pytest.mark.parametrize("rate", [20.0, 200.0])
def test_a_held_torque_never_leaves_the_motors_line(name: str, rate: float, leg: BenchLimb) -> None:
    """At a slow control rate a joint runs up to speed within one tick; the same torques asked for step by step tell what is allowed."""
    slow = PLANTS[name](leg.chain, LimbFlaws(control_rate=rate))
    fast = PLANTS[name](leg.chain, LimbFlaws(control_rate=2000.0))
    slow.reset(leg.q0)
    fast.reset(leg.q0)
    joints = leg.chain.joints
    limited = False
    for torque in np.random.default_rng(2).uniform(-40.0, 40.0, (20, 1, 2)):
        slow.actuate(torque)
        slow.step()
        fast.actuate(torque)
        given = []
        for _ in range(slow.flaws.steps):  # type: ignore[attr-defined]
            speed = fast.truth().states[0, 1].copy()
            fast.step()
            line = joints["limit"] * (1.0 - np.abs(speed) / joints["speed"])
            given_torque = fast.truth().torques[0].copy()
            given.append(given_torque)
            driving = given_torque * speed > 0.0
            assert np.all(np.abs(given_torque) <= joints["limit"])
            assert np.all(np.abs(given_torque[driving]) <= np.maximum(line[driving], 0.0) + 1e-9)
            limited = limited or bool(
                np.any(np.abs(given_torque) < np.minimum(np.abs(torque[0]), joints["limit"]) - 1e-9)
            )
        assert np.array_equal(slow.truth().states, fast.truth().states)
        np.testing.assert_allclose(slow.truth().torques[0], np.mean(given, axis=0), rtol=1e-12)
    assert limited, "the line was never reached: nothing was tried"


@pytest.mark.parametrize("name", PLANTS)
@pytest.mark.parametrize("rate", [25.0, 100.0, 500.0])
def test_a_torque_is_held_until_the_next_tick_at_any_control_rate(name: str, rate: float, leg: BenchLimb) -> None:
    """One tick of a slow control is many ticks of a fast one with the same torque, to the last bit."""
    torques = np.random.default_rng(4).uniform(-5.0, 5.0, (10, 1, 2))
    ends = []
    for control in (rate, 2000.0):
        plant = PLANTS[name](leg.chain, LimbFlaws(control_rate=control, motor_limits=False))
        plant.reset(leg.q0)
        for torque in torques:
            plant.actuate(torque)
            for _ in range(round(control / rate)):
                plant.step()
        ends.append(plant.truth().states.copy())
    assert np.array_equal(ends[0], ends[1])


@pytest.mark.parametrize("name", PLANTS)
@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_a_torque_that_is_no_number_is_refused_by_name(name: str, value: float, leg: BenchLimb) -> None:
    plant = PLANTS[name](leg.chain, LimbFlaws(), batch=3)
    plant.reset(leg.q0)
    torques = np.zeros((3, 2))
    torques[1, 1] = value
    with pytest.raises(PlantError, match=f"torque of the right elbow, limb 1 of the batch = {value}: must be a finite"):
        plant.actuate(torques)
