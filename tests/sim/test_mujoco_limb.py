"""The limb in MuJoCo obeys mechanics: friction, inertia, play, payload, weight, pushes; a batch is so many single limbs."""

import math
from collections.abc import Iterator
from pathlib import Path

import mujoco
import numpy as np
import pytest

from clamber.control.chain import Chain
from clamber.control.controller import Controller, MeasurementError, still_aim
from clamber.control.law_settings import LawSettings
from clamber.execution.closed_loop import close_loop
from clamber.families.climber.control.limb_chain import chain_of_limb, closed_branches
from clamber.families.climber.robot.robot import LimbedRobot
from clamber.limb_bench.bench_limb import bench_limb
from clamber.limb_bench.scenario import step_scenario
from clamber.sim.bench_limb import BenchLimb
from clamber.sim.limb_flaws import LimbFlaws, Push
from clamber.sim.mujoco_limb import MujocoLimb
from clamber.sim.plant_rules import PlantError
from clamber.tasks.robots import load_robot, robot_names
from clamber.types import Floats

FREE = LimbFlaws(motor_limits=False)
SMOOTH = FREE.with_changes(friction=0.0, damping=0.0, physics_rate=100_000.0, control_rate=1000.0)
PLAY = math.radians(2.0)


@pytest.fixture(scope="module")
def leg() -> BenchLimb:
    return bench_limb()


def hold(plant: MujocoLimb, torque: Floats, ticks: int) -> Floats:
    """True states of a single limb after so many ticks of one torque, shape (2, n)."""
    for _ in range(ticks):
        plant.actuate(torque[None])
        plant.step()
    return plant.truth().states[0].copy()


def acceleration(chain: Chain, flaws: LimbFlaws, q: Floats, torque: Floats) -> Floats:
    """First acceleration from rest, by a step so short that nothing turns."""
    plant = MujocoLimb(chain, flaws)
    plant.reset(q)
    out: Floats = hold(plant, torque, 1)[1] / plant.period
    return out


@pytest.mark.parametrize("part", [0.5, 0.99])
def test_friction_holds_a_loaded_joint_but_for_a_micro_slip(leg: BenchLimb, part: float) -> None:
    """MuJoCo's friction lets a joint slip by a part in a thousand of 3 mrad/s: a hundredth of a millimetre at the tip in 10 s."""
    plant = MujocoLimb(leg.chain, LimbFlaws())
    plant.reset(leg.q0)
    states = hold(plant, part * leg.chain.joints["friction"], 2000)
    slip = np.abs(states[0] - leg.q0)
    assert np.all(slip < 4e-6 * 10.0)
    assert np.linalg.norm(leg.chain.place(states[0]) - leg.chain.place(leg.q0)) < 1e-5
    assert np.all(slip > 0.0), "if it holds exactly, say so"


def test_more_than_friction_breaks_a_joint_away(leg: BenchLimb) -> None:
    plant = MujocoLimb(leg.chain, LimbFlaws())
    plant.reset(leg.q0)
    assert np.all(hold(plant, 1.2 * leg.chain.joints["friction"], 400)[0] - leg.q0 > 0.01)


def test_the_terminal_speed_is_the_torque_less_friction_over_the_damping() -> None:
    """One joint at a time: the other, bent straight, lets only its friction be felt."""
    leg = bench_limb()
    joints = leg.chain.joints
    torque = np.array((0.0, 0.4))
    plant = MujocoLimb(leg.chain, FREE)
    plant.reset(leg.q0)
    elbow = hold(plant, torque, 4000)[1, 1]
    assert elbow == pytest.approx((0.4 - joints["friction"][1]) / joints["damping"][1], rel=0.01)


def test_the_terminal_speed_grows_by_what_friction_is_taken_away(leg: BenchLimb) -> None:
    joints = leg.chain.joints
    for friction, damping in ((0.0, 1.0), (0.5, 2.0)):
        plant = MujocoLimb(leg.chain, FREE.with_changes(friction=friction, damping=damping))
        plant.reset(leg.q0)
        elbow = hold(plant, np.array((0.0, 0.4)), 4000)[1, 1]
        expected = (0.4 - friction * joints["friction"][1]) / (damping * joints["damping"][1])
        assert elbow == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("seed", range(3))
def test_a_torque_accelerates_rotors_and_links_together(leg: BenchLimb, seed: int) -> None:
    """M qdd = tau, where M is the reflected inertia and the links'."""
    rng = np.random.default_rng(seed)
    q, torque = rng.uniform(-2.0, 2.0, 2), rng.uniform(-5.0, 5.0, 2)
    found = acceleration(leg.chain, SMOOTH, q, torque)
    np.testing.assert_allclose(leg.chain.inertia(q) @ found, torque, rtol=1e-3, atol=1e-4)


def test_the_rotors_are_nearly_all_of_the_inertia(leg: BenchLimb) -> None:
    """The premise of the simplified law, on our links: they add a few per cent to the shoulder."""
    share = np.diag(leg.chain.inertia(leg.q0)) / leg.chain.joints["rotor"] - 1.0
    assert np.all(share > 0.0) and np.all(share < 0.05)


@pytest.mark.parametrize("mass", [0.0, 0.4])
def test_a_payload_slows_the_limb_as_a_point_mass_at_the_tip(leg: BenchLimb, mass: float) -> None:
    torque = np.array((3.0, -2.0))
    found = acceleration(leg.chain, SMOOTH.with_changes(payload=mass), leg.q0, torque)
    jacobian = leg.chain.jacobian(leg.q0)[:3]
    inertia = leg.chain.inertia(leg.q0) + mass * jacobian.T @ jacobian
    np.testing.assert_allclose(inertia @ found, torque, rtol=1e-3, atol=1e-4)


@pytest.mark.parametrize("name", ["right", "left", "bottom"])
def test_an_upright_limb_is_held_by_the_torques_that_carry_its_weight(name: str) -> None:
    leg = bench_limb(limb=name, upright=True)
    bias = leg.chain.bias(leg.q0, np.zeros(2))
    assert np.abs(bias).max() > 0.05
    held = acceleration(leg.chain, SMOOTH.with_changes(upright=True), leg.q0, bias)
    np.testing.assert_allclose(held, 0.0, atol=1e-4)
    falling = acceleration(leg.chain, SMOOTH.with_changes(upright=True), leg.q0, np.zeros(2))
    np.testing.assert_allclose(leg.chain.inertia(leg.q0) @ falling, -bias, rtol=1e-3)


def test_a_payload_weighs(leg: BenchLimb) -> None:
    upright = bench_limb(upright=True).chain
    flaws = SMOOTH.with_changes(upright=True, payload=0.3)
    weight = upright.jacobian(leg.q0)[:3].T @ (0.3 * upright.root["gravity"][0])
    torque = upright.bias(leg.q0, np.zeros(2)) - weight
    np.testing.assert_allclose(acceleration(upright, flaws, leg.q0, torque), 0.0, atol=1e-4)


def test_an_upright_limb_needs_a_chain_that_weighs(leg: BenchLimb) -> None:
    with pytest.raises(PlantError, match="upright = True: needs a chain under gravity"):
        MujocoLimb(leg.chain, LimbFlaws(upright=True))


@pytest.mark.parametrize("mass", [0.0, 0.5])
@pytest.mark.parametrize("force", [(12.0, 0.0), (-3.0, 7.0)])
def test_a_push_acts_on_the_joints_as_the_jacobian_says(
    leg: BenchLimb, force: tuple[float, float], mass: float
) -> None:
    """Joint torques of -J^T F stand against it, whatever the limb carries."""
    push = Push(x=force[0], y=force[1], start=0.0, end=1.0, rise=0.0)
    flaws = SMOOTH.with_changes(push=push, payload=mass)
    against = -leg.chain.jacobian(leg.q0)[:2].T @ force
    np.testing.assert_allclose(acceleration(leg.chain, flaws, leg.q0, against), 0.0, atol=1e-4)
    assert np.abs(acceleration(leg.chain, flaws, leg.q0, np.zeros(2))).max() > 0.5


def test_a_push_comes_and_goes_and_is_told_as_a_wrench_of_the_limb(leg: BenchLimb) -> None:
    push = Push(x=10.0, y=-4.0, start=0.1, end=0.3, rise=0.05)
    plant = MujocoLimb(leg.chain, LimbFlaws(push=push))
    plant.reset(leg.q0)
    for k in range(100):
        hold(plant, np.zeros(2), 1)
        x, y = push.at((k + 0.5) * plant.period)
        assert plant.truth().wrenches[0].tolist() == [-x, -y, 0.0, 0.0, 0.0, 0.0]
    assert push.at(0.2) == (10.0, -4.0) and push.at(0.05) == (0.0, 0.0) == push.at(0.36)
    assert not plant._pushed_rows.any()


def test_the_play_is_as_wide_as_stated(leg: BenchLimb) -> None:
    """The motors stand; the links, pushed to and fro, move by the play and no more: about half an inch at the tip (Bevly 1997)."""
    ends = []
    for sign in (1.0, -1.0):
        push = Push(x=0.0, y=sign * 0.2, start=0.0, end=10.0)
        plant = MujocoLimb(leg.chain, LimbFlaws(backlash=PLAY, push=push))
        plant.reset(leg.q0)
        ends.append(hold(plant, np.zeros(2), 400)[0])
        np.testing.assert_allclose(plant.sense().states[0, 0], leg.q0, atol=1e-4)  # the end's blow
    # the elbow's torque is small there: both joints lie against their ends
    np.testing.assert_allclose(np.abs(ends[0] - ends[1]), PLAY, rtol=0.01)


def test_a_link_that_nothing_weighs_down_comes_to_rest_in_its_play(leg: BenchLimb) -> None:
    push = Push(x=0.05, y=0.05, start=0.0, end=0.05)
    plant = MujocoLimb(leg.chain, LimbFlaws(backlash=PLAY, push=push))
    plant.reset(leg.q0)
    fast = np.abs(hold(plant, np.zeros(2), 20)[1]).max()
    slow = np.abs(hold(plant, np.zeros(2), 3980)[1]).max()
    assert fast > 1e-2
    assert slow < 1e-2 * fast


def test_the_encoders_sit_before_the_play(leg: BenchLimb) -> None:
    """What the encoders make of the tip is off by J times half the play of each joint, to the side to which the load pulls."""
    upright = bench_limb(upright=True)
    plant = MujocoLimb(upright.chain, LimbFlaws(backlash=PLAY, upright=True))
    plant.reset(leg.q0)
    bias = upright.chain.bias(leg.q0, np.zeros(2))
    true = hold(plant, bias, 600)[0]
    sensed = plant.sense().states[0, 0]
    np.testing.assert_allclose(sensed, leg.q0, atol=1e-3)
    np.testing.assert_allclose(true - sensed, -np.sign(bias) * PLAY / 2, rtol=0.01)
    apart = np.linalg.norm(upright.chain.place(true) - upright.chain.place(sensed))
    expected = np.linalg.norm(upright.chain.jacobian(leg.q0)[:2] @ (np.sign(bias) * PLAY / 2))
    assert apart == pytest.approx(expected, rel=0.03)
    assert 1e-3 < apart < 7e-3


def test_a_joint_stop_holds_against_the_motor_where_it_is_asked_for(leg: BenchLimb) -> None:
    torque = np.array((0.0, 10.0))
    upper = leg.chain.joints["upper"][1]
    ends = []
    for stops in (True, False):
        plant = MujocoLimb(leg.chain, LimbFlaws(joint_limits=stops))
        plant.reset(leg.q0)
        ends.append(hold(plant, torque, 200)[0, 1])
    assert ends[0] == pytest.approx(upper, abs=2e-3)
    assert ends[1] > upper + 0.5


@pytest.mark.parametrize("branch", [0, 1])
def test_the_published_circle_bends_the_elbow_beyond_its_printed_limit(leg: BenchLimb, branch: int) -> None:
    """Why stops are off by default."""
    limb = leg.robot.limbs[leg.robot.limb_index(leg.name)]
    angles = [
        closed_branches(limb, 0.22 + 0.05 * math.cos(turn), 0.05 * math.sin(turn))[branch][1]
        for turn in np.linspace(0.0, math.tau, 3600, endpoint=False)
    ]
    assert math.degrees(np.abs(angles).max()) == pytest.approx((115.6, 111.9)[branch], abs=0.1)
    assert np.abs(angles).max() > limb.elbow.upper


def test_halving_the_physics_step_hardly_changes_the_step_response(leg: BenchLimb) -> None:
    """The time-step error is of first order: half the step leaves half of it, and it is below a tenth of a millimetre."""
    scenario = step_scenario(leg, 200.0, seconds=1.0)
    places = {}
    for rate in (1000.0, 2000.0, 4000.0, 16_000.0):
        plant = MujocoLimb(leg.chain, LimbFlaws(physics_rate=rate))
        plant.reset(leg.q0)
        controller = Controller(leg.chain, LawSettings(law="scct", kp=100.0), period=plant.period)
        places[rate] = close_loop(plant, controller, scenario.aims).true_places()
    best = places.pop(16_000.0)
    errors = {rate: float(np.abs(place - best).max()) for rate, place in places.items()}
    assert errors[2000.0] < 1e-4
    assert errors[1000.0] > 1.5 * errors[2000.0] > 2.25 * errors[4000.0]


FLAWED = LimbFlaws(
    backlash=PLAY, encoder_counts=400, delay=1, payload=0.2, push=Push(x=5.0, y=-3.0, start=0.05, end=0.2)
)


@pytest.mark.parametrize("flaws", [LimbFlaws(), FLAWED], ids=["plain", "flawed"])
def test_a_batch_gives_the_bits_of_single_runs_on_any_number_of_threads(leg: BenchLimb, flaws: LimbFlaws) -> None:
    """Some of these limbs run into their motors' limits and some do not: none may feel another."""
    batch, ticks = 5, 60
    starts = leg.q0 + np.linspace(-0.3, 0.3, batch)[:, None]
    scales = np.linspace(0.2, 30.0, batch)[:, None]
    torques = np.random.default_rng(0).uniform(-1.0, 1.0, (ticks, batch, 2)) * scales

    def run(plant: MujocoLimb, chosen: slice) -> Iterator[list[Floats]]:
        plant.reset(starts[chosen])
        for torque in torques:
            sensed = plant.sense().states.copy()
            plant.actuate(torque[chosen])
            plant.step()
            truth = plant.truth()
            yield [sensed, truth.states.copy(), truth.torques.copy(), truth.wrenches.copy()]

    batches = [
        list(run(MujocoLimb(leg.chain, flaws, gears=leg.gears, batch=batch, threads=k), slice(None))) for k in (1, 2, 4)
    ]
    for b in range(batch):
        single = list(run(MujocoLimb(leg.chain, flaws, gears=leg.gears), slice(b, b + 1)))
        for tick in range(ticks):
            for k, alone in enumerate(single[tick]):
                for together in batches:
                    assert np.array_equal(together[tick][k][b], alone[0])


ROBOTS = [robot for robot in map(load_robot, robot_names()) if isinstance(robot, LimbedRobot)]
LIMBS = [(robot, name) for robot in ROBOTS for name in robot.limb_names]


def test_there_are_limbs_to_try() -> None:
    assert len(ROBOTS) >= 2 and len(LIMBS) >= 7


@pytest.mark.parametrize(("robot", "name"), LIMBS, ids=[f"{robot.name}-{name}" for robot, name in LIMBS])
@pytest.mark.parametrize("upright", [False, True], ids=["flat", "upright"])
def test_every_limb_of_every_robot_moves_for_a_second_without_a_warning(
    robot: LimbedRobot, name: str, upright: bool
) -> None:
    chain = chain_of_limb(robot, name, upright=upright)
    flaws = LimbFlaws(backlash=robot.motor.backlash, encoder_counts=robot.motor.encoder_counts, upright=upright)
    plant = MujocoLimb(chain, flaws)
    plant.reset((chain.joints["lower"] + chain.joints["upper"]) / 2)
    for torque in np.random.default_rng(5).uniform(-1.0, 1.0, (200, 1, 2)) * chain.joints["limit"]:
        plant.actuate(torque)
        plant.step()
    assert np.all(np.isfinite(plant.truth().states))
    assert {mujoco.mjtWarning(k).name: w.number for k, w in enumerate(plant._data.warning) if w.number} == {}


def test_a_limb_that_runs_away_is_not_put_back_to_zero(
    leg: BenchLimb, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """MuJoCo would start over from zero angles, and say so in a file of its own only."""
    monkeypatch.chdir(tmp_path)
    plant = MujocoLimb(leg.chain, FREE.with_changes(friction=0.0))
    plant.reset(leg.q0)
    speeds = [float(np.abs(hold(plant, np.array((5e9, 0.0)), 1)[1]).max()) for _ in range(200)]
    assert max(speeds) > 1e9
    assert not speeds[-1] < 0.5 * max(speeds)


def test_a_limb_that_leaves_the_finite_numbers_is_named(leg: BenchLimb) -> None:
    plant = MujocoLimb(leg.chain, LimbFlaws())
    plant.reset(np.array((math.nan, 0.0)))
    controller = Controller(leg.chain, LawSettings(law="scct"), period=plant.period)
    with pytest.raises(MeasurementError, match="angle of the right shoulder is nan"):
        close_loop(plant, controller, np.stack([still_aim((0.22, 0.0))] * 3))
