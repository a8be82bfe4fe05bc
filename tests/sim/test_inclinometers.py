"""Inclinometers against statistics, a filter's closed form, and the specific force that MuJoCo's own accelerometer feels."""

import math

import mujoco
import numpy as np
import pytest
from walker_by_hand import LEVEL, hoshino, legs_with, lengths, standing

from clamber.families.walker.sim.walker_flaws import Inclinometers, WalkerFlaws
from clamber.families.walker.sim.walker_model import walker_spec
from clamber.families.walker.sim.walker_plant import InclinometerPair, plate_quaternion
from clamber.sim.plant_rules import PlantError
from clamber.units import GRAVITY

PERIOD = 0.02


def turn(alpha: float, beta: float, gamma: float) -> np.ndarray:
    """Rz(alpha) Ry(beta) Rx(gamma), factor by factor."""
    (ca, sa), (cb, sb), (cg, sg) = ((math.cos(t), math.sin(t)) for t in (alpha, beta, gamma))
    about_z = np.array(((ca, -sa, 0.0), (sa, ca, 0.0), (0.0, 0.0, 1.0)))
    about_y = np.array(((cb, 0.0, sb), (0.0, 1.0, 0.0), (-sb, 0.0, cb)))
    about_x = np.array(((1.0, 0.0, 0.0), (0.0, cg, -sg), (0.0, sg, cg)))
    return about_z @ about_y @ about_x


@pytest.mark.parametrize("seed", range(5))
def test_at_rest_they_tell_how_far_the_axes_rise(seed: int) -> None:
    alpha, beta, gamma = np.random.default_rng(seed).uniform(-0.3, 0.3, 3)
    pair = InclinometerPair(Inclinometers(offsets=(0.01, -0.02)), PERIOD, None)
    axes, rest = turn(alpha, beta, gamma), np.zeros(3)
    pair.reset(axes, rest)
    for _ in range(50):
        pair.see(axes, rest)
    # x rises as the plate turns down about y, the other way round; y as it turns about x
    wanted = (-beta + 0.01, math.asin(math.cos(beta) * math.sin(gamma)) - 0.02)
    np.testing.assert_allclose(pair.readings, wanted, atol=1e-12)


@pytest.mark.parametrize("time_constant", [0.0, 0.1, 0.5])
def test_noise_has_the_stated_deviation_and_the_filter_s_memory(time_constant: float) -> None:
    noise, n = 1e-3, 40_000
    pair = InclinometerPair(Inclinometers(noise=noise, time_constant=time_constant), PERIOD, 5)
    axes, rest = np.eye(3), np.zeros(3)
    pair.reset(axes, rest)
    readings = np.empty((n, 2))
    for row in readings:
        pair.see(axes, rest)
        row[:] = pair.readings
    keep = math.exp(-PERIOD / time_constant) if time_constant else 0.0
    independent = n * (1.0 - keep) / (1.0 + keep)
    np.testing.assert_allclose(readings.mean(axis=0), 0.0, atol=4.0 * noise / math.sqrt(independent))
    np.testing.assert_allclose(readings.std(axis=0), noise, rtol=4.0 / math.sqrt(independent))
    memory = [np.corrcoef(each[1:], each[:-1])[0, 1] for each in readings.T]
    np.testing.assert_allclose(memory, keep, atol=0.03)
    assert abs(np.corrcoef(readings.T)[0, 1]) < 4.0 / math.sqrt(independent)


def test_a_steady_acceleration_looks_like_a_tilt_after_the_filter_s_time() -> None:
    acceleration = 0.05
    pair = InclinometerPair(Inclinometers(time_constant=0.2), PERIOD, None)
    pair.reset(np.eye(3), np.zeros(3))
    for tick in range(1, 101):
        pair.see(np.eye(3), np.array((acceleration * tick * PERIOD, 0.0, 0.0)))
        part = 1.0 - math.exp(-tick * PERIOD / 0.2)
        assert pair.readings[0] == pytest.approx(part * math.asin(acceleration / GRAVITY), rel=1e-9)
        assert pair.readings[1] == 0.0


def test_the_same_seed_gives_the_same_noise_after_every_reset() -> None:
    pair = InclinometerPair(Inclinometers(noise=1e-3), PERIOD, 7)
    seen = []
    for _ in range(2):
        pair.reset(np.eye(3), np.zeros(3))
        for _ in range(5):
            pair.see(np.eye(3), np.zeros(3))
        seen.append(pair.readings.copy())
    np.testing.assert_array_equal(*seen)


def test_on_the_plate_they_feel_what_an_accelerometer_feels_on_average() -> None:
    """While the standing robot's frame is jerked along: so does the mean of MuJoCo's sensor over the physics steps of a period.

    Those are short here: its sensor tells accelerations as they were before the integrator's implicit damping.
    """
    robot = hoshino()
    sim = standing(lifted=1, flaws=WalkerFlaws(physics_rate=50_000.0, inclinometers=Inclinometers(time_constant=0.0)))
    spec = walker_spec(robot, LEVEL, sim.flaws)
    plate = next(body for body in spec.bodies if body.name == "delta")
    plate.add_site(name="plate")
    spec.add_sensor(type=mujoco.mjtSensor.mjSENS_ACCELEROMETER, objtype=mujoco.mjtObj.mjOBJ_SITE, objname="plate")
    model = spec.compile()
    data, plate_id = mujoco.MjData(model), model.body("delta").id
    aim = lengths(robot, np.array((0.0, 0.02, 0.05)))
    largest = 0.0
    for _ in range(8):
        sim.actuate(aim, legs_with(1), sim.sense().arm)
        size = mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_INTEGRATION)
        state = np.empty(size)
        mujoco.mj_getState(sim.model, sim._data, state, mujoco.mjtState.mjSTATE_INTEGRATION)
        mujoco.mj_setState(model, data, state, mujoco.mjtState.mjSTATE_INTEGRATION)
        sim.step()
        data.ctrl[:] = sim._data.ctrl
        felt = []
        for _ in range(sim.flaws.steps):
            mujoco.mj_step(model, data)
            felt.append(data.sensordata[:2].copy())
        readings = sim.sense().inclines
        # the posture is that at the period's end
        np.testing.assert_allclose(readings, np.arcsin(np.mean(felt, axis=0) / GRAVITY), rtol=0.04, atol=5e-5)
        slopes = data.xmat[plate_id].reshape(3, 3)[2, :2]
        largest = max(largest, np.abs(readings - slopes).max())
    assert largest > math.radians(0.5)  # it was no test at rest


def test_the_quaternion_of_a_posture_is_its_turn() -> None:
    angles = (0.7, -0.2, 0.4)
    out = np.empty(9)
    mujoco.mju_quat2Mat(out, plate_quaternion(*angles))
    np.testing.assert_allclose(out.reshape(3, 3), turn(*angles), atol=1e-15)


@pytest.mark.parametrize(
    "keys", [{"noise": -1.0}, {"time_constant": math.inf}, {"offsets": (math.nan, 0.0)}, {"offsets": (0.0,)}]
)
def test_impossible_inclinometers_are_refused(keys: dict[str, object]) -> None:
    with pytest.raises(PlantError, match=f"inclinometers.{next(iter(keys))}"):
        Inclinometers(**keys)
