"""A floating tree's dynamics against MuJoCo's."""

import mujoco
import numpy as np
import pytest

from clamber.control.whole_body.tree import Dynamics
from clamber.control.whole_body.tree_kernels import work_out
from control.whole_body.trees import as_mujoco, posed, random_state, random_tree


@pytest.mark.parametrize("seed", range(4))
def test_mass_bias_and_tips_are_those_of_mujoco(seed: int) -> None:
    tree = random_tree(seed, limbs=2 + seed, joints=3 + seed)
    state, out, model = random_state(tree, seed), Dynamics.of(tree), as_mujoco(tree)
    data = posed(model, state)
    work_out(tree, state, out)
    mass = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, mass)
    assert np.allclose(out.mass, mass, atol=1e-10)
    assert np.allclose(out.bias, data.qfrc_bias, atol=1e-9)
    for limb in range(tree.limbs):
        site = model.site(str(limb)).id
        assert np.allclose(out.tip[limb], data.site_xpos[site], atol=1e-12)
        assert np.allclose(out.tip_turn[limb].ravel(), data.site_xmat[site], atol=1e-12)
        place, turn = np.zeros((3, model.nv)), np.zeros((3, model.nv))
        mujoco.mj_jacSite(model, data, place, turn, site)
        assert np.allclose(out.jacobian[limb], np.vstack((place, turn)), atol=1e-12)
        body = model.site_bodyid[site]
        mujoco.mj_jacDot(model, data, place, turn, data.site_xpos[site], body)
        assert np.allclose(out.tip_bias[limb], np.vstack((place, turn)) @ data.qvel, atol=1e-9)


def test_weight_is_the_bias_of_a_robot_at_rest() -> None:
    tree = random_tree(7)
    moving, out = random_state(tree, 1), Dynamics.of(tree)
    work_out(tree, moving, out)
    weight = out.weight.copy()
    work_out(tree, moving._replace(speed=np.zeros(tree.speeds)), out)
    assert np.allclose(weight, out.bias, atol=1e-12)
    assert np.allclose(weight[:3], -tree.mass.sum() * tree.gravity)
