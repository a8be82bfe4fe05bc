"""The whole-body law against closed forms, MuJoCo's inverse dynamics, and its own limits."""

import math

import daqp
import mujoco
import numpy as np
import pytest

from clamber.control.whole_body.law import WholeBody
from clamber.control.whole_body.programme import HOLDS, SWINGS, Gains, Limits, Programme
from clamber.control.whole_body.programme_kernels import write_equations, write_rows
from clamber.control.whole_body.tree import State, Tree
from control.whole_body.trees import as_mujoco, posed, random_state, random_tree


def law_of(tree: Tree, state: State, torque: float = 1e3, **gains: float) -> WholeBody:
    """A law of wide limits, in a state, whose every limb holds on and bears anything."""
    n = tree.joints
    limits = Limits(np.full(n, torque), np.full(n, -9.0), np.full(n, 9.0), np.full(n, 1e3), np.zeros(n))
    law = WholeBody(tree, limits, Gains(arm=0.3, **gains), most_rows=9)
    for name in State._fields:
        getattr(law.state, name)[:] = getattr(state, name)
    law.look()
    law.aims.rotation[:], law.aims.position[:] = state.rotation, state.position
    law.aims.does[:] = HOLDS
    law.aims.posture[:] = state.joints
    return law


def accelerations(law: WholeBody) -> np.ndarray:
    """What MuJoCo's forward dynamics make of the law's torques and wrenches."""
    model = as_mujoco(law.tree)
    data = posed(model, law.state)
    data.qfrc_applied[6:] = law.torques
    for limb in range(law.tree.limbs):
        turned = np.kron(np.eye(2), law.aims.frame[limb].T) @ law.wrenches[limb]
        force = np.zeros(model.nv)
        mujoco.mj_applyFT(
            model, data, turned[:3], turned[3:], law.dynamics.tip[limb], int(law.tree.end[limb]) + 1, force
        )
        data.qfrc_applied[:] += force
    mujoco.mj_forward(model, data)
    return data.qacc.copy()


@pytest.mark.parametrize("seed", range(3))
def test_torques_and_wrenches_bring_the_accelerations_that_are_asked_for(seed: int) -> None:
    tree = random_tree(seed, limbs=4, slide=False)
    law = law_of(tree, random_state(tree, seed, speed=0.3), wrench=1e-9, posture=1e-9, holding=1e-9)
    law.aims.velocity[:] = (*law.state.speed[:3], *(law.state.rotation @ law.state.speed[3:6]))
    law.aims.acceleration[:] = 0.5, -0.2, 0.3, 1.0, 0.4, -0.7
    law.tick()
    assert law.failures == 0
    found = accelerations(law)
    wanted = np.concatenate((law.aims.acceleration[:3], law.state.rotation.T @ law.aims.acceleration[3:]))
    assert np.allclose(found[:6], wanted, atol=1e-3)


@pytest.mark.parametrize("seed", range(3))
def test_torques_bear_friction_as_joints_move_and_never_more_than_it(seed: int) -> None:
    """The power of what is added is that of the friction it bears, and less: no joint moves by it alone."""
    tree = random_tree(seed, limbs=4)
    law = law_of(tree, random_state(tree, seed, speed=0.3), wrench=1e-9, posture=1e-9)
    bare = law.tick().copy()
    asked = accelerations(law)[6:]
    law.limits.friction[:] = np.random.default_rng(seed).uniform(0.5, 2.0, tree.joints)
    added = law.tick() - bare
    assert np.abs(added).max() > 0.0
    assert (np.abs(added) <= 0.8 * law.limits.friction + 1e-12).all()
    ahead = law.state.speed[6:] + asked / law.gains.speed_rate
    assert (added * ahead >= -1e-9).all()
    law.state.speed[:] = 0.0
    law.look()
    law.aims.velocity[:] = law.aims.acceleration[:] = 0.0
    law.limits.friction[:] = 0.0
    still = law.tick().copy()
    law.limits.friction[:] = 1.0
    assert np.abs(law.tick() - still).max() < 1e-3, "at rest where it is to be nothing moves"


def test_the_torques_are_those_of_mujocos_inverse_dynamics() -> None:
    tree = random_tree(5, limbs=3)
    law = law_of(tree, random_state(tree, 5, speed=0.3))
    torques = law.tick().copy()
    model = as_mujoco(tree)
    data = posed(model, law.state)
    data.qacc[:] = accelerations(law)
    for limb in range(tree.limbs):
        turned = np.kron(np.eye(2), law.aims.frame[limb].T) @ law.wrenches[limb]
        data.qfrc_inverse[:] = 0.0
        force = np.zeros(model.nv)
        mujoco.mj_applyFT(model, data, turned[:3], turned[3:], law.dynamics.tip[limb], int(tree.end[limb]) + 1, force)
        torques_of_contact = force
        torques = torques + torques_of_contact[6:]
    mujoco.mj_inverse(model, data)
    assert np.allclose(torques, data.qfrc_inverse[6:], atol=1e-6)


@pytest.mark.parametrize("seed", range(12))
def test_torques_are_those_of_the_solver_whether_anything_binds_or_not(seed: int) -> None:
    tree = random_tree(seed, limbs=4, slide=False)
    state = random_state(tree, seed, speed=0.3)
    free = np.abs(law_of(tree, state).tick()).max()
    called = []
    for share in (10.0, 0.7):
        law = law_of(tree, state, torque=share * free)
        law.aims.acceleration[:3] = 0.3, -0.2, 0.1
        found, wrenches = law.tick().copy(), law.wrenches.copy()
        called.append(bool(law.told))
        programme = Programme.of(tree, 9)
        n, m = write_equations(tree, law.state, law.dynamics, law.aims, law.limits, law.gains.packed(), programme)
        write_rows(law.aims, programme, n, m, tree.speeds)
        a = programme.a[: m * n].reshape(m, n)
        bounds = programme.upper[: n + m], programme.lower[: n + m], programme.sense[: n + m]
        x, _, flag, _ = daqp.solve(programme.h[: n * n].reshape(n, n), programme.f[:n], a, *bounds)
        assert flag == 1
        assert np.allclose(found, law.dynamics.bias[6:] + a[6 : tree.speeds] @ x, rtol=1e-6, atol=1e-6 * free)
        assert np.allclose(wrenches[:, :3].ravel(), x[tree.speeds :], rtol=1e-5, atol=1e-5 * free)
    assert called == [False, True]  # what binds is the solver's


def test_a_robot_at_rest_with_nothing_to_do_bears_its_weight() -> None:
    tree = random_tree(2, limbs=4, slide=False)
    law = law_of(tree, random_state(tree, 2, speed=0.0), wrench=1e-6)
    law.tick()
    total = sum(law.aims.frame[limb].T @ law.wrenches[limb, :3] for limb in range(4))
    assert np.allclose(total, -tree.mass.sum() * tree.gravity, atol=1e-2)


def test_limits_of_torques_and_cones_are_kept() -> None:
    tree = random_tree(3, limbs=4, slide=False)
    state = random_state(tree, 3, speed=0.0)
    free = law_of(tree, state)
    free.aims.acceleration[:3] = 3.0
    free.tick()
    most = 0.7 * float(np.abs(free.torques).max())
    law = law_of(tree, state, torque=most)
    law.aims.acceleration[:3] = 3.0
    for limb in range(4):
        for k in range(8):
            angle = math.tau * k / 8
            law.aims.rows[limb, k, :3] = -0.5, math.cos(angle), math.sin(angle)
        law.aims.n_rows[limb] = 8
        law.aims.limits[limb] = 5.0
    law.tick()
    assert np.abs(law.torques).max() <= most + 1e-9
    if law.failures == 0:
        room = law.aims.limits[:, :8] - np.einsum("lrc,lc->lr", law.aims.rows[:, :8], law.wrenches)
        assert room.min() > -1e-5


def test_a_limb_without_a_cap_bears_nothing_and_a_cap_is_kept() -> None:
    tree = random_tree(4, limbs=4, slide=False)
    law = law_of(tree, random_state(tree, 4, speed=0.0))
    law.aims.cap[0], law.aims.cap[1] = 0.0, 2.0
    law.tick()
    assert not law.wrenches[0].any()
    assert np.abs(law.wrenches[1]).max() <= 2.0 + 1e-6


def test_a_swinging_tip_gets_its_acceleration() -> None:
    tree = random_tree(6, limbs=4, slide=False)
    law = law_of(tree, random_state(tree, 6, speed=0.0), swing=1e4, wrench=1e-9, posture=1e-9)
    law.aims.does[2] = SWINGS
    law.aims.tip[2] = law.dynamics.tip[2]
    law.aims.tip_velocity[2] = law.dynamics.tip_speed[2, :3]
    law.aims.tip_acceleration[2] = 1.0, -2.0, 0.5
    law.tick()
    found = accelerations(law)
    tip = law.dynamics.jacobian[2, :3] @ found + law.dynamics.tip_bias[2, :3]
    assert np.allclose(tip, (1.0, -2.0, 0.5), atol=0.05)


def test_a_joint_at_its_limit_does_not_go_on() -> None:
    tree = random_tree(8, limbs=4, slide=False)
    state = random_state(tree, 8, speed=0.0)
    law = law_of(tree, state)
    law.aims.acceleration[:3] = 2.0
    law.tick()
    free = accelerations(law)[6:]
    worst = int(np.argmax(free))
    law.limits.upper[worst] = state.joints[worst]
    law.tick()
    assert law.failures == 0
    assert accelerations(law)[6 + worst] < 0.1 * free[worst]
