"""Kinematics and dynamics of chains against Pinocchio and central differences."""

import numpy as np
import pytest
from random_chains import Pinocchio, limb, planar_chain, random_chain, random_state, tip_turn
from scipy.spatial.transform import Rotation

from clamber.control.chain import Chain

CASES = {
    "leg 1": limb("right"),
    "leg 3 upright": limb("bottom", upright=True),
    "plane arm of 3": planar_chain(3),
    **{f"spatial {n}": random_chain(n, n) for n in range(1, 8)},
    "spatial 4, second joint slides": random_chain(11, 4, sliding=1),
    "spatial 6, first joint slides": random_chain(12, 6, sliding=0),
    "spatial 5, last joint slides": random_chain(13, 5, sliding=4),
}
SEEDS = range(8)


@pytest.fixture(params=CASES, scope="module")
def chain(request: pytest.FixtureRequest) -> Chain:
    return CASES[request.param]


@pytest.fixture(scope="module")
def peer(chain: Chain) -> Pinocchio:
    return Pinocchio(chain)


def test_the_tip_is_where_pinocchio_has_it(chain: Chain, peer: Pinocchio) -> None:
    for seed in SEEDS:
        q, _ = random_state(chain, seed)
        place, turn = peer.place(q)
        np.testing.assert_allclose(chain.place(q), place, atol=1e-13)
        np.testing.assert_allclose(tip_turn(chain, q), turn, atol=1e-13)


def test_the_jacobian_is_pinocchios(chain: Chain, peer: Pinocchio) -> None:
    for seed in SEEDS:
        q, _ = random_state(chain, seed)
        np.testing.assert_allclose(chain.jacobian(q), peer.jacobian(q), atol=1e-12, rtol=0)


def test_the_inertia_matrix_is_pinocchios(chain: Chain, peer: Pinocchio) -> None:
    for seed in SEEDS:
        q, _ = random_state(chain, seed)
        np.testing.assert_allclose(chain.inertia(q), peer.inertia(q), atol=1e-12, rtol=0)


def test_the_bias_torques_are_pinocchios(chain: Chain, peer: Pinocchio) -> None:
    for seed in SEEDS:
        q, qd = random_state(chain, seed)
        np.testing.assert_allclose(chain.bias(q, qd), peer.bias(q, qd), atol=1e-11, rtol=0)


def test_the_weight_alone_is_the_bias_at_rest(chain: Chain, peer: Pinocchio) -> None:
    still = np.zeros(chain.n)
    for seed in SEEDS:
        q, _ = random_state(chain, seed)
        np.testing.assert_allclose(chain.bias(q, still), peer.bias(q, still), atol=1e-12, rtol=0)
        weightless = chain.with_gravity((0.0, 0.0, 0.0))
        np.testing.assert_allclose(weightless.bias(q, still), 0.0, atol=1e-15)


def test_the_drift_of_the_tip_is_pinocchios(chain: Chain, peer: Pinocchio) -> None:
    for seed in SEEDS:
        q, qd = random_state(chain, seed)
        np.testing.assert_allclose(chain.drift(q, qd), peer.drift(q, qd), atol=1e-12, rtol=0)


def test_the_jacobian_is_the_derivative_of_the_tips_place_and_turn(chain: Chain) -> None:
    step = 1e-6
    for seed in SEEDS:
        q, _ = random_state(chain, seed)
        numeric = np.empty((6, chain.n))
        for j, nudge in enumerate(step * np.eye(chain.n)):
            numeric[:3, j] = (chain.place(q + nudge) - chain.place(q - nudge)) / (2 * step)
            turned = tip_turn(chain, q + nudge) @ tip_turn(chain, q - nudge).T
            numeric[3:, j] = Rotation.from_matrix(turned).as_rotvec() / (2 * step)
        np.testing.assert_allclose(chain.jacobian(q), numeric, atol=1e-9)


def test_the_drift_is_the_derivative_of_the_jacobian_times_the_speed(chain: Chain) -> None:
    step = 1e-6
    for seed in SEEDS:
        q, qd = random_state(chain, seed)
        ahead, behind = chain.jacobian(q + step * qd), chain.jacobian(q - step * qd)
        np.testing.assert_allclose(chain.drift(q, qd), (ahead - behind) @ qd / (2 * step), atol=1e-8)


def test_the_coriolis_torques_follow_from_the_inertia_matrix(chain: Chain) -> None:
    # Lagrange: h = dM/dt qd - 1/2 grad (qd' M qd)
    weightless, step = chain.with_gravity((0.0, 0.0, 0.0)), 1e-6
    for seed in SEEDS:
        q, qd = random_state(chain, seed)
        rate = (chain.inertia(q + step * qd) - chain.inertia(q - step * qd)) / (2 * step)
        energy = [
            (qd @ (chain.inertia(q + nudge) - chain.inertia(q - nudge)) @ qd) / (4 * step)
            for nudge in step * np.eye(chain.n)
        ]
        np.testing.assert_allclose(weightless.bias(q, qd), rate @ qd - energy, atol=1e-8)


def test_a_payload_is_a_point_mass_at_the_tip() -> None:
    chain = random_chain(3, 5)
    loaded = chain.with_payload(0.7)
    q, qd = random_state(chain, 0)
    jacobian = chain.jacobian(q)[:3]
    np.testing.assert_allclose(loaded.inertia(q), chain.inertia(q) + 0.7 * jacobian.T @ jacobian, atol=1e-12)
    held = 0.7 * jacobian.T @ (chain.drift(q, qd)[:3] - chain.root["gravity"][0])
    np.testing.assert_allclose(loaded.bias(q, qd), chain.bias(q, qd) + held, atol=1e-12)
