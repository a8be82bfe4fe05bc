"""The ODE plant: closed forms of one joint, order of convergence, agreement with MuJoCo, and what it refuses."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from clamber.control.chain import Chain, empty_chain
from clamber.control.controller import Controller, still_aim
from clamber.control.law_settings import LawSettings
from clamber.execution.closed_loop import close_loop
from clamber.limb_bench.bench_limb import bench_limb
from clamber.sim import limb_model
from clamber.sim.bench_limb import BenchLimb
from clamber.sim.limb_flaws import LimbFlaws, Push, Wall
from clamber.sim.mujoco_limb import MujocoLimb
from clamber.sim.ode_limb import OdeLimb
from clamber.sim.ode_steps import step_joint
from clamber.sim.plant_rules import PlantError
from clamber.types import Floats

FREE = LimbFlaws(motor_limits=False)


@pytest.fixture(scope="module")
def leg() -> BenchLimb:
    return bench_limb()


def massless(chain: Chain) -> Chain:
    joints = chain.joints.copy()
    joints["mass"], joints["inertia"] = 0.0, 0.0
    return replace(chain, joints=joints)


def run_torques(plant: OdeLimb | MujocoLimb, q0: Floats, torques: Floats) -> Floats:
    """True states after every tick, shape (ticks + 1, 2, n)."""
    plant.reset(q0)
    out = [plant.truth().states[0].copy()]
    for torque in torques:
        plant.actuate(torque[None])
        plant.step()
        out.append(plant.truth().states[0].copy())
    return np.stack(out)


def test_a_steady_torque_gives_the_closed_form_of_the_speed(leg: BenchLimb) -> None:
    torque = np.array((2.0, -1.5))
    plant = OdeLimb(leg.chain, FREE)
    states = run_torques(plant, leg.q0, np.tile(torque, (400, 1)))
    joints = leg.chain.joints
    time = np.arange(401)[:, None] * plant.period
    terminal = np.sign(torque) * (np.abs(torque) - joints["friction"]) / joints["damping"]
    decay = np.exp(-joints["damping"] / joints["rotor"] * time)
    np.testing.assert_allclose(states[:, 1], terminal * (1.0 - decay), rtol=1e-11, atol=1e-13)
    constant = joints["rotor"] / joints["damping"]
    angle = leg.q0 + terminal * (time - constant * (1.0 - decay))
    np.testing.assert_allclose(states[:, 0], angle, rtol=1e-11, atol=1e-12)


def test_the_terminal_speed_is_the_torque_less_friction_over_the_damping(leg: BenchLimb) -> None:
    torque = np.array((1.5, 0.5))
    states = run_torques(OdeLimb(leg.chain, FREE), leg.q0, np.tile(torque, (10_000, 1)))
    joints = leg.chain.joints
    np.testing.assert_allclose(states[-1, 1], (torque - joints["friction"]) / joints["damping"], rtol=1e-9)


def test_a_joint_without_damping_gains_speed_evenly() -> None:
    moved, speed = step_joint(0.5, 0.0, 0.2, 1.2, 0.0, 0.3)
    assert speed == pytest.approx(1.0 / 0.5 * 0.3, rel=1e-14)
    assert moved == pytest.approx(0.5 * (1.0 / 0.5) * 0.3**2, rel=1e-14)


@given(st.floats(1e-9, 3.0), st.floats(-5.0, 5.0), st.floats(-3.0, 3.0))
def test_two_steps_are_one_step_of_twice_the_time(damping: float, torque: float, speed: float) -> None:
    once = step_joint(0.4, damping, 0.5, torque, speed, 0.02)
    first = step_joint(0.4, damping, 0.5, torque, speed, 0.01)
    second = step_joint(0.4, damping, 0.5, torque, first[1], 0.01)
    assert first[0] + second[0] == pytest.approx(once[0], rel=1e-9, abs=1e-12)
    assert second[1] == pytest.approx(once[1], rel=1e-9, abs=1e-11)


@given(st.floats(-0.999, 0.999), st.floats(-3.0, 3.0))
def test_friction_never_moves_a_joint_nor_turns_it_round(part: float, speed: float) -> None:
    """Against a torque below friction a joint slows, stops, and stays to the last bit."""
    friction = 0.6
    for _ in range(40):
        before = speed
        _, speed = step_joint(0.4, 0.3, friction, part * friction, speed, 0.5)
        assert abs(speed) <= abs(before) and speed * before >= 0.0
    assert speed == 0.0
    assert step_joint(0.4, 0.3, friction, part * friction, 0.0, 0.5) == (0.0, 0.0)


def test_a_sliding_joint_stops_when_and_where_the_closed_form_says() -> None:
    inertia, friction, speed = 0.4, 0.6, 1.5
    moved, after = step_joint(inertia, 0.0, friction, 0.0, speed, 10.0)
    assert after == 0.0
    assert moved == pytest.approx(inertia * speed**2 / (2.0 * friction), rel=1e-12)


def test_a_torque_that_turns_a_joint_round_loses_twice_the_friction_on_the_way_back() -> None:
    inertia, friction, speed, torque = 0.4, 0.6, 1.0, -2.0
    stop = inertia * speed / (friction - torque)
    _, after = step_joint(inertia, 0.0, friction, torque, speed, 2.0 * stop)
    assert after == pytest.approx((torque + friction) / inertia * stop, rel=1e-12)


@given(st.floats(-4.0, 4.0), st.floats(-2.0, 2.0))
def test_the_mirrored_joint_does_the_mirrored_thing(torque: float, speed: float) -> None:
    moved, after = step_joint(0.4, 0.3, 0.5, torque, speed, 0.01)
    assert step_joint(0.4, 0.3, 0.5, -torque, -speed, 0.01) == (-moved, -after)


def test_a_push_makes_the_step_of_second_order(leg: BenchLimb) -> None:
    """Halving the step quarters the error; the push is large, so that J^T f turns on the way."""
    base = FREE.with_changes(push=Push(x=-60.0, y=25.0, start=0.0, end=1.0, rise=0.0), control_rate=50.0)
    ends = {}
    for rate in (100.0, 200.0, 400.0, 800.0, 51_200.0):
        plant = OdeLimb(leg.chain, base.with_changes(physics_rate=rate))
        ends[rate] = run_torques(plant, leg.q0, np.tile((1.0, 1.0), (10, 1)))[-1, 0]
    best = ends.pop(51_200.0)
    errors = [float(np.abs(end - best).max()) for end in ends.values()]
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    assert errors[0] > 1e-6, "a push that bends nothing shows no order"
    np.testing.assert_allclose(orders, 2.0, atol=0.1)


def test_without_a_push_the_physics_rate_changes_nothing(leg: BenchLimb) -> None:
    torques = np.random.default_rng(3).uniform(-3.0, 3.0, (100, 2))
    coarse, fine = (
        run_torques(OdeLimb(leg.chain, FREE.with_changes(physics_rate=rate)), leg.q0, torques)
        for rate in (200.0, 4000.0)
    )
    np.testing.assert_allclose(coarse, fine, atol=1e-10)


def difference_to_mujoco(leg: BenchLimb, flaws: LimbFlaws, seed: int) -> tuple[float, float]:
    """Largest difference of the angles over 2 s of random torques, links without mass, and how far the lazier joint moved [rad]."""
    chain = massless(leg.chain)
    torques = np.random.default_rng(seed).uniform(-6.0, 6.0, (20, 2)).repeat(20, axis=0)
    ode, mujoco = (run_torques(make(chain, flaws), leg.q0, torques) for make in (OdeLimb, MujocoLimb))
    return float(np.abs(ode[:, 0] - mujoco[:, 0]).max()), float(np.ptp(ode[:, 0], axis=0).min())


@pytest.mark.parametrize("seed", range(3))
def test_without_friction_mujoco_comes_nearer_as_its_step_shrinks(leg: BenchLimb, seed: int) -> None:
    """MuJoCo's step is of first order in the damping, ours is exact."""
    flaws = FREE.with_changes(friction=0.0)
    coarse, moved = difference_to_mujoco(leg, flaws.with_changes(physics_rate=1000.0), seed)
    fine, _ = difference_to_mujoco(leg, flaws.with_changes(physics_rate=4000.0), seed)
    assert moved > 0.3
    assert fine < 1e-3
    assert coarse / fine == pytest.approx(4.0, rel=0.05)


@pytest.mark.parametrize("seed", range(3))
def test_with_friction_mujoco_comes_nearer_as_its_friction_stiffens(
    leg: BenchLimb, seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """MuJoCo's Coulomb friction is viscous near rest, so each turning round differs a little, however small the step."""
    soft, moved = difference_to_mujoco(leg, FREE, seed)
    assert moved > 0.2
    assert soft < 2e-3
    monkeypatch.setattr(limb_model, "FRICTION_SOLREF", (0.0005, 1.0))
    stiff, _ = difference_to_mujoco(leg, FREE.with_changes(physics_rate=8000.0), seed)
    assert stiff < 0.2 * soft


def test_a_law_does_the_same_on_both_plants_where_the_links_have_no_mass(leg: BenchLimb) -> None:
    chain = massless(leg.chain)
    aims = np.stack([still_aim((0.22, -0.02))] * 300)
    flaws = LimbFlaws(encoder_counts=400, delay=1)
    places = []
    for make in (OdeLimb, MujocoLimb):
        plant = make(chain, flaws, gears=leg.gears)
        plant.reset(leg.q0)
        controller = Controller(chain, LawSettings(law="scct", kp=100.0), period=flaws.period)
        places.append(close_loop(plant, controller, aims).true_places())
    np.testing.assert_allclose(places[0], places[1], atol=5e-5)


def test_the_motors_keep_to_their_torque_speed_line_at_every_step(leg: BenchLimb) -> None:
    flaws = LimbFlaws(control_rate=2000.0)
    plant = OdeLimb(leg.chain, flaws)
    joints = leg.chain.joints
    plant.reset(leg.q0)
    plant.actuate(np.full((1, 2), 1000.0))
    speed = np.zeros(2)
    for _ in range(4000):
        plant.step()
        np.testing.assert_allclose(
            plant.truth().torques[0], joints["limit"] * np.minimum(1.0, 1.0 - speed / joints["speed"]), rtol=1e-12
        )
        speed = plant.truth().states[0, 1].copy()
    # where the line meets damping and friction
    slope = joints["limit"] / joints["speed"]
    terminal = (joints["limit"] - joints["friction"]) / (joints["damping"] + slope)
    np.testing.assert_allclose(speed, terminal, rtol=1e-6)


def test_a_batch_gives_the_bits_of_single_runs(leg: BenchLimb) -> None:
    flaws = LimbFlaws(encoder_counts=400, delay=2, push=Push(x=5.0, y=-3.0, start=0.1, end=0.3))
    torques = np.random.default_rng(0).uniform(-20.0, 20.0, (100, 5, 2))
    starts = leg.q0 + np.linspace(-0.2, 0.2, 5)[:, None]
    batch = OdeLimb(leg.chain, flaws, gears=leg.gears, batch=5)
    singles = [OdeLimb(leg.chain, flaws, gears=leg.gears) for _ in range(5)]
    batch.reset(starts)
    for single, start in zip(singles, starts, strict=True):
        single.reset(start)
    for torque in torques:
        sensed = batch.sense().states.copy()
        batch.actuate(torque)
        batch.step()
        for b, single in enumerate(singles):
            assert np.array_equal(single.sense().states[0], sensed[b])
            single.actuate(torque[b : b + 1])
            single.step()
            assert np.array_equal(single.truth().states[0], batch.truth().states[b])
            assert np.array_equal(single.truth().torques[0], batch.truth().torques[b])
            assert np.array_equal(single.truth().wrenches[0], batch.truth().wrenches[b])


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"backlash": math.radians(2.0)}, ("backlash", "0.0349", "must be 0 rad")),
        ({"payload": 0.5}, ("payload", "0.5", "must be 0 kg")),
        ({"upright": True}, ("upright", "True", "must be false")),
        ({"joint_limits": True}, ("joint_limits", "True", "must be false")),
        ({"wall": Wall(x=0.25, y=0.0, angle=0.0)}, ("wall", "(0.25, 0)", "must be left out")),
    ],
)
def test_it_refuses_what_it_does_not_model(leg: BenchLimb, changes: dict[str, object], words: tuple[str, ...]) -> None:
    with pytest.raises(PlantError) as caught:
        OdeLimb(leg.chain, LimbFlaws().with_changes(**changes))
    for word in (*words, "mujoco"):
        assert word in str(caught.value)


def test_it_refuses_a_chain_under_gravity_or_without_inertia(leg: BenchLimb) -> None:
    with pytest.raises(PlantError, match="gravity"):
        OdeLimb(leg.chain.with_gravity((0.0, -9.81, 0.0)), LimbFlaws())
    joints, root = empty_chain(1)
    with pytest.raises(PlantError, match=r"turn\.rotor = 0\.0"):
        OdeLimb(Chain("bare", ("turn",), joints, root, plane=True), LimbFlaws())
