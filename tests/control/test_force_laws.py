"""Force laws by scripted sensors: the admittance's mass, spring and damper; integrals; speed where nothing is touched."""

import math

import numpy as np
import pytest

from clamber.control.controller import Controller, still_aim
from clamber.control.law_settings import LawSettings
from clamber.execution.closed_loop import close_loop
from clamber.limb_bench.bench_limb import bench_limb
from clamber.sim.bench_limb import BenchLimb
from clamber.sim.limb_flaws import LimbFlaws
from clamber.sim.mujoco_limb import MujocoLimb


@pytest.fixture(scope="module")
def leg() -> BenchLimb:
    return bench_limb()


def state_at_rest(leg: BenchLimb) -> np.ndarray:
    return np.stack((leg.q0, np.zeros(2)))[None]


@pytest.mark.parametrize(
    ("mass", "damping", "stiffness"), [(2.0, 10.0, 800.0), (1.0, 60.0, 900.0), (3.0, 300.0, 600.0)]
)
def test_an_admittance_yields_as_its_mass_on_its_spring_and_damper(
    mass: float, damping: float, stiffness: float, leg: BenchLimb
) -> None:
    """A step of felt force: the law's wanted speed is that of the closed form, in rate and in decay."""
    period, kd = 1e-4, 10.0
    settings = LawSettings(
        law="admittance", kp=0.0, joint_kd=kd, mass=mass, admittance_kd=damping, admittance_kp=stiffness
    )
    law = Controller(leg.chain, settings, period=period)
    aim, state = still_aim(leg.start), state_at_rest(leg)
    jacobian, share = leg.chain.jacobian(leg.q0)[:2], law.chain.joints["share"]
    felt = np.zeros((1, 6))
    felt[0, 0] = -5.0  # pulled along x
    speeds = []
    for _ in range(6000):
        torque = law.command(aim, state, felt)[0]
        speeds.append(jacobian @ (torque / (share * kd)))
    time = period * np.arange(1, 6001)
    roots = np.roots((mass, damping, stiffness)).astype(complex)
    if abs(roots[0] - roots[1]) < 1e-6 * abs(roots[0]):
        wanted = 5.0 / mass * time * np.exp(roots[0].real * time)
    else:
        wanted = (5.0 / mass * (np.exp(roots[0] * time) - np.exp(roots[1] * time)) / (roots[0] - roots[1])).real
    np.testing.assert_allclose(np.array(speeds)[:, 0], wanted, atol=0.02 * np.abs(wanted).max())
    np.testing.assert_allclose(np.array(speeds)[:, 1], 0.0, atol=1e-9)


def test_an_admittance_without_mass_and_spring_moves_by_force_over_damping(leg: BenchLimb) -> None:
    settings = LawSettings(law="admittance", kp=0.0, joint_kd=10.0, mass=0.0, admittance_kd=200.0, feed_force=False)
    law = Controller(leg.chain, settings, period=0.005)
    aim = still_aim(leg.start)
    aim["wrench"][0, 1] = 7.0
    felt = np.zeros((1, 6))
    felt[0, 1] = 3.0
    torque = law.command(aim, state_at_rest(leg), felt)[0]
    speed = leg.chain.jacobian(leg.q0)[:2] @ (torque / (law.chain.joints["share"] * 10.0))
    np.testing.assert_allclose(speed, (0.0, 4.0 / 200.0), atol=1e-12)


def test_the_integral_of_force_rests_until_the_surface_is_felt_and_keeps_its_limit(leg: BenchLimb) -> None:
    settings = LawSettings(law="hybrid", forced=("x",), force_gain=2.0, force_limit=3.0)
    law = Controller(leg.chain, settings, period=0.005)
    aim, state = still_aim(leg.start), state_at_rest(leg)
    aim["wrench"][0, 0] = 20.0
    inverse = np.linalg.inv(leg.chain.jacobian(leg.q0)[:2].T)

    def force(felt_force: float, ticks: int) -> float:
        felt = np.zeros((1, 6))
        felt[0, 0] = felt_force
        for _ in range(ticks):
            torque = law.command(aim, state, felt)[0]
        return float((inverse @ torque)[0])

    assert force(1.0, 100) == pytest.approx(20.0)
    assert force(15.0, 10) == pytest.approx(20.0 + 2.0 * 5.0 * 10 * 0.005)
    assert force(15.0, 1000) == pytest.approx(23.0)


@pytest.mark.parametrize("damping", [100.0, 400.0])
def test_in_free_space_a_wanted_force_moves_no_faster_than_force_over_damping(damping: float, leg: BenchLimb) -> None:
    settings = LawSettings(law="hybrid", forced=("x",), force_damping=damping)
    plant = MujocoLimb(leg.chain, LimbFlaws())
    plant.reset(leg.q0)
    aims = np.stack([still_aim(leg.start)] * 120)
    aims["wrench"][:, 0, 0] = 8.0
    trace = close_loop(plant, Controller(leg.chain, settings, period=plant.period), aims)
    speeds = [float((leg.chain.jacobian(q) @ qd)[0]) for q, qd in trace.true[:, 0]]
    assert 0.0 < max(speeds) <= 8.0 / damping
    assert math.isclose(trace.time[-1], 119 * plant.period)


@pytest.mark.parametrize("law", ["hybrid", "implicit-force"])
def test_a_turned_task_turns_the_torques_of_force(law: str, leg: BenchLimb) -> None:
    angle = 0.7
    aim = still_aim(leg.start)
    aim["wrench"][0, :2] = 20.0 * np.array((math.cos(angle), math.sin(angle)))
    settings = LawSettings(law=law, kp=0.0, kd=0.0, angle=angle, forced=("x",))
    torque = Controller(leg.chain, settings, period=0.005).command(aim, state_at_rest(leg))[0]
    np.testing.assert_allclose(torque, leg.chain.jacobian(leg.q0)[:2].T @ aim["wrench"][0, :2], atol=1e-12)
