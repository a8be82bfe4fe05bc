"""The planar 3-RPR mechanism: its kinematics both ways, derivatives, singular poses, and the branch that is followed."""

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import fsolve

import clamber
from clamber.errors import SpecError
from clamber.families.walker.planning.problem import walker_params
from clamber.families.walker.planning.task import WalkerTask
from clamber.families.walker.robot import PoseError, TwoFrames, WalkerRobot
from clamber.families.walker.robot.assemblies import are_similar, general_poses, similar_poses
from clamber.files import Document
from clamber.tasks import load_task
from clamber.tasks.robots import load_robot
from tiers import first_fast

MM = 1e-3
SEEDS = range(12)


def hoshino() -> TwoFrames:
    robot = load_robot("hoshino")
    assert isinstance(robot, WalkerRobot)
    return TwoFrames.of(robot.mechanism)


def random_frames(seed: int) -> TwoFrames:
    """Attachments anywhere."""
    rng = np.random.default_rng(seed)
    return TwoFrames(rng.uniform(-0.4, 0.4, (3, 2)), rng.uniform(-0.3, 0.3, (3, 2)), 0.05, 0.9, 0.9)


def similar_frames(seed: int) -> TwoFrames:
    """Directly similar triangles of any shape, off their origins."""
    rng = np.random.default_rng(seed)
    delta = rng.uniform(-0.4, 0.4, 3) + 1j * rng.uniform(-0.4, 0.4, 3)
    y = delta * rng.uniform(0.4, 1.6) * np.exp(1j * rng.uniform(-3, 3)) + rng.uniform(-0.2, 0.2) - 0.1j
    return TwoFrames(np.stack([delta.real, delta.imag], 1), np.stack([y.real, y.imag], 1), 0.05, 0.9, 0.9)


def random_pose(rng: np.random.Generator) -> np.ndarray:
    return np.array([*rng.uniform(-0.3, 0.3, 2), rng.uniform(-math.pi, math.pi)])


def plain_lengths(frames: TwoFrames, pose: np.ndarray) -> np.ndarray:
    """By complex numbers, apart from the kernels."""
    a, b = frames.delta @ (1, 1j), frames.y @ (1, 1j)
    return abs(complex(pose[0], pose[1]) + np.exp(1j * pose[2]) * b - a)


def same(one: np.ndarray, other: np.ndarray, close: float = 1e-7) -> bool:
    turn = (one[2] - other[2] + math.pi) % math.tau - math.pi
    return bool(abs(one[:2] - other[:2]).max() < close and abs(turn) < close)


@pytest.mark.parametrize("seed", SEEDS)
def test_lengths_are_the_distances_of_the_attachments(seed: int) -> None:
    rng = np.random.default_rng(seed)
    for frames in (hoshino(), random_frames(seed)):
        pose = random_pose(rng)
        np.testing.assert_allclose(frames.lengths(pose), plain_lengths(frames, pose), atol=1e-15)


@pytest.mark.parametrize("seed", SEEDS)
def test_derivatives_are_those_of_the_lengths(seed: int) -> None:
    rng = np.random.default_rng(seed)
    frames = random_frames(seed)
    pose = random_pose(rng)
    step = 1e-5
    slope = [(frames.lengths(pose + step * e) - frames.lengths(pose - step * e)) / (2 * step) for e in np.eye(3)]
    np.testing.assert_allclose(frames.jacobian(pose), np.column_stack(slope), atol=1e-8)
    # by complex steps, exact to rounding: the lengths' squares are polynomials in x, y, cos, sin
    for k, e in enumerate(np.eye(3)):
        z = pose + 1e-30j * e
        arm = frames.y @ np.array([[np.cos(z[2]), np.sin(z[2])], [-np.sin(z[2]), np.cos(z[2])]])
        v = z[:2] + arm - frames.delta
        np.testing.assert_allclose(np.sqrt((v * v).sum(axis=1)).imag / 1e-30, frames.jacobian(pose)[:, k], atol=1e-14)


@pytest.mark.parametrize("seed", SEEDS)
def test_jacobian_agrees_with_pinocchio(seed: int) -> None:
    """A chain of two slides and a joint carries the tips; their velocities along the actuators are the lengths' rates."""
    pin = pytest.importorskip("pinocchio")
    frames = random_frames(seed)
    model = pin.Model()
    last = 0
    for joint in (pin.JointModelPX(), pin.JointModelPY(), pin.JointModelRZ()):
        last = model.addJoint(last, joint, pin.SE3.Identity(), f"j{model.njoints}")
    tips = []
    for i, (x, y) in enumerate(frames.y):
        place = pin.SE3(np.eye(3), np.array([x, y, 0.0]))
        tips.append(model.addFrame(pin.Frame(f"tip{i}", last, 0, place, pin.FrameType.OP_FRAME)))
    data = model.createData()
    pose = random_pose(np.random.default_rng(seed))
    rows = []
    pin.computeJointJacobians(model, data, pose)
    pin.updateFramePlacements(model, data)
    for i, tip in enumerate(tips):
        v = data.oMf[tip].translation[:2] - frames.delta[i]
        length = np.linalg.norm(v)
        moving = pin.getFrameJacobian(model, data, tip, pin.LOCAL_WORLD_ALIGNED)[:2]
        rows.append(v @ moving / length)
    np.testing.assert_allclose(frames.jacobian(pose), rows, atol=1e-12)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("make", [random_frames, similar_frames])
def test_assemblies_are_all_that_a_numeric_solver_finds(make, seed: int) -> None:
    rng = np.random.default_rng(seed)
    frames = make(seed)
    pose = random_pose(rng)
    lengths = plain_lengths(frames, pose)
    found = frames.assemblies(lengths)
    assert len(found) <= (4 if make is similar_frames else 6)
    assert any(same(pose, other) for other in found)
    for other in found:
        np.testing.assert_allclose(plain_lengths(frames, other), lengths, atol=1e-9)
    for _ in range(60):
        root, _, ended, _ = fsolve(
            lambda q: plain_lengths(frames, q) - lengths, random_pose(rng) * (3, 3, 1), full_output=True, xtol=1e-13
        )
        if ended == 1 and abs(plain_lengths(frames, root) - lengths).max() < 1e-10:
            assert any(same(root, other, 1e-5) for other in found)


@pytest.mark.parametrize("seed", SEEDS)
def test_closed_form_and_polynomial_agree_where_both_hold(seed: int) -> None:
    frames = similar_frames(seed)
    assert are_similar(frames.delta, frames.y)
    lengths = plain_lengths(frames, random_pose(np.random.default_rng(seed)))
    closed = similar_poses(frames.delta, frames.y, lengths)
    general = general_poses(frames.delta, frames.y, lengths)
    for pose in closed:
        assert any(same(pose, other, 1e-5) for other in general)


def test_a_general_mechanism_has_two_four_or_six_assemblies() -> None:
    counts = set()
    for seed in range(200):
        frames = random_frames(seed)
        counts.add(len(frames.assemblies(plain_lengths(frames, random_pose(np.random.default_rng(seed))))))
    assert counts == {2, 4, 6}


def test_lengths_that_cannot_be_assembled_have_no_pose() -> None:
    assert hoshino().assemblies((0.05, 0.05, 2.0)).shape == (0, 3)


@pytest.mark.parametrize("seed", SEEDS)
def test_singular_measure_is_the_determinant_times_the_lengths(seed: int) -> None:
    frames = random_frames(seed)
    pose = random_pose(np.random.default_rng(seed))
    determinant = np.linalg.det(frames.jacobian(pose)) * np.prod(frames.lengths(pose))
    assert frames.singular_measure(pose) == pytest.approx(determinant, rel=1e-12, abs=1e-16)


@pytest.mark.parametrize("seed", SEEDS)
def test_on_circles_the_determinant_has_its_closed_form(seed: int) -> None:
    rng = np.random.default_rng(seed)
    frames, radius = hoshino(), 238.4 * MM
    pose = np.array([*rng.uniform(-0.2, 0.2, 2), math.radians(rng.uniform(-18, 48))])
    psi = math.radians(60.0) - pose[2]
    rho, apart = 2.0 * radius * math.sin(psi / 2.0), math.hypot(pose[0], pose[1])
    closed = -1.5 * math.sqrt(3.0) * radius * math.cos(psi / 2.0) * (rho**2 - apart**2) * rho
    assert frames.singular_measure(pose) == pytest.approx(closed, rel=1e-10)
    assert frames.nearness(pose) == pytest.approx(apart / rho, rel=1e-10)


@pytest.mark.parametrize("seed", SEEDS)
def test_following_a_walk_of_poses_keeps_to_it(seed: int) -> None:
    """Where no pose on a line is singular, the lengths lead along it, in one go or in many."""
    rng = np.random.default_rng(seed)
    frames = hoshino()
    here = np.array([0.0, 0.0, 0.0])
    for _ in range(50):
        theta = math.radians(rng.uniform(-18, 48))
        rho = 2 * 0.2384 * math.sin((math.radians(60) - theta) / 2)
        angle, reach = rng.uniform(0, math.tau), 0.8 * rho * math.sqrt(rng.uniform())
        there = np.array([reach * math.cos(angle), reach * math.sin(angle), theta])
        for share in np.linspace(0.05, 1.0, 20):
            pose = here + share * (there - here)
            followed = frames.follow(frames.lengths(pose), pose - 0.05 * (there - here))
            assert followed.status == "found"
            assert followed.error < 1e-14
            assert same(followed.pose, pose, 1e-10)
        here = there


@pytest.mark.parametrize("seed", first_fast(range(24), 8))
def test_a_followed_branch_is_the_one_that_tiny_steps_take(seed: int) -> None:
    """Beside a plain Newton from step to step of a fine way of lengths; where that meets a singular pose, so says `follow`."""
    rng = np.random.default_rng(seed)
    frames = random_frames(seed)
    pose = random_pose(rng)
    begin = frames.lengths(pose)
    end = begin * rng.uniform(0.7, 1.3, 3)
    followed = frames.follow(end, pose)
    sign = math.copysign(1.0, frames.singular_measure(pose))
    plain, crossed = pose.copy(), False
    for share in np.linspace(0.0, 1.0, 4001)[1:]:
        aim = begin + share * (end - begin)
        for _ in range(4):
            change = np.linalg.solve(frames.jacobian(plain), aim - plain_lengths(frames, plain))
            plain += change
        crossed |= bool(abs(change).max() > 1e-9) or sign * frames.singular_measure(plain) <= 0.0
        if crossed:
            break
    assert followed.status == ("singular" if crossed else "found")
    if not crossed:
        assert same(followed.pose, plain, 1e-8)
        assert sign * frames.singular_measure(followed.pose) > 0.0


def test_a_way_of_lengths_through_a_singular_pose_says_so() -> None:
    frames = hoshino()
    followed = frames.follow((0.3, 0.3, 1.2), (0.0, 0.0, 0.0))
    assert followed.status == "singular"
    assert frames.nearness(followed.pose) == pytest.approx(1.0, abs=1e-3)
    assert followed.error > 1e-3


def test_poses_and_lengths_that_mean_nothing_are_named() -> None:
    frames = hoshino()
    with pytest.raises(PoseError, match=r"pose \(0, nan, 0\): must be three finite numbers"):
        frames.lengths((0.0, math.nan, 0.0))
    with pytest.raises(PoseError, match=r"lengths .* must be three finite lengths"):
        frames.assemblies((0.1, 0.0, 0.1))
    on_it = np.array([*(frames.delta[0] - frames.y[0]), 0.0])
    with pytest.raises(PoseError, match="has no direction"):
        frames.jacobian(on_it)


ATTACHMENTS = {
    "points_delta": [["0 m", "0.3 m"], ["-0.3 m", "-0.1 m"], ["0.2 m", "-0.2 m"]],
    "points_y": [["0.2 m", "0.1 m"], ["-0.2 m", "0.1 m"], ["0 m", "-0.3 m"]],
}


def with_mechanism(changes: dict[str, object]) -> WalkerRobot:
    from clamber.tasks.robots import build_robot, read_robot

    document = read_robot("hoshino")
    mechanism = {**document.data["mechanism"], **changes}
    data = {**document.data, "mechanism": {key: value for key, value in mechanism.items() if value is not None}}
    robot = build_robot(Document(document.label, data))
    assert isinstance(robot, WalkerRobot)
    return robot


def test_a_robot_file_may_state_attachments_as_points() -> None:
    robot = with_mechanism({**ATTACHMENTS, "radius_delta": None, "radius_y": None})
    np.testing.assert_allclose(robot.attachments()[1], [[0.2, 0.1], [-0.2, 0.1], [0.0, -0.3]])
    np.testing.assert_allclose(np.linalg.norm(robot.feet(), axis=-1), 238.4 * MM)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"radius_y": None}, "mechanism.radius_y: must be given"),
        (ATTACHMENTS, "mechanism.radius_delta .*take one pair out"),
        ({"points_y": ATTACHMENTS["points_y"], "radius_delta": None, "radius_y": None}, "points_delta: must be given"),
        ({**ATTACHMENTS, "points_y": [["1 m", "0 m"]] * 3, "radius_delta": None, "radius_y": None}, "not all one"),
    ],
)
def test_attachments_are_stated_in_one_way_and_whole(changes: dict[str, object], words: str) -> None:
    with pytest.raises(SpecError, match=words):
        with_mechanism(changes)


def test_walks_are_planned_for_attachments_on_circles_only(tmp_path: Path) -> None:
    text = (Path(clamber.__file__).parent / "families" / "walker" / "data" / "robots" / "hoshino.toml").read_text(
        encoding="utf-8"
    )
    rows = [row for row in text.splitlines() if not row.startswith(("radius_delta", "radius_y"))]
    points = "\n".join(f"points_{frame} = {ATTACHMENTS[f'points_{frame}']!r}" for frame in ("delta", "y"))
    made = "\n".join(rows).replace("[mechanism]", f"[mechanism]\n{points}")
    made = made.replace("[legs]", '[legs]\nradius_delta = "238 mm"\nradius_y = "238 mm"')
    (tmp_path / "odd.toml").write_text(made, encoding="utf-8")
    task = load_task("patch-walk", [f"robot={tmp_path / 'odd.toml'}"])
    assert isinstance(task, WalkerTask)
    with pytest.raises(SpecError, match=r"mechanism\.points_delta: walks are planned for attachments on circles"):
        walker_params(task)
