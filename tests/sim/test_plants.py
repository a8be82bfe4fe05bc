"""Every plant keeps to the protocol, and is found by its name."""

import numpy as np
import pytest

from clamber.control.law_settings import LawSettings
from clamber.errors import UnknownNameError
from clamber.families.climber.control.limb_chain import chain_of_limb
from clamber.families.climber.robot.robot import LimbedRobot
from clamber.limb_bench.bench_limb import bench_limb
from clamber.limb_bench.measures import Entry
from clamber.limb_bench.runner import run_contest
from clamber.limb_bench.scenario import step_scenario
from clamber.sim.bench_limb import BenchLimb
from clamber.sim.limb_flaws import LimbFlaws, Push
from clamber.sim.plant_rules import PlantError
from clamber.sim.plants import PLANTS
from clamber.tasks.robots import load_robot, robot_names


@pytest.fixture(scope="module")
def leg() -> BenchLimb:
    return bench_limb()


@pytest.mark.parametrize("name", PLANTS)
def test_a_plant_at_rest_stays_where_it_was_put(name: str, leg: BenchLimb) -> None:
    plant = PLANTS[name](leg.chain, LimbFlaws(encoder_counts=400), gears=leg.gears, batch=2)
    plant.reset(leg.q0)
    for _ in range(5):
        plant.sense()
        plant.actuate(np.zeros((2, 2)))
        plant.step()
    np.testing.assert_allclose(plant.truth().states, np.tile((leg.q0, (0.0, 0.0)), (2, 1, 1)), atol=1e-9)


@pytest.mark.parametrize("name", PLANTS)
def test_a_plant_that_is_reset_forgets_everything(name: str, leg: BenchLimb) -> None:
    flaws = LimbFlaws(encoder_counts=400, delay=2, push=Push(x=10.0, y=5.0, start=0.0, end=0.5))
    plant = PLANTS[name](leg.chain, flaws, gears=leg.gears)
    runs = []
    for _ in range(2):
        plant.reset(leg.q0)
        assert not plant.truth().torques.any() and not plant.truth().wrenches.any()
        for k in range(40):
            sensed = plant.sense().states.copy()
            plant.actuate(np.full((1, 2), np.sin(0.3 * k)))
            plant.step()
        runs.append((sensed, plant.truth().states.copy(), plant.truth().wrenches.copy()))
    assert runs[0][2].any()
    for first, second in zip(*runs, strict=True):
        assert np.array_equal(first, second)


@pytest.mark.parametrize("name", PLANTS)
def test_a_contest_takes_place_on_the_plant_that_is_named(name: str, leg: BenchLimb) -> None:
    scenario = step_scenario(leg, 200.0)
    (run,) = run_contest(leg, scenario, [Entry("scct", LawSettings(law="scct", kp=100.0))], LimbFlaws(), plant=name)
    end = run.trace.true_places()[-1, 0]
    np.testing.assert_allclose(end[:2], (0.22, -0.02), atol=2e-3)  # as far as friction lets it come


LIMBS = [
    (robot, limb)
    for robot in map(load_robot, robot_names())
    if isinstance(robot, LimbedRobot)
    for limb in robot.limb_names
]


@pytest.mark.parametrize("name", PLANTS)
@pytest.mark.parametrize(("robot", "limb"), LIMBS, ids=[f"{robot.name}-{limb}" for robot, limb in LIMBS])
def test_every_limb_of_every_robot_moves_on_every_plant(name: str, robot: LimbedRobot, limb: str) -> None:
    chain = chain_of_limb(robot, limb)
    plant = PLANTS[name](chain, LimbFlaws(encoder_counts=robot.motor.encoder_counts), batch=2)
    start = (chain.joints["lower"] + chain.joints["upper"]) / 2
    plant.reset(start)
    for torque in np.random.default_rng(6).uniform(-1.0, 1.0, (200, 2, 2)) * chain.joints["limit"]:
        plant.sense()
        plant.actuate(torque)
        plant.step()
    states = plant.truth().states
    assert np.all(np.isfinite(states))
    assert np.all(np.abs(states[:, 0] - start) > 1e-3)
    assert np.all(np.abs(states[:, 1]) < 3.0 * chain.joints["speed"])


def test_an_unknown_plant_is_named_with_those_that_there_are(leg: BenchLimb) -> None:
    scenario = step_scenario(leg, 200.0)
    with pytest.raises(
        UnknownNameError, match="no plant is called 'mujco'; there are mujoco, ode; did you mean 'mujoco'"
    ):
        run_contest(leg, scenario, [], LimbFlaws(), plant="mujco")


def test_a_contest_on_the_ode_refuses_what_the_ode_does_not_have(leg: BenchLimb) -> None:
    with pytest.raises(PlantError, match="backlash"):
        run_contest(leg, step_scenario(leg, 200.0), [], LimbFlaws(backlash=0.03), plant="ode")
