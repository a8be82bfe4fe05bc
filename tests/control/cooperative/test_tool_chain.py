"""The chain to the tool against Pinocchio, central differences and equation 8."""

import numpy as np
import pinocchio
import pytest
from walkers import ROBOTS, differences, hoshino, random_q

from clamber.families.walker.control.cooperative.limits import arm_moment, chain_of
from clamber.families.walker.control.cooperative.scratch import Scratch, make_scratch, see_tool
from clamber.families.walker.robot import WalkerRobot
from clamber.types import Floats

SEEDS = range(8)


class Pinocchio:
    """The same chain of PX, PY, PZ, RZ, RY, RX and revolutes."""

    def __init__(self, robot: WalkerRobot) -> None:
        arm = robot.arm
        assert arm is not None
        self.model = pinocchio.Model()
        unit = pinocchio.SE3.Identity()
        kinds = [
            pinocchio.JointModelPX(), pinocchio.JointModelPY(), pinocchio.JointModelPZ(),
            pinocchio.JointModelRZ(), pinocchio.JointModelRY(), pinocchio.JointModelRX(), pinocchio.JointModelRZ(),
        ]  # fmt: skip
        parent = 0
        for k, kind in enumerate(kinds):
            parent = self.model.addJoint(parent, kind, unit, f"freedom {k}")
        place = np.array([arm.out, 0.0, arm.up])
        for k, length in enumerate(arm.links):
            joint = pinocchio.JointModelRevoluteUnaligned(0.0, -1.0, 0.0)  # upwards positive
            parent = self.model.addJoint(parent, joint, pinocchio.SE3(np.eye(3), place), f"pitch {k}")
            place = np.array([length, 0.0, 0.0])
        self.tool, self.joint = pinocchio.SE3(np.eye(3), place), parent
        self.frame = self.model.addFrame(pinocchio.Frame("tool", parent, 0, self.tool, pinocchio.FrameType.OP_FRAME))
        self.data = self.model.createData()

    def place(self, q: Floats) -> Floats:
        pinocchio.framesForwardKinematics(self.model, self.data, q)
        out: Floats = self.data.oMf[self.frame].translation.copy()
        return out

    def jacobian(self, q: Floats) -> Floats:
        world = pinocchio.ReferenceFrame.LOCAL_WORLD_ALIGNED
        out: Floats = pinocchio.computeFrameJacobian(self.model, self.data, q, self.frame, world)[:3]
        return out

    def curvature(self, q: Floats) -> Floats:
        """d(J e_j)/dq_k at [k, :, j]: how the velocity of the tool under one unit rate changes with the configuration."""
        world = pinocchio.ReferenceFrame.LOCAL_WORLD_ALIGNED
        out = np.empty((q.size, 3, q.size))
        for j, rates in enumerate(np.eye(q.size)):
            pinocchio.computeForwardKinematicsDerivatives(self.model, self.data, q, rates, np.zeros(q.size))
            by_q, _ = pinocchio.getPointVelocityDerivatives(self.model, self.data, self.joint, self.tool, world)
            out[:, :, j] = by_q.T
        return out


@pytest.fixture(params=ROBOTS, scope="module")
def robot(request: pytest.FixtureRequest) -> WalkerRobot:
    return ROBOTS[request.param]


def seen(robot: WalkerRobot, q: Floats) -> Scratch:
    assert robot.arm is not None
    w = make_scratch(robot.arm.n_joints)
    see_tool(chain_of(robot, balance=0.0), q, w)
    return w


def test_the_tool_is_where_equation_8_puts_it() -> None:
    robot, q = hoshino(), np.array([0.1, -0.2, 0.4, 0.3, -0.2, 0.15, 0.2, 1.1, -1.0, -0.9])
    assert robot.arm is not None
    ca, cb, cg = np.cos(q[3:6])
    sa, sb, sg = np.sin(q[3:6])
    turn = np.array(
        [
            [ca * cb, ca * sb * sg - sa * cg, ca * sb * cg + sa * sg],
            [sa * cb, sa * sb * sg + ca * cg, sa * sb * cg - ca * sg],
            [-sb, cb * sg, cb * cg],
        ]
    )
    t1, t12, t123 = np.cumsum(q[7:])
    l1, l2, l3 = robot.arm.links
    out = l1 * np.cos(t1) + l2 * np.cos(t12) + l3 * np.cos(t123) + robot.arm.out
    up = l1 * np.sin(t1) + l2 * np.sin(t12) + l3 * np.sin(t123) + robot.arm.up
    expected = q[:3] + turn @ np.array([np.cos(q[6]) * out, np.sin(q[6]) * out, up])
    np.testing.assert_allclose(seen(robot, q).place, expected, atol=1e-15)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_tool_is_where_pinocchio_has_it(robot: WalkerRobot, seed: int) -> None:
    q = random_q(robot, seed)
    np.testing.assert_allclose(seen(robot, q).place, Pinocchio(robot).place(q), atol=1e-12, rtol=0)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_jacobian_is_pinocchios(robot: WalkerRobot, seed: int) -> None:
    q = random_q(robot, seed)
    np.testing.assert_allclose(seen(robot, q).jacobian, Pinocchio(robot).jacobian(q), atol=1e-12, rtol=0)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_jacobians_derivative_is_pinocchios(robot: WalkerRobot, seed: int) -> None:
    q = random_q(robot, seed)
    np.testing.assert_allclose(seen(robot, q).curvature, Pinocchio(robot).curvature(q), atol=1e-10, rtol=0)


@pytest.mark.parametrize("seed", SEEDS)
def test_jacobian_and_derivative_are_those_of_central_differences(robot: WalkerRobot, seed: int) -> None:
    q = random_q(robot, seed)
    w = seen(robot, q)
    slopes = differences(lambda p: seen(robot, p).place.copy(), q)
    np.testing.assert_allclose(w.jacobian, slopes.T, atol=1e-7, rtol=0)
    np.testing.assert_allclose(w.curvature, differences(lambda p: seen(robot, p).jacobian.copy(), q), atol=1e-7, rtol=0)


def test_a_configurations_derivative_is_symmetric(robot: WalkerRobot) -> None:
    curvature = seen(robot, random_q(robot, 3)).curvature
    np.testing.assert_array_equal(curvature, curvature.transpose(2, 1, 0))


@pytest.mark.parametrize("payload", [0.0, 3.5])
def test_the_arms_moment_is_the_sum_over_its_links(robot: WalkerRobot, payload: float) -> None:
    arm = robot.arm
    assert arm is not None
    moment = arm_moment(robot, payload)
    joints = random_q(robot, 5)[7:]
    reach, rise, pitch = arm.out, arm.up, 0.0
    total = np.zeros(2)
    for length, mass, joint in zip(arm.links, arm.masses, joints, strict=True):
        pitch += joint
        total += mass * np.array([reach + 0.5 * length * np.cos(pitch), rise + 0.5 * length * np.sin(pitch)])
        reach += length * np.cos(pitch)
        rise += length * np.sin(pitch)
    total += payload * np.array([reach, rise])
    pitches = np.cumsum(joints)
    ours = moment.links @ np.cos(pitches) + moment.out, moment.links @ np.sin(pitches) + moment.up
    np.testing.assert_allclose(ours, total, rtol=1e-13)
    assert moment.mass == pytest.approx(sum(arm.masses) + payload)
