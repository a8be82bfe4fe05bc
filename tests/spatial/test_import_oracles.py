"""Robots from model files against MuJoCo, which reads the same file by itself, and against Pinocchio."""

import tempfile
from pathlib import Path

import chain_kinematics as ours
import mujoco as mj
import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given
from hypothesis import strategies as st
from spatial_models import FOUR_JOINTS, LOOP, TWO_ARMS, robot_of

import clamber.families.spatial as family
from clamber.families.spatial.robot.robot import SpatialRobot, build_robot
from clamber.families.spatial.robot.starter import import_robot
from clamber.families.spatial.robot.tree import Posture, rooted_at
from clamber.files import read_toml
from clamber.types import Floats

DATA = Path(family.__file__).parent / "data" / "robots"
SHIPPED = sorted(path.stem for path in DATA.glob("*.toml"))
TIMES = 20
GRAVITY = np.array([3.0, -4.0, -8.0])
RELATIVE = 1e-9


def near(found: Floats, expected: Floats) -> bool:
    """Whether they differ by 1e-9 of the largest of them."""
    return float(np.abs(found - expected).max()) <= RELATIVE * max(float(np.abs(expected).max()), 1e-3)


class Mujoco:
    """The robot as MuJoCo has it: tips, Jacobians and gravity in the base link's frame."""

    def __init__(self, model: mj.MjModel, robot: SpatialRobot) -> None:
        self.model, self.robot, self.data = model, robot, mj.MjData(model)
        self.base = model.body(robot.spec.base).id
        for name, reading in robot.spec.trunk.items():
            self.data.qpos[model.joint(name).qposadr[0]] = reading.value

    def pose(self, positions: list[Floats]) -> None:
        for names, values in zip(self.robot.chains.joint_names, positions, strict=True):
            for name, value in zip(names, values, strict=True):
                self.data.qpos[self.model.joint(name).qposadr[0]] = value
        mj.mj_kinematics(self.model, self.data)
        mj.mj_comPos(self.model, self.data)
        self.axes = self.data.xmat[self.base].reshape(3, 3)
        # gravity is stated in the base frame, so it turns with a base that the model itself has turned
        self.model.opt.gravity[:] = self.axes @ GRAVITY
        mj.mj_forward(self.model, self.data)

    def tip(self, limb: int) -> Floats:
        return self.axes.T @ (self.data.site(self.robot.limbs[limb].tip).xpos - self.data.xpos[self.base])

    def jacobian(self, limb: int) -> Floats:
        whole = np.zeros((3, self.model.nv))
        mj.mj_jacSite(self.model, self.data, whole, None, self.model.site(self.robot.limbs[limb].tip).id)
        columns = [self.model.joint(name).dofadr[0] for name in self.robot.chains.joint_names[limb]]
        return self.axes.T @ whole[:, columns]

    def gravity_torques(self, limb: int) -> Floats:
        return np.array(
            [self.data.qfrc_bias[self.model.joint(name).dofadr[0]] for name in self.robot.chains.joint_names[limb]]
        )

    def first_moment(self) -> Floats:
        mass = self.model.body_mass[1:]
        return self.axes.T @ (mass @ (self.data.xipos[1:] - self.data.xpos[self.base]))


def check_with_mujoco(robot: SpatialRobot, model: mj.MjModel) -> None:
    oracle, chains, random = Mujoco(model, robot), robot.chains, np.random.default_rng(7)
    assert chains.total_mass == pytest.approx(model.body_mass.sum(), rel=RELATIVE)
    for _ in range(TIMES):
        positions = ours.random_positions(chains, random)
        oracle.pose(positions)
        assert near(ours.first_moment(chains, positions), oracle.first_moment())
        for limb, of_limb in enumerate(positions):
            assert near(ours.tip(chains, limb, of_limb)[0], oracle.tip(limb))
            assert near(ours.jacobian(chains, limb, of_limb), oracle.jacobian(limb))
            assert near(ours.gravity_torques(chains, limb, of_limb, GRAVITY), oracle.gravity_torques(limb))


@pytest.mark.parametrize("name", SHIPPED)
def test_an_import_finds_the_limbs_of_shipped_robots(name: str, tmp_path: Path) -> None:
    robot = build_robot(read_toml(DATA / f"{name}.toml"))
    assert robot.model_path is not None
    found = import_robot(robot.model_path, tmp_path / "robot.toml", name)
    assert [limb.joints for limb in found.limbs] == list(robot.chains.joint_names)
    assert [limb.tip for limb in found.limbs] == [limb.tip for limb in robot.limbs]
    assert found.mass == pytest.approx(robot.chains.total_mass) and not found.repaired and not found.dropped


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_robots_are_as_mujoco_has_them(name: str) -> None:
    robot = build_robot(read_toml(DATA / f"{name}.toml"))
    check_with_mujoco(robot, mj.MjModel.from_xml_path(str(robot.model_path)))


def test_an_mjcf_with_several_joints_a_link_slides_references_and_a_held_trunk(tmp_path: Path) -> None:
    robot = robot_of(tmp_path, FOUR_JOINTS)
    check_with_mujoco(robot, mj.MjModel.from_xml_string(FOUR_JOINTS.text))


def test_an_mjcf_with_a_closed_loop_is_as_mujoco_has_it_with_the_loop_cut(tmp_path: Path) -> None:
    robot = robot_of(tmp_path, LOOP)
    spec = mj.MjSpec.from_string(LOOP.text)
    for equality in list(spec.equalities):
        spec.delete(equality)
    check_with_mujoco(robot, spec.compile())


@pytest.mark.parametrize("base", ["pelvis", "chest"])
def test_a_urdf_with_turned_inertias_fixed_and_coupled_joints_is_as_pinocchio_has_it(tmp_path: Path, base: str) -> None:
    robot = robot_of(tmp_path, TWO_ARMS, base)
    chains, random = robot.chains, np.random.default_rng(3)
    model = pin.buildModelFromXML(TWO_ARMS.text, pin.JointModelFreeFlyer())
    data = model.createData()
    assert chains.total_mass == pytest.approx(pin.computeTotalMass(model), rel=RELATIVE)
    q = pin.neutral(model)
    for name, reading in robot.spec.trunk.items():
        q[model.joints[model.getJointId(name)].idx_q] = reading.value
    for _ in range(TIMES):
        positions = ours.random_positions(chains, random)
        for names, values in zip(chains.joint_names, positions, strict=True):
            for name, value in zip(names, values, strict=True):
                joint = model.joints[model.getJointId(name)]
                q[joint.idx_q : joint.idx_q + joint.nq] = value if joint.nq == 1 else (np.cos(value), np.sin(value))
        pin.framesForwardKinematics(model, data, q)
        frame = data.oMf[model.getFrameId(base)]
        model.gravity.linear = frame.rotation @ GRAVITY
        torques = pin.computeGeneralizedGravity(model, data, q)
        centre = frame.actInv(pin.centerOfMass(model, data, q))
        assert near(ours.first_moment(chains, positions), chains.total_mass * centre)
        pin.computeJointJacobians(model, data, q)
        pin.framesForwardKinematics(model, data, q)
        for limb, of_limb in enumerate(positions):
            end = model.getFrameId(robot.limbs[limb].tip)
            offset = np.array(robot.limbs[limb].offset)
            assert near(ours.tip(chains, limb, of_limb)[0], frame.actInv(data.oMf[end].act(offset)))
            columns = [model.joints[model.getJointId(name)].idx_v for name in chains.joint_names[limb]]
            six = pin.getFrameJacobian(model, data, end, pin.LOCAL_WORLD_ALIGNED)
            away = data.oMf[end].rotation @ offset
            whole = frame.rotation.T @ (six[:3] + np.cross(six[3:].T, away).T)
            if base == "pelvis":  # with another base the tree turns round, and what moves is the rest of the robot
                assert near(ours.jacobian(chains, limb, of_limb), whole[:, columns])
                assert near(ours.gravity_torques(chains, limb, of_limb, GRAVITY), torques[columns])


def test_inertias_of_a_urdf_are_those_that_pinocchio_has(tmp_path: Path) -> None:
    robot = robot_of(tmp_path, TWO_ARMS)
    model = pin.buildModelFromXML(TWO_ARMS.text, pin.JointModelFreeFlyer())
    data, random = model.createData(), np.random.default_rng(5)
    for _ in range(TIMES):
        q, positions = pin.neutral(model), {}
        for joint in robot.tree.joints:
            value = positions[joint.name] = float(random.uniform(-1.0, 1.0))
            theirs = model.joints[model.getJointId(joint.name)]
            q[theirs.idx_q : theirs.idx_q + theirs.nq] = value if theirs.nq == 1 else (np.cos(value), np.sin(value))
        posture = Posture.of(robot.tree, positions)
        frames = [posture.frame(link) for link in robot.tree.links]
        centre = sum(link.mass * frame.at(link.centre) for link, frame in zip(robot.tree.links, frames, strict=True))
        centre = centre / robot.tree.mass
        inertia = np.zeros((3, 3))
        for link, frame in zip(robot.tree.links, frames, strict=True):
            away = frame.at(link.centre) - centre
            inertia += frame.axes @ np.array(link.inertia) @ frame.axes.T
            inertia += link.mass * (away @ away * np.eye(3) - np.outer(away, away))
        pin.ccrba(model, data, q, np.zeros(model.nv))
        assert near(inertia, data.Ig.inertia)


@given(
    st.sampled_from(["pelvis", "chest", "l1", "r2", "g2", "lf"]), st.lists(st.floats(-1.0, 1.0), min_size=8, max_size=8)
)
def test_a_tree_with_another_root_is_the_same_robot(base: str, values: list[float]) -> None:
    with tempfile.TemporaryDirectory() as folder:
        tree = robot_of(Path(folder), TWO_ARMS).tree
    positions = {joint.name: value for joint, value in zip(tree.joints, values, strict=True)}
    turned = rooted_at(tree, base)
    before, after = Posture.of(tree, positions), Posture.of(turned, positions)
    assert turned.links[0].name == base and turned.mass == tree.mass
    origin = [posture.frame(posture.tree.link("pelvis")) for posture in (before, after)]
    for link in tree.links:
        seen = [
            at.within(posture.frame(link).at(link.centre)) for at, posture in zip(origin, (before, after), strict=True)
        ]
        np.testing.assert_allclose(seen[0], seen[1], atol=1e-12)
