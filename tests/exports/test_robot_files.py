"""Robots as MJCF and URDF: other programs load them, and place their links where our own kinematics has them."""

import cmath
import math
import xml.etree.ElementTree as ET
from typing import Any

import mujoco
import numpy as np
import pytest

from clamber.families.climber.robot.robot import LimbedRobot
from clamber.families.walker.robot import WalkerRobot
from clamber.sim.lone_robot import LoneRobot, lone_robot
from clamber.sim.mjcf_file import mjcf_text, plain_name
from clamber.sim.urdf_file import GRAIN, roll_pitch_yaw, urdf_of
from clamber.tasks.robots import family_in, load_robot, read_robot, robot_names
from clamber.types import Floats

NAMES = tuple(name for name in robot_names() if family_in(read_robot(name)).model is not None)
SEEDS = range(3)
CLOSE = 1e-9
BASE = ("x", "y", "theta", "plate")


@pytest.fixture(scope="module", params=NAMES)
def name(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def lone(name: str) -> LoneRobot:
    return lone_robot(load_robot(name))


@pytest.fixture(scope="module")
def mjcf(lone: LoneRobot) -> Any:
    return mujoco.MjModel.from_xml_string(mjcf_text(lone))


@pytest.fixture(scope="module")
def urdf(lone: LoneRobot) -> str:
    return urdf_of(lone).text


def joints_of(lone: LoneRobot) -> list[str]:
    """Joints that a reader may move, but for the base's and springs."""
    model = lone.model
    names = (model.joint(j).name for j in range(model.njnt) if model.jnt_stiffness[j] == 0.0)
    return [plain_name(name) for name in names if name not in BASE]


def drawn(lone: LoneRobot, seed: int) -> dict[str, float]:
    rng = np.random.default_rng(seed)
    angles = {}
    for name in joints_of(lone):
        bounds = next((b for key, b in lone.bounds.items() if plain_name(key) == name), None)
        low, high = (-0.1, 0.1) if bounds is None else (bounds.lower, bounds.upper)
        angles[name] = float(rng.uniform(low, high))
    return angles


def our_points(name: str, q: dict[str, float]) -> dict[str, Floats]:
    """Tips, soles and tool in the body's frame, written down from the papers' equations and nothing of the simulation."""
    robot = load_robot(name)
    if isinstance(robot, LimbedRobot):
        points = {}
        for limb in robot.limbs:
            first = limb.port_angle + q[f"{limb.name}_shoulder"]
            elbow = complex(limb.port_x, limb.port_y) + cmath.rect(limb.l1, first)
            tip = elbow + limb.second_link * cmath.exp(1j * (first + q[f"{limb.name}_elbow"]))
            points[f"{limb.name}_tip"] = np.array((tip.real, tip.imag, 0.0))
        return points
    assert isinstance(robot, WalkerRobot) and robot.arm is not None
    points, feet, arm = {}, robot.feet(), robot.arm
    c, s = math.cos(q["turn"]), math.sin(q["turn"])
    for f, frame in enumerate(("delta", "y")):
        for i in range(3):
            x, y = feet[f, i]
            if frame == "y":
                x, y = q["slide_x"] + c * x - s * y, q["slide_y"] + s * x + c * y
            points[f"{frame}_leg_{i}"] = np.array((x, y, -q[f"{frame}_leg_{i}"]))
    out, up, pitch = arm.out, arm.up, 0.0
    for k, length in enumerate(arm.links, start=1):
        pitch += q[f"arm_{k}"]
        out, up = out + length * math.cos(pitch), up + length * math.sin(pitch)
    points["tool"] = np.array((out * math.cos(q["arm_0"]), out * math.sin(q["arm_0"]), up))
    return points


def placed(model: Any, q: dict[str, float]) -> Any:
    data = mujoco.MjData(model)
    for name, value in q.items():
        data.qpos[model.joint(name).qposadr[0]] = value
    mujoco.mj_forward(model, data)
    return data


@pytest.mark.parametrize("seed", SEEDS)
def test_mjcf_has_tips_soles_and_tool_where_ours_are(name: str, lone: LoneRobot, mjcf: Any, seed: int) -> None:
    q = drawn(lone, seed)
    data = placed(mjcf, q)
    sites = [mjcf.site(k).name for k in range(mjcf.nsite)]
    for point, at in our_points(name, q).items():
        there = data.site(point).xpos if point in sites else data.body(point).xpos
        np.testing.assert_allclose(there, at, atol=CLOSE)


@pytest.mark.parametrize("seed", SEEDS)
def test_mujoco_reads_the_urdf_and_has_them_there_too(name: str, lone: LoneRobot, urdf: str, seed: int) -> None:
    q = drawn(lone, seed)
    data = placed(mujoco.MjModel.from_xml_string(urdf), q)
    for point, at in our_points(name, q).items():
        np.testing.assert_allclose(data.body(point).xpos, at, atol=CLOSE)


@pytest.mark.parametrize("seed", SEEDS)
def test_pinocchio_reads_the_urdf_and_has_them_there_too(name: str, lone: LoneRobot, urdf: str, seed: int) -> None:
    pin = pytest.importorskip("pinocchio")
    q = drawn(lone, seed)
    model = pin.buildModelFromXML(urdf)
    data, place = model.createData(), pin.neutral(model)
    for joint, value in q.items():
        spot = model.joints[model.getJointId(joint)]
        # a joint that turns without end is told by cosine and sine
        place[spot.idx_q : spot.idx_q + spot.nq] = value if spot.nq == 1 else (math.cos(value), math.sin(value))
    pin.framesForwardKinematics(model, data, place)
    for point, at in our_points(name, q).items():
        np.testing.assert_allclose(data.oMf[model.getFrameId(point, pin.FrameType.BODY)].translation, at, atol=CLOSE)


def test_mjcf_weighs_and_resists_as_our_model_to_the_last_digit(lone: LoneRobot, mjcf: Any) -> None:
    ours = lone.model
    for key in ("body_mass", "body_inertia", "body_ipos", "body_iquat", "dof_armature", "dof_damping", "dof_frictionloss",
                "jnt_range", "jnt_axis", "jnt_pos", "actuator_ctrlrange", "site_pos", "geom_pos", "geom_size"):  # fmt: skip
        np.testing.assert_allclose(getattr(mjcf, key), getattr(ours, key), rtol=1e-5, atol=1e-15, err_msg=key)
    np.testing.assert_array_equal(mjcf.body_mass, ours.body_mass)
    np.testing.assert_array_equal(mjcf.jnt_range, ours.jnt_range)


def test_urdf_weighs_the_same_and_moves_as_hard(lone: LoneRobot, mjcf: Any, urdf: str) -> None:
    """Pinocchio's mass matrix, the body held, beside MuJoCo's of the MJCF without the motors' own inertia."""
    pin = pytest.importorskip("pinocchio")
    model = pin.buildModelFromXML(urdf)
    total = sum(float(link.get("value", 0.0)) for link in ET.fromstring(urdf).iter("mass"))
    assert total == pytest.approx(float(lone.model.body_mass.sum()), rel=1e-12)
    q, names = drawn(lone, 7), joints_of(lone)
    place = pin.neutral(model)
    for joint, value in q.items():
        spot = model.joints[model.getJointId(joint)]
        place[spot.idx_q : spot.idx_q + spot.nq] = value if spot.nq == 1 else (math.cos(value), math.sin(value))
    theirs = pin.crba(model, model.createData(), place)
    theirs = np.triu(theirs) + np.triu(theirs, 1).T
    data = placed(mjcf, q)
    full = np.zeros((mjcf.nv, mjcf.nv))
    mujoco.mj_fullM(mjcf, data, full)
    full -= np.diag(mjcf.dof_armature)
    dofs = [int(mjcf.joint(name).dofadr[0]) for name in names]
    spots = [model.joints[model.getJointId(name)].idx_v for name in names]
    np.testing.assert_allclose(theirs[np.ix_(spots, spots)], full[np.ix_(dofs, dofs)], atol=10 * GRAIN)


def test_urdf_states_the_limits_of_the_robots_file(lone: LoneRobot, urdf: str) -> None:
    limits = {joint.get("name"): joint.find("limit") for joint in ET.fromstring(urdf).iter("joint")}
    for name, bounds in lone.bounds.items():
        limit = limits[plain_name(name)]
        assert limit is not None
        assert (float(limit.get("lower", "nan")), float(limit.get("upper", "nan"))) == (bounds.lower, bounds.upper)
        assert bounds.effort is None or float(limit.get("effort", "nan")) == bounds.effort
        assert bounds.speed is None or float(limit.get("velocity", "nan")) == bounds.speed


def test_what_a_tree_cannot_say_is_told() -> None:
    losses = " ".join(urdf_of(lone_robot(load_robot("hoshino"))).losses)
    assert "actuator 0, actuator 1, actuator 2 move slide_x, slide_y, turn together" in losses
    assert "springs" in losses and "largest forces" in losses
    assert "closed loops" not in " ".join(urdf_of(lone_robot(load_robot("libra"))).losses)


@pytest.mark.parametrize("angles", [(0.3, -0.8, 2.0), (0.0, math.pi / 2, 0.4), (0.1, -math.pi / 2, 0.0)])
def test_roll_pitch_and_yaw_make_the_turn_again(angles: tuple[float, float, float]) -> None:
    def made(roll: float, pitch: float, yaw: float) -> Floats:
        (a, b, c), (x, y, z) = map(math.cos, (roll, pitch, yaw)), map(math.sin, (roll, pitch, yaw))
        about_x = np.array(((1, 0, 0), (0, a, -x), (0, x, a)))
        about_y = np.array(((b, 0, y), (0, 1, 0), (-y, 0, b)))
        about_z = np.array(((c, -z, 0), (z, c, 0), (0, 0, 1)))
        out: Floats = about_z @ about_y @ about_x
        return out

    turn = made(*angles)
    np.testing.assert_allclose(made(*roll_pitch_yaw(turn)), turn, atol=1e-12)
