"""Sensors of force: what they say at rest, their sign, noise, offset, lag and delay."""

import math

import numpy as np
import pytest

from clamber.limb_bench.bench_limb import bench_limb
from clamber.sim.bench_limb import BenchLimb
from clamber.sim.force_sensing import WrenchReader
from clamber.sim.limb_flaws import ForceSensor, LimbFlaws, Push, Wall
from clamber.sim.mujoco_limb import MujocoLimb
from clamber.sim.plant_rules import PlantError


@pytest.fixture(scope="module")
def leg() -> BenchLimb:
    return bench_limb()


def pressed(leg: BenchLimb, angle: float, batch: int = 1) -> MujocoLimb:
    """A limb that has come to rest against a wall with 15 N and every sensor."""
    into = np.array((math.cos(angle), math.sin(angle)))
    wall = Wall(x=leg.start[0], y=leg.start[1], angle=angle)
    flaws = LimbFlaws(wall=wall, friction=0.0, wrist=ForceSensor(), base=ForceSensor())
    plant = MujocoLimb(leg.chain, flaws, batch=batch, threads=1)
    plant.reset(leg.q0)
    for _ in range(400):
        torques = []
        for q, qd in plant.sense().states:
            jacobian = leg.chain.jacobian(q)[:2]
            off = np.array(leg.start) - leg.chain.place(q)[:2]
            hold = 3000.0 * (off - into * (into @ off)) - 400.0 * jacobian @ qd
            torques.append(jacobian.T @ (15.0 * into + hold))
        plant.actuate(np.array(torques))
        plant.step()
    return plant


@pytest.mark.parametrize("angle", [0.0, 0.5, math.pi / 2, -2.0])
def test_wrist_and_base_feel_the_true_force_at_rest(angle: float, leg: BenchLimb) -> None:
    plant = pressed(leg, angle)
    true, sensed = plant.truth().wrenches[0], plant.sense()
    np.testing.assert_allclose(true[:2], 15.0 * np.array((math.cos(angle), math.sin(angle))), atol=0.02)
    np.testing.assert_allclose(sensed.wrenches[0], true, atol=1e-6)
    # the mount holds the limb: force and moment on it are against those on the wall
    tip = leg.chain.place(plant.truth().states[0, 0])
    np.testing.assert_allclose(sensed.mounts[0, :3], -true[:3], atol=0.01)
    np.testing.assert_allclose(sensed.mounts[0, 3:], -np.cross(tip, true[:3]), atol=0.01)


def test_a_batch_feels_what_one_limb_feels(leg: BenchLimb) -> None:
    one, three = pressed(leg, 0.5), pressed(leg, 0.5, batch=3)
    for name in ("wrenches", "mounts"):
        np.testing.assert_allclose(getattr(three.sense(), name), np.tile(getattr(one.sense(), name), (3, 1)), atol=1e-9)


def test_a_push_on_the_tip_is_felt_as_its_opposite(leg: BenchLimb) -> None:
    flaws = LimbFlaws(push=Push(x=0.1, y=-0.2, start=0.0, end=1.0, rise=0.0), wrist=ForceSensor())
    plant = MujocoLimb(leg.chain, flaws)
    plant.reset(leg.q0)
    for _ in range(3):
        plant.actuate(np.zeros((1, 2)))
        plant.step()
    np.testing.assert_allclose(plant.truth().wrenches[0, :2], (-0.1, 0.2), atol=1e-6)
    np.testing.assert_allclose(plant.sense().wrenches[0, :2], (-0.1, 0.2), atol=1e-6)


def test_a_wrist_and_a_mount_change_nothing_about_the_motion(leg: BenchLimb) -> None:
    places = []
    for sensors in ({}, {"wrist": ForceSensor(), "base": ForceSensor()}):
        plant = MujocoLimb(leg.chain, LimbFlaws(**sensors))
        plant.reset(leg.q0)
        for _ in range(50):
            plant.actuate(np.array([[2.0, -1.0]]))
            plant.step()
        places.append(plant.truth().states.copy())
    np.testing.assert_allclose(places[0], places[1], atol=1e-9)


def test_a_push_moves_a_limb_with_a_wrist_sensor_as_it_moves_one_without(leg: BenchLimb) -> None:
    push = Push(x=4.0, y=-3.0, start=0.0, end=1.0, rise=0.0)
    places = []
    for sensors in ({}, {"wrist": ForceSensor(), "base": ForceSensor()}):
        plant = MujocoLimb(leg.chain, LimbFlaws(push=push, friction=0.0, physics_rate=20_000.0, **sensors))
        plant.reset(leg.q0)
        for _ in range(20):
            plant.actuate(np.zeros((1, 2)))
            plant.step()
        places.append(plant.truth().states.copy())
    assert abs(places[0][0, 1]).max() > 0.1
    # at the tip MuJoCo turns the push with the arm every physics step, at the last link's centre only every tick
    np.testing.assert_allclose(places[0], places[1], rtol=5e-3)


def reader(delay: int = 0, **changes: float) -> WrenchReader:
    return WrenchReader(ForceSensor(**changes), period=0.005, delay=delay, batch=1)


def test_noise_has_its_spread_and_its_seed() -> None:
    sensor, again = reader(noise=0.5, moment_noise=0.1, seed=3), reader(noise=0.5, moment_noise=0.1, seed=3)
    read = np.array([sensor.read(np.zeros((1, 6)), k)[0].copy() for k in range(4000)])
    same = np.array([again.read(np.zeros((1, 6)), k)[0].copy() for k in range(4000)])
    np.testing.assert_array_equal(read, same)
    # the standard error of a spread from 4000 draws is 1.1 %
    np.testing.assert_allclose(read.std(axis=0), (0.5, 0.5, 0.5, 0.1, 0.1, 0.1), rtol=0.05)
    sensor.reset()
    np.testing.assert_array_equal(sensor.read(np.zeros((1, 6)), 0)[0], read[0])


def test_a_bias_is_of_forces_only() -> None:
    np.testing.assert_allclose(reader(bias=0.7).read(np.zeros((1, 6)), 0)[0], (0.7, 0.7, 0.7, 0.0, 0.0, 0.0))


def test_the_low_pass_answers_a_step_as_a_lag_of_first_order() -> None:
    sensor = reader(time_constant=0.03)
    for k in range(40):
        value = sensor.read(np.ones((1, 6)), k)[0, 0]
        assert value == pytest.approx(1.0 - math.exp(-0.005 * (k + 1) / 0.03), abs=1e-12)


@pytest.mark.parametrize("delay", [0, 1, 3])
def test_a_reading_comes_late_by_its_delay(delay: int) -> None:
    sensor = reader(delay=delay)
    read = [float(sensor.read(np.full((1, 6), float(k)), k)[0, 0]) for k in range(10)]
    assert read == [float(max(0, k - delay)) for k in range(10)]


@pytest.mark.parametrize("changes", [{"noise": -1.0}, {"time_constant": math.inf}, {"bias": math.nan}, {"seed": -1}])
def test_a_sensor_that_cannot_be_is_refused_by_name(changes: dict[str, float]) -> None:
    with pytest.raises(PlantError, match=rf"sensor\.{next(iter(changes))}"):
        ForceSensor(**changes)
