"""The laws that solve no programme against independent calculations: MuJoCo's dynamics, pseudo-inverses, SciPy's inverse kinematics."""

import itertools

import mujoco
import numpy as np
import pytest
from scipy.optimize import least_squares

import clamber
from clamber.control.whole_body.law import BodyLaw
from clamber.control.whole_body.programme import HOLDS, SWINGS, Gains, Limits
from clamber.control.whole_body.tree import State, Tree
from clamber.errors import UnknownNameError
from clamber.families.spatial.control.laws import BODY_LAWS, body_law
from clamber.families.spatial.trials.law_trials import first_steps, spatial_task, time_loop
from control.whole_body.trees import as_mujoco, posed, random_state, random_tree
from plain_spatial import turn_about

GAINS = Gains(arm=0.3, wrench=1e-6)
SIMPLER = sorted(set(BODY_LAWS) - {"whole-body"})


def law_of(name: str, tree: Tree, state: State, components: int = 3) -> BodyLaw:
    """A law of wide limits, in a state, whose every limb holds on and bears anything."""
    n = tree.joints
    limits = Limits(np.full(n, 1e4), np.full(n, -9.0), np.full(n, 9.0), np.full(n, 1e3), np.zeros(n))
    law = body_law(name)(tree, limits, GAINS, most_rows=9)
    for kept, values in zip(law.state, state, strict=True):
        kept[:] = values
    law.look()
    law.aims.rotation[:], law.aims.position[:] = state.rotation, state.position
    law.aims.does[:], law.aims.components[:] = HOLDS, components
    law.aims.posture[:] = state.joints
    return law


def busy(name: str, seed: int) -> BodyLaw:
    """One whose robot moves anyhow and misses its aims, one limb of which swings, and whose wanted wrenches do not balance."""
    tree = random_tree(seed, limbs=4, slide=False)
    law = law_of(name, tree, random_state(tree, seed, speed=0.3))
    random = np.random.default_rng(seed)
    aims = law.aims
    aims.position[:] += random.normal(size=3) * 0.01
    aims.rotation[:] = turn_about(np.array((0.0, 0.6, 0.8)), 0.03) @ aims.rotation
    aims.velocity[:], aims.acceleration[:] = random.normal(size=(2, 6))
    aims.posture[:] += random.normal(size=tree.joints) * 0.1
    aims.wrench[:] = random.normal(size=(4, 6))
    aims.cap[1] = 3.0
    aims.does[2] = SWINGS
    aims.tip[2] = law.dynamics.tip[2] + random.normal(size=3) * 0.01
    aims.tip_velocity[2], aims.tip_acceleration[2] = random.normal(size=(2, 3))
    return law


def generalised(law: BodyLaw, wrenches: np.ndarray) -> np.ndarray:
    """What MuJoCo makes of the contacts' wrenches as generalised forces."""
    model = as_mujoco(law.tree)
    data = posed(model, law.state)
    total = np.zeros(model.nv)
    for limb in np.flatnonzero(law.aims.does == HOLDS):
        frame = law.aims.frame[limb].T
        force, moment = frame @ wrenches[limb, :3], frame @ wrenches[limb, 3:]
        one = np.zeros(model.nv)
        mujoco.mj_applyFT(model, data, force, moment, law.dynamics.tip[limb], int(law.tree.end[limb]) + 1, one)
        total += one
    return total


def known(law: BodyLaw) -> tuple[np.ndarray, np.ndarray, np.ndarray, list[np.ndarray]]:
    """Mass matrix, bias forces, weight and tips' Jacobians (velocity, angular velocity) by MuJoCo."""
    model = as_mujoco(law.tree)
    data = posed(model, law.state)
    mass = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, mass)
    bias = data.qfrc_bias.copy()
    jacobians = []
    for limb in range(law.tree.limbs):
        both = np.zeros((2, 3, model.nv))
        mujoco.mj_jacSite(model, data, both[0], both[1], limb)
        jacobians.append(both.reshape(6, -1))
    data.qvel[:] = 0.0
    mujoco.mj_forward(model, data)
    return mass, bias, data.qfrc_bias.copy(), jacobians


def wanted_base(law: BodyLaw) -> np.ndarray:
    """Accelerations of the base by its feedback, the angular ones in its own frame."""
    aims, state, rate = law.aims, law.state, GAINS.base_rate
    turn = state.rotation
    off = 0.5 * sum(np.cross(turn[:, c], aims.rotation[:, c]) for c in range(3))
    linear = aims.acceleration[:3] + 2 * rate * (aims.velocity[:3] - state.speed[:3])
    angular = aims.acceleration[3:] + 2 * rate * (aims.velocity[3:] - turn @ state.speed[3:6]) + rate**2 * off
    return np.concatenate((linear + rate**2 * (aims.position - state.position), turn.T @ angular))


def shared(law: BodyLaw, base: np.ndarray, jacobians: list[np.ndarray]) -> np.ndarray:
    """Wrenches nearest to the wanted ones that put such forces on the base, by a pseudo-inverse; shape (limbs, 6)."""
    out, columns, at, weights = np.zeros((law.tree.limbs, 6)), [], [], []
    for limb in np.flatnonzero(law.aims.does == HOLDS):
        part = min(1.0, law.aims.cap[limb] / (law.tree.mass.sum() * np.linalg.norm(law.tree.gravity)))
        for c in range(3):
            columns.append(jacobians[limb][:3, :6].T @ law.aims.frame[limb, c])
            at.append((limb, c))
            weights.append(part)
    start = np.array([law.aims.wrench[place] for place in at])
    balance, scale = np.array(columns).T, np.array(weights)
    moved = scale * (np.linalg.pinv(balance * scale) @ (base - balance @ start))
    for place, value in zip(at, start + moved, strict=True):
        out[place] = value
    return out


@pytest.mark.slow
@pytest.mark.parametrize("components", [3, 6])
@pytest.mark.parametrize("name", BODY_LAWS)
def test_at_rest_torques_and_contacts_balance_the_weight(name: str, components: int) -> None:
    tree = random_tree(2, limbs=4, slide=False)
    law = law_of(name, tree, random_state(tree, 2, speed=0.0), components)
    law.tick()
    weight = known(law)[2]
    left = weight - generalised(law, law.wrenches)
    left[6:] -= law.torques
    assert law.failures == 0
    assert np.abs(left).max() < (
        1.0 if name == "whole-body" else 1e-6
    )  # its programme weighs the weight against wrenches


@pytest.mark.parametrize("seed", range(3))  # of seed 3 the tasks are near to dependent, and damped
def test_operational_space_is_that_of_pseudo_inverses(seed: int) -> None:
    law = busy("operational-space", seed)
    torques = law.tick().copy()
    mass, bias, _, jacobians = known(law)
    aims, dynamics, state = law.aims, law.dynamics, law.state
    contacts = np.flatnonzero(aims.does == HOLDS)
    jc = np.vstack([jacobians[limb][:3] for limb in contacts])
    rest = np.concatenate([-GAINS.rest_rate * dynamics.tip_speed[k, :3] - dynamics.tip_bias[k, :3] for k in contacts])
    rate, tip = GAINS.swing_rate, aims.tip_acceleration[2] - dynamics.tip_bias[2, :3]
    tip = (
        tip + rate**2 * (aims.tip[2] - dynamics.tip[2]) + 2 * rate * (aims.tip_velocity[2] - dynamics.tip_speed[2, :3])
    )
    lean = GAINS.posture_rate**2 * (aims.posture - state.joints) - 2 * GAINS.posture_rate * state.speed[6:]
    base = wanted_base(law)
    found, free = np.concatenate((base, lean)), np.eye(len(mass))
    inverse = np.linalg.inv(mass)
    for jacobian, wanted in ((jc, rest), (np.eye(len(mass))[:6], base), (jacobians[2][:3], tip)):
        left = jacobian @ free
        back = free @ inverse @ left.T @ np.linalg.pinv(left @ inverse @ left.T, rcond=1e-9)
        found = found + back @ (wanted - jacobian @ found)
        free = free - back @ left
    total = mass @ found + bias
    wrenches = shared(law, total[:6], jacobians)
    assert np.allclose(law.wrenches, wrenches, atol=1e-5 * np.abs(total).max())
    expected = total - generalised(law, wrenches)
    assert np.abs(expected[:6]).max() < 1e-5 * np.abs(total).max()
    assert np.allclose(torques, expected[6:], atol=1e-5 * np.abs(total).max())
    projector = np.eye(len(mass)) - np.linalg.pinv(jc) @ jc
    assert np.allclose(
        projector @ np.concatenate((np.zeros(6), torques)), projector @ total, atol=1e-5 * np.abs(total).max()
    )


@pytest.mark.parametrize("seed", range(4))
def test_jacobian_transpose_pulls_by_springs_and_bears_the_weight(seed: int) -> None:
    law = busy("jacobian-transpose", seed)
    torques = law.tick().copy()
    mass, _, weight, jacobians = known(law)
    aims, dynamics, state = law.aims, law.dynamics, law.state
    base = weight[:6] + mass[:6, :6] @ wanted_base(law)
    lean = GAINS.posture_rate**2 * (aims.posture - state.joints) - 2 * GAINS.posture_rate * state.speed[6:]
    expected = weight[6:] + np.diag(mass)[6:] * lean - generalised(law, shared(law, base, jacobians))[6:]
    rate = GAINS.swing_rate
    tip = aims.tip_acceleration[2] + rate**2 * (aims.tip[2] - dynamics.tip[2])
    tip = tip + 2 * rate * (aims.tip_velocity[2] - dynamics.tip_speed[2, :3])
    for row, wanted in zip(jacobians[2][:3, 6:], tip, strict=True):
        expected += row * wanted / (1.0 / law.tree.mass.sum() + (row**2 / np.diag(mass)[6:]).sum())
    assert np.allclose(torques, expected, atol=1e-6 * np.abs(expected).max())


@pytest.mark.parametrize("seed", [1, 2])  # of seeds 0 and 3 a tip cannot come to where it is to be
def test_joint_impedance_pulls_to_the_joints_of_inverse_kinematics(seed: int) -> None:
    law = busy("joint-impedance", seed)
    tree, aims, state = law.tree, law.aims, law.state
    held = law.dynamics.tip.copy()
    aims.posture[:] = state.joints
    for _ in range(30):  # its steps come from tick to tick
        torques = law.tick().copy()
    model = as_mujoco(tree)
    goals = np.where((aims.does == SWINGS)[:, None], aims.tip, held)

    def placed(joints: np.ndarray) -> mujoco.MjData:
        return posed(model, State(aims.rotation, aims.position, np.zeros(tree.speeds), joints))

    found = least_squares(lambda q: (placed(q).site_xpos - goals).ravel(), state.joints, xtol=1e-14, ftol=1e-14).x
    data = placed(found)
    assert np.abs(data.site_xpos - goals).max() < 1e-6
    mass, _, weight, jacobians = known(law)
    base = np.concatenate((aims.velocity[:3], aims.rotation.T @ aims.velocity[3:]))
    speed = np.zeros(tree.joints)
    stiffness, inertias = np.zeros(tree.joints), np.diag(mass)[6:].copy()
    for limb, does in enumerate(aims.does):
        mine = slice(3 * limb, 3 * limb + 3)
        jacobian, turning = np.zeros((2, 3, model.nv))
        mujoco.mj_jacSite(model, data, jacobian, turning, limb)
        moved = aims.tip_velocity[limb] if does == SWINGS else 0.0
        speed[mine] = np.linalg.solve(jacobian[:, 6:][:, mine], moved - jacobian[:, :6] @ base)
        if does == HOLDS:
            inertias[mine] += tree.mass.sum() / 3 * (jacobians[limb][:3, 6:][:, mine] ** 2).sum(axis=0)
    stiffness = np.minimum(GAINS.swing_rate**2 * inertias, law.limits.torque / 0.05)
    expected = weight[6:] + stiffness * (found - state.joints)
    expected += 2 * np.sqrt(stiffness * inertias) * (speed - state.speed[6:])
    expected -= generalised(law, shared(law, weight[:6], jacobians))[6:]
    assert np.allclose(torques, expected, atol=1e-4 * np.abs(expected).max())


@pytest.mark.parametrize(("name", "turned"), list(itertools.product(SIMPLER, (False, True))))
def test_a_robot_without_contacts_is_told_of_and_torques_keep_their_limits(name: str, turned: bool) -> None:
    law = busy(name, 1)
    law.limits.torque[:] = 0.5
    if turned:
        law.aims.does[:] = SWINGS
    law.tick()
    assert law.failures == int(turned)
    assert np.abs(law.torques).max() <= 0.5


def test_a_law_that_is_not_there_is_refused_with_those_that_are() -> None:
    with pytest.raises(UnknownNameError, match="operational-space"):
        body_law("operational-spice")


def test_a_timed_loop_is_more_than_its_physics() -> None:
    task = spatial_task("wall-gripper")
    told = time_loop(task, first_steps(task), rounds=1)
    real, share, ratio = (measured for measured, _, _ in told.values())
    assert real > 0.0 and 0.0 < share < 1.0
    assert ratio == pytest.approx(1.0 / share)


@pytest.mark.slow
def test_python_takes_the_law_of_a_run_and_of_trials() -> None:
    task = spatial_task("wall-gripper")
    plan = first_steps(task)
    usual, springs = (clamber.run(plan, law=law) for law in (None, "jacobian-transpose"))
    assert usual.done and springs.done
    assert springs.report.off > 5.0 * usual.report.off, "springs without the mass matrix lag behind"
    tried = clamber.trials(plan, 1, noise="none", law="jacobian-transpose", workers=1)
    assert tried.ended[0].off == pytest.approx(springs.report.off)
    assert tried.setup.law == "jacobian-transpose"
    paired = tried.against(clamber.trials(plan, 1, noise="none", workers=1))
    assert paired.both == 1
