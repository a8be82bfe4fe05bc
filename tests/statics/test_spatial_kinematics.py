"""Kinematics of limbs in space: frames and weights against matrices, energies and MuJoCo, Jacobians against differences."""

import mujoco
import numpy as np
import pytest

from clamber.families.spatial.robot.chains import Chains
from clamber.families.spatial.statics.gravity_kernels import base_weight, limb_weight
from clamber.families.spatial.statics.judging import Statics, rules_record
from clamber.families.spatial.statics.kinematics_kernels import limb_frames, reach_point, tip_jacobian
from clamber.families.spatial.statics.records import WORK
from clamber.types import Floats, Records
from plain_spatial import frames, limb_energy
from spatial_machines import arms, point_foot, random_postures, random_stances, spider

MACHINES = {"spider": spider(4), "arms": arms(3), "seven joints": arms(2, 7), "slides": arms(3, 6, slide=True)}
AT_HOME = np.eye(4)


def solved(chains: Chains, postures: Floats) -> tuple[Statics, Records]:
    """Scratch that describes all limbs in a posture of shape (limbs, joints)."""
    statics = Statics(chains, [point_foot(0.5)] * len(chains.limb_names))
    work = np.zeros(1, WORK)
    work["posture"][0, : postures.shape[0], : postures.shape[1]] = postures
    for limb in range(statics.n_limbs):
        limb_frames(statics.robot[0], limb, work[0])
        tip_jacobian(statics.robot[0], limb, work[0])
    return statics, work


@pytest.mark.parametrize("machine", MACHINES)
def test_frames_are_products_of_matrices(machine: str) -> None:
    chains = MACHINES[machine]
    for posture in random_postures(chains, 10, 1.0, np.random.default_rng(1)):
        _, work = solved(chains, posture)
        for limb, n in enumerate(chains.n_joints):
            expected = frames(chains, limb, posture[limb], AT_HOME)
            for k in range(n):
                assert work["origin"][0, limb, k] == pytest.approx(expected[k][:3, 3], abs=1e-14)
                assert work["turn"][0, limb, k].reshape(3, 3) == pytest.approx(expected[k][:3, :3], abs=1e-14)
            assert work["origin"][0, limb, n] == pytest.approx(expected[n][:3, 3], abs=1e-14)
            assert work["tip_turn"][0, limb].reshape(3, 3) == pytest.approx(expected[n][:3, :3], abs=1e-14)


@pytest.mark.parametrize("machine", MACHINES)
def test_jacobians_are_differences_of_the_tip(machine: str) -> None:
    chains = MACHINES[machine]
    step = 1e-6
    for posture in random_postures(chains, 5, 1.0, np.random.default_rng(2)):
        _, work = solved(chains, posture)
        for limb, n in enumerate(chains.n_joints):
            for k in range(n):
                ends = []
                for sign in (1.0, -1.0):
                    q = posture[limb].copy()
                    q[k] += sign * step
                    ends.append(frames(chains, limb, q, AT_HOME)[-1])
                motion = (ends[0][:3, 3] - ends[1][:3, 3]) / (2 * step)
                spin = (
                    (ends[0][:3, :3] - ends[1][:3, :3])
                    / (2 * step)
                    @ frames(chains, limb, posture[limb], AT_HOME)[-1][:3, :3].T
                )
                axis = work["axis"][0, limb, k] * (1 - chains.sliding[limb, k])
                assert work["jacobian"][0, limb, k] == pytest.approx(motion, abs=1e-9)
                assert axis == pytest.approx([spin[2, 1], spin[0, 2], spin[1, 0]], abs=1e-8)


@pytest.mark.parametrize("machine", MACHINES)
def test_weights_are_slopes_of_the_potential_energy(machine: str) -> None:
    chains = MACHINES[machine]
    rng = np.random.default_rng(3)
    for posture in random_postures(chains, 5, 1.0, rng):
        statics, work = solved(chains, posture)
        gravity = rng.normal(size=3) * 9.81
        work["gravity"][0] = gravity
        base_weight(statics.robot[0], work[0])
        for limb, n in enumerate(chains.n_joints):
            limb_weight(statics.robot[0], limb, work[0])
            for k in range(n):
                q = posture[limb].copy()
                energies = []
                for step in (1e-5, -2e-5):
                    q[k] += step
                    energies.append(limb_energy(chains, limb, q, AT_HOME, gravity))
                slope = (energies[0] - energies[1]) / 2e-5
                assert work["load"][0, limb, k] == pytest.approx(-slope, abs=1e-7)
        moment = chains.base_mass * chains.base_centre
        for limb in range(statics.n_limbs):
            for k, frame in enumerate(frames(chains, limb, posture[limb], AT_HOME)[:-1]):
                moment = moment + chains.mass[limb, k] * (frame @ np.append(chains.centre[limb, k], 1.0))[:3]
        assert work["moments"][0, 0] == pytest.approx(chains.total_mass)
        assert work["moments"][0, 1:] == pytest.approx(moment, abs=1e-12)


def in_mujoco(chains: Chains) -> mujoco.MjModel:
    """The same robot with its base fixed to the world."""
    spec = mujoco.MjSpec()
    for limb, n in enumerate(chains.n_joints):
        parent = spec.worldbody
        for k in range(n):
            turn = np.zeros(4)
            mujoco.mju_mat2Quat(turn, chains.rotation[limb, k].reshape(-1))
            parent = parent.add_body(
                pos=chains.offset[limb, k],
                quat=turn,
                mass=chains.mass[limb, k],
                ipos=chains.centre[limb, k],
                inertia=[1e-3, 1e-3, 1e-3],
                explicitinertial=True,
            )
            kind = mujoco.mjtJoint.mjJNT_SLIDE if chains.sliding[limb, k] else mujoco.mjtJoint.mjJNT_HINGE
            parent.add_joint(type=kind, axis=[0, 0, 1])
        parent.add_site(name=f"tip{limb}", pos=chains.offset[limb, n])
    return spec.compile()


@pytest.mark.parametrize("machine", MACHINES)
def test_tips_jacobians_and_weights_are_those_of_mujoco(machine: str) -> None:
    chains = MACHINES[machine]
    model = in_mujoco(chains)
    data = mujoco.MjData(model)
    rng = np.random.default_rng(13)
    joints = int(chains.n_joints[0])
    for posture in random_postures(chains, 20, 1.0, rng):
        gravity = rng.normal(size=3) * 9.81
        model.opt.gravity[:] = gravity
        data.qpos[:] = posture.reshape(-1)
        mujoco.mj_forward(model, data)
        statics, work = solved(chains, posture)
        work["gravity"][0] = gravity
        for limb in range(statics.n_limbs):
            limb_weight(statics.robot[0], limb, work[0])
            own = slice(limb * joints, (limb + 1) * joints)
            site = model.site(f"tip{limb}").id
            place, turn = np.zeros((3, model.nv)), np.zeros((3, model.nv))
            mujoco.mj_jacSite(model, data, place, turn, site)
            assert work["origin"][0, limb, joints] == pytest.approx(data.site_xpos[site], abs=1e-13)
            assert work["jacobian"][0, limb, :joints] == pytest.approx(place[:, own].T, abs=1e-13)
            assert work["load"][0, limb, :joints] == pytest.approx(-data.qfrc_bias[own], rel=1e-9, abs=1e-11)


@pytest.mark.parametrize("machine", MACHINES)
def test_nearly_every_place_that_a_tip_can_be_at_is_reached(machine: str) -> None:
    chains = MACHINES[machine]
    statics = Statics(chains, [point_foot(0.5)] * len(chains.limb_names))
    bodies, contacts = random_stances(statics, chains, 500, np.random.default_rng(4), spread=0.9)
    judged, reasons = statics.judge(bodies, contacts, rules_record(hard=1))
    assert np.mean(reasons < 0) > 0.97  # of all limbs at once
    assert np.nanmin(judged["margins"][reasons < 0, 1]) >= 0.0


def test_a_search_near_the_place_ends_there() -> None:
    chains = MACHINES["seven joints"]
    rng = np.random.default_rng(6)
    for posture in random_postures(chains, 20, 0.5, rng):
        statics, work = solved(chains, posture)
        target = work["origin"][0, 0, 7].copy()
        work["posture"][0, 0, :7] += rng.normal(size=7) * 0.05
        work["target"][0, 0] = target
        assert reach_point(statics.robot[0], 0, work[0], 1e-9) < 1e-9
        assert work["origin"][0, 0, 7] == pytest.approx(target, abs=1e-9)
