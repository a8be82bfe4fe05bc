"""What is fed forward: the aim's speed and acceleration, weight, Coriolis torques, friction, a wanted force; and the motors' limits."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from random_chains import PERIOD, limb, motors_only, quarter, random_aim, random_chain, random_state, tick, tip_turn

from clamber.control.chain import Chain
from clamber.control.controller import Controller, still_aim
from clamber.control.law_settings import LAWS, LawSettings
from clamber.types import Floats

SEEDS = st.integers(0, 10_000)
TASK_DAMPED = ("jacobian-transpose", "scct", "implicit-admittance", "hybrid", "implicit-force", "operational-space")
UNLOADED = {"kp": 0.0, "kd": 0.0, "feed_gravity": False, "feed_bias": False, "sigma": 0.0}


@pytest.mark.parametrize("law", LAWS)
@quarter
@given(seed=SEEDS)
def test_fed_weight_holds_an_upright_limb_at_rest_on_its_aim(law: str, seed: int) -> None:
    for chain in (limb("right", upright=True), random_chain(6, 6)):
        q, _ = random_state(chain, seed)
        still = np.zeros(chain.n)
        aim = still_aim(chain.place(q))
        aim["turn"] = tip_turn(chain, q)
        torques = tick(chain, LawSettings(law=law), aim, q, still)
        np.testing.assert_allclose(torques, chain.bias(q, still), atol=1e-9)
        assert np.abs(torques).max() > 1e-3
        np.testing.assert_allclose(tick(chain, LawSettings(law=law, feed_gravity=False), aim, q, still), 0.0, atol=1e-9)


@pytest.mark.parametrize("law", LAWS)
def test_a_limb_that_moves_with_its_aim_is_damped_only_without_the_speed_fed_forward(law: str) -> None:
    chain = limb()
    settings = LawSettings(law=law, feed_gravity=False, feed_bias=False)
    for seed in range(10):
        q, qd = random_state(chain, seed)
        if np.linalg.svd(chain.jacobian(q)[:2], compute_uv=False).min() < settings.sigma:
            continue
        aim = still_aim(chain.place(q))
        aim["twist"] = chain.jacobian(q) @ qd
        fed = tick(chain, settings, aim, q, qd)
        np.testing.assert_allclose(fed, 0.0, atol=1e-9)
        unfed = tick(chain, settings.with_changes(feed_velocity=False), aim, q, qd)
        assert unfed @ qd < -1e-3  # takes energy out of the motion


@quarter
@given(seed=SEEDS)
def test_without_the_speed_fed_forward_laws_do_not_look_at_the_aims_speed(seed: int) -> None:
    chain = limb()
    q, qd = random_state(chain, seed)
    aim = random_aim(chain, q, seed)
    slow = aim.copy()
    slow["twist"] = 0.0
    for law in LAWS:
        settings = LawSettings(law=law, feed_velocity=False)
        np.testing.assert_array_equal(tick(chain, settings, aim, q, qd), tick(chain, settings, slow, q, qd))


@pytest.mark.parametrize("law", sorted(set(LAWS) - {"operational-space"}))
@quarter
@given(seed=SEEDS)
def test_a_fed_acceleration_is_met_where_the_motors_inertia_is_all(law: str, seed: int) -> None:
    chain = motors_only(random_chain(6, 6, gravity=False))
    q, _ = random_state(chain, seed)
    still = np.zeros(6)
    aim = still_aim(chain.place(q))
    aim["turn"], aim["acceleration"] = tip_turn(chain, q), np.random.default_rng(seed).normal(size=(1, 6))
    torques = tick(chain, LawSettings(law=law, feed_acceleration=True, sigma=0.0), aim, q, still)
    got = chain.jacobian(q) @ np.linalg.solve(chain.inertia(q), torques)
    condition = np.linalg.cond(chain.jacobian(q))
    np.testing.assert_allclose(got, aim["acceleration"][0], atol=1e-12 * condition)


@pytest.mark.parametrize("law", LAWS)
def test_fed_bias_is_the_models(law: str) -> None:
    chain = random_chain(6, 6)
    q, qd = random_state(chain, 1)
    aim = random_aim(chain, q, 1)
    with_it = tick(chain, LawSettings(law=law, feed_bias=True, feed_gravity=True), aim, q, qd)
    weight = tick(chain, LawSettings(law=law, feed_bias=True, feed_gravity=False), aim, q, qd)
    np.testing.assert_allclose(with_it - weight, chain.bias(q, np.zeros(6)), atol=1e-9)
    if law != "operational-space":
        bare = tick(chain, LawSettings(law=law, feed_bias=False, feed_gravity=False), aim, q, qd)
        np.testing.assert_allclose(with_it - bare, chain.bias(q, qd), atol=1e-9)


@pytest.mark.parametrize("law", LAWS)
def test_a_wanted_force_is_fed_through_the_statics(law: str) -> None:
    chain = limb()
    q, _ = random_state(chain, 3)
    aim = still_aim(chain.place(q))
    aim["wrench"] = (3.0, -2.0, 1.0, 0.0, 0.0, 0.5)  # rows outside of the task do not count
    felt = aim["wrench"][0]  # so that the admittance does not move
    for feed in (True, False):
        torques = tick(chain, LawSettings(law=law, feed_force=feed), aim, q, np.zeros(2), felt)
        np.testing.assert_allclose(torques, feed * chain.jacobian(q)[:2].T @ felt[:2], atol=1e-9)


def friction_of(chain: Chain, speed: Floats, fade: float = 0.02) -> Floats:
    out: Floats = chain.joints["damping"] * speed + chain.joints["friction"] * np.tanh(speed / fade)
    return out


@quarter
@given(seed=SEEDS)
def test_friction_is_fed_by_the_speed_that_the_aim_asks_for(seed: int) -> None:
    chain = limb()
    q, qd = random_state(chain, seed)
    aim = still_aim(chain.place(q))
    aim["twist"] = chain.jacobian(q) @ np.array([0.3, -0.01])
    assume(np.linalg.cond(chain.jacobian(q)[:2]) < 1e4)
    settings = LawSettings(law="scct", feed_friction=0.8, **UNLOADED)
    wanted = 0.8 * friction_of(chain, np.array([0.3, -0.01]))
    np.testing.assert_allclose(tick(chain, settings, aim, q, qd), wanted, rtol=1e-6)


@quarter
@given(seed=SEEDS)
def test_friction_is_fed_by_the_measured_speed(seed: int) -> None:
    chain = limb()
    q, qd = random_state(chain, seed)
    settings = LawSettings(law="scct", feed_friction=1.0, friction_from="measured", **UNLOADED)
    torques = tick(chain, settings, random_aim(chain, q, seed), q, qd)
    np.testing.assert_allclose(torques, friction_of(chain, qd), rtol=1e-12)


@quarter
@given(seed=SEEDS)
def test_friction_is_fed_by_the_pull_of_the_law(seed: int) -> None:
    chain = limb()
    q, _ = random_state(chain, seed)
    settings = LawSettings(law="scct", feed_friction=1.0, friction_from="torque", feed_gravity=False)
    aim = random_aim(chain, q, seed)
    pull = tick(chain, settings.with_changes(feed_friction=0.0), aim, q, np.zeros(2))
    coulomb = chain.joints["friction"]
    wanted = pull + coulomb * np.tanh(pull / (0.1 * coulomb))
    np.testing.assert_allclose(tick(chain, settings, aim, q, np.zeros(2)), wanted, rtol=1e-12)


@quarter
@given(seed=SEEDS, scaled=st.booleans())
def test_torques_stay_within_the_motors_torque_speed_lines(seed: int, scaled: bool) -> None:
    chain = limb(limited=True)
    q, qd = random_state(chain, seed)
    qd = 4.0 * qd  # beyond the no-load speed of 3 rad/s too, and twice that
    settings = LawSettings(law="scct", kp=5000.0, scaled=scaled)
    torques = tick(chain, settings, random_aim(chain, q, seed), q, qd)
    limit, ratio = chain.joints["limit"], qd / chain.joints["speed"]
    high, low = np.clip(limit * (1.0 - ratio), -limit, limit), np.clip(-limit * (1.0 + ratio), -limit, limit)
    assert (torques <= high).all()
    assert (torques >= low).all()


@quarter
@given(seed=SEEDS)
def test_at_a_limit_torques_are_cut_off_or_shrink_together(seed: int) -> None:
    chain, free = limb(limited=True), limb()
    q, _ = random_state(chain, seed)
    still, aim = np.zeros(2), random_aim(chain, q, seed, away=0.1)
    settings = LawSettings(law="scct", kp=800.0)
    wanted = tick(free, settings, aim, q, still)
    limit = chain.joints["limit"]
    controller = Controller(chain, settings, period=PERIOD)
    cut = controller.command(aim, np.array([[q, still]]))[0]
    np.testing.assert_array_equal(cut, np.clip(wanted, -limit, limit))
    assert controller.reports["saturated"][0] == (np.abs(wanted) > limit).sum()
    shrunk = tick(chain, settings.with_changes(scaled=True), aim, q, still)
    np.testing.assert_allclose(shrunk, wanted * min(1.0, (limit / np.abs(wanted)).min()), rtol=1e-12)


def test_a_motor_faster_than_its_no_load_speed_only_brakes() -> None:
    chain = limb(limited=True)
    q, speed = np.array([0.6, -1.2]), chain.joints["speed"]
    aim = still_aim((0.2, 0.2))
    settings = LawSettings(law="jacobian-transpose", kp=(0.0, 1e6), kd=0.0)
    torques = tick(chain, settings, aim, q, 1.5 * speed)
    assert (torques <= -0.5 * chain.joints["limit"] * (1 - 1e-12)).all()
