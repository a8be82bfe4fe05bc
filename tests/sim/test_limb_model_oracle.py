"""The limb's MuJoCo model against the chain that it was built from: one is the other's oracle."""

from typing import Any

import mujoco
import numpy as np
import pytest

from clamber.control.chain import Chain, empty_chain
from clamber.control.controller import Controller, still_aim
from clamber.control.law_settings import LawSettings
from clamber.families.climber.control.limb_chain import chain_of_limb
from clamber.sim.limb_flaws import LimbFlaws
from clamber.sim.limb_model import SMALL_MASS, limb_spec
from clamber.tasks.robots import load_robot


def spatial_arm() -> Chain:
    """Five joints about and along skew axes, the third sliding, with full inertias."""
    rng = np.random.default_rng(5)
    joints, root = empty_chain(5)
    joints["place"] = rng.normal(size=(5, 3)) * 0.2
    axes = rng.normal(size=(5, 3))
    joints["axis"] = axes / np.linalg.norm(axes, axis=1)[:, None]
    for j in range(5):
        joints["turn"][j] = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        joints["turn"][j] *= np.sign(np.linalg.det(joints["turn"][j]))
        joints["inertia"][j] = 1e-3 * (np.eye(3) + 0.2 * np.ones((3, 3)))
    joints["sliding"][2] = 1
    joints["mass"], joints["rotor"] = rng.uniform(0.2, 1.0, 5), rng.uniform(0.01, 0.5, 5)
    joints["centre"] = rng.normal(size=(5, 3)) * 0.1
    joints["damping"], joints["friction"] = 0.3, 0.2
    root["tip"], root["gravity"] = rng.normal(size=3) * 0.2, (0.5, -3.0, -9.0)
    return Chain("skew arm", tuple("abcde"), joints, root)


CHAINS = {
    "leg 1 upright": chain_of_limb(load_robot("libra"), "right", upright=True),  # type: ignore[arg-type]
    "skew arm": spatial_arm(),
}


@pytest.fixture(params=CHAINS)
def pair(request: pytest.FixtureRequest) -> tuple[Chain, Any, Any]:
    """A chain, with what the model adds to light links, and MuJoCo's model and data of it."""
    chain = CHAINS[request.param]
    model = limb_spec(chain, LimbFlaws()).compile()
    joints = chain.joints.copy()
    joints["inertia"] += SMALL_MASS * np.eye(3)
    same = Chain(chain.name, chain.joint_names, joints, chain.root, plane=chain.plane)
    return same, model, mujoco.MjData(model)


def pose(model: Any, data: Any, seed: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    data.qpos[:], data.qvel[:] = rng.uniform(-2.0, 2.0, model.nq), rng.normal(size=model.nv)
    mujoco.mj_forward(model, data)
    return data.qpos.copy(), data.qvel.copy()


@pytest.mark.parametrize("seed", range(5))
def test_the_tip_and_its_jacobian_are_mujocos(pair: tuple[Chain, Any, Any], seed: int) -> None:
    chain, model, data = pair
    q, _ = pose(model, data, seed)
    site = model.site("tip").id
    np.testing.assert_allclose(chain.place(q), data.site_xpos[site], atol=1e-12)
    jacobian = np.zeros((6, chain.n))
    mujoco.mj_jacSite(model, data, jacobian[:3], jacobian[3:], site)
    np.testing.assert_allclose(chain.jacobian(q), jacobian, atol=1e-12)


@pytest.mark.parametrize("seed", range(5))
def test_the_inertia_matrix_is_mujocos(pair: tuple[Chain, Any, Any], seed: int) -> None:
    chain, model, data = pair
    q, _ = pose(model, data, seed)
    inertia = np.zeros((chain.n, chain.n))
    mujoco.mj_fullM(model, data, inertia)
    np.testing.assert_allclose(chain.inertia(q), inertia, atol=1e-10)


@pytest.mark.parametrize("seed", range(5))
def test_the_bias_torques_are_mujocos(pair: tuple[Chain, Any, Any], seed: int) -> None:
    chain, model, data = pair
    q, qd = pose(model, data, seed)
    np.testing.assert_allclose(chain.bias(q, qd), data.qfrc_bias, atol=1e-10)


@pytest.mark.parametrize("seed", range(5))
def test_the_chain_as_the_law_has_it_is_within_a_millionth_of_the_model(seed: int) -> None:
    chain = CHAINS["leg 1 upright"]  # without the small inertia that the model adds
    model = limb_spec(chain, LimbFlaws()).compile()
    data = mujoco.MjData(model)
    q, qd = pose(model, data, seed)
    inertia = np.zeros((2, 2))
    mujoco.mj_fullM(model, data, inertia)
    np.testing.assert_allclose(chain.inertia(q), inertia, atol=4e-6)
    np.testing.assert_allclose(chain.bias(q, qd), data.qfrc_bias, atol=1e-5)


@pytest.mark.parametrize("seed", range(5))
def test_operational_space_accelerates_mujocos_tip_as_it_commands(seed: int) -> None:
    # Friction apart, which the law leaves out
    chain = CHAINS["leg 1 upright"]
    model = limb_spec(chain, LimbFlaws(friction=0.0, damping=0.0)).compile()
    data = mujoco.MjData(model)
    rng = np.random.default_rng(seed)
    q, qd = np.array([rng.uniform(-1.0, 1.0), rng.uniform(0.5, 1.5)]), rng.normal(size=2) * 0.2
    aim = still_aim(chain.place(q) + np.append(0.005 * rng.normal(size=2), 0.0))
    settings = LawSettings(law="operational-space", kp=100.0, kd=20.0)
    torques = Controller(chain, settings, period=0.005).command(aim, np.array([[q, qd]]))[0]
    data.qpos[:], data.qvel[:], data.ctrl[:] = q, qd, torques
    mujoco.mj_forward(model, data)
    jacobian = chain.jacobian(q)[:2]
    got = jacobian @ data.qacc + chain.drift(q, qd)[:2]
    wanted = 100.0 * (aim["place"][0, :2] - chain.place(q)[:2]) - 20.0 * jacobian @ qd
    np.testing.assert_allclose(got, wanted, atol=1e-4)  # the model's 1e-6 kg m^2 in some 0.4
