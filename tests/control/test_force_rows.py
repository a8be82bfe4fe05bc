"""Laws that feel or carry a force: admittance, hybrid, implicit force."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from random_chains import PERIOD, limb, random_state, tick

from clamber.control.controller import Controller, still_aim
from clamber.control.law_settings import LawSettings

SEEDS = st.integers(0, 10_000)


def test_an_admittance_yields_to_a_steady_force_like_its_spring() -> None:
    chain = limb()
    q = np.array([0.6, -1.2])
    settings = LawSettings(law="admittance", mass=1.0, admittance_kp=100.0, admittance_kd=40.0, joint_kd=10.0, kp=100.0)
    controller = Controller(chain, settings, period=PERIOD)
    felt = np.array([[4.0, -2.0, 0.0, 0.0, 0.0, 0.0]])
    for _ in range(2000):
        torques = controller.command(still_aim(chain.place(q)), np.array([[q, [0.0, 0.0]]]), felt)
    yielded = -felt[0, :2] / 100.0  # the limb presses by `felt`, so the aim gives way
    wanted = chain.joints["share"] * np.linalg.solve(chain.jacobian(q)[:2], 100.0 * yielded)
    np.testing.assert_allclose(torques[0], wanted, rtol=1e-6)


@given(seed=SEEDS)
def test_hybrid_puts_the_wanted_force_on_a_forced_row_and_no_spring(seed: int) -> None:
    chain = limb()
    q, _ = random_state(chain, seed)
    settings = LawSettings(law="hybrid", forced=("x",), angle=0.5, sigma=0.0, feed_gravity=False)
    aim = still_aim(
        chain.place(q) + 0.05 * np.append(settings.task_frame()[:2, 0], 0.0)
    )  # off along the forced row only
    aim["wrench"] = np.append(7.0 * settings.task_frame()[:, 0], np.zeros(3))
    torques = tick(chain, settings, aim, q, np.zeros(2))
    np.testing.assert_allclose(torques, chain.jacobian(q)[:2].T @ aim["wrench"][0, :2], atol=1e-7)


def test_hybrid_integrates_the_error_of_a_sensed_force_to_its_limit() -> None:
    chain = limb()
    q = np.array([0.6, -1.2])
    settings = LawSettings(law="hybrid", forced=("x",), force_gain=2.0, force_limit=5.0, feed_gravity=False)
    controller = Controller(chain, settings, period=PERIOD)
    aim = still_aim(chain.place(q))
    aim["wrench"][0, 0] = 10.0
    felt, state = np.array([[6.0, 0, 0, 0, 0, 0]]), np.array([[q, [0.0, 0.0]]])
    for k in range(1, 200):
        torques = controller.command(aim, state, felt)
        force = 10.0 + min(2.0 * PERIOD * 4.0 * k, 5.0)
        np.testing.assert_allclose(torques[0], chain.jacobian(q)[0] * force, rtol=1e-9)


def test_implicit_force_aims_as_deep_as_the_surface_yields() -> None:
    chain = limb()
    q = np.array([0.6, -1.2])
    settings = LawSettings(law="implicit-force", forced=("x",), environment=5000.0, kp=150.0, feed_gravity=False)
    aim = still_aim(chain.place(q))
    aim["wrench"][0, 0] = 10.0
    jacobian = chain.jacobian(q)[:2]
    wanted = chain.joints["share"] * np.linalg.solve(jacobian, [150.0 * 10.0 / 5000.0, 0.0]) + jacobian[0] * 10.0
    np.testing.assert_allclose(tick(chain, settings, aim, q, np.zeros(2)), wanted, rtol=1e-10)
