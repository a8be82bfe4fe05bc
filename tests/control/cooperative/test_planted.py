"""The plate on planted feet, and what bounds its pose, against a second reading and central differences."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation
from walkers import ROBOTS, differences, hoshino, random_q

from clamber.families.walker.control.cooperative.limits import chain_of
from clamber.families.walker.control.cooperative.planted import follow_feet, heading_of, stand
from clamber.families.walker.control.cooperative.planted_feet import N_ROWS, LimitError, PlantedFeet
from clamber.families.walker.control.cooperative.plate_bounds import bound_gradients, bound_values, guard_room
from clamber.families.walker.control.cooperative.scratch import Scratch, make_scratch, see_bounds, see_measure, see_tool
from clamber.families.walker.robot import WalkerRobot
from clamber.families.walker.robot.geometry import TwoFrames
from clamber.families.walker.robot.two_frames import singular_measure
from clamber.types import Floats

SEEDS = range(6)


def footing(robot: WalkerRobot, support: str, seed: int = 0, tilt: float = 0.0) -> PlantedFeet:
    rng = np.random.default_rng(seed)
    pose = np.array([0.2, -0.1, 0.4, 0.7, *rng.uniform(-tilt, tilt, 2)]) if tilt else np.array([0, 0, 0.38, 0.4, 0, 0])
    return PlantedFeet(
        robot=robot,
        support=support,  # type: ignore[arg-type]
        pose=pose,
        offset=(0.03, -0.02),
        twist=0.1,
        heights=rng.uniform(-0.03, 0.03, (2, 3)),
        payload=1.5,
    )


def turn_of(q: Floats) -> Floats:
    return Rotation.from_euler("ZYX", q[3:6]).as_matrix()


def near(stance: PlantedFeet, robot: WalkerRobot, seed: int, tilt: float = 0.17) -> Floats:
    """A configuration near the pose of a footing; on its feet where the Delta-frame stands."""
    rng = np.random.default_rng(100 + seed)
    q = random_q(robot, seed)
    q[:6] = stance.pose + rng.uniform(-1, 1, 6) * (0.02, 0.02, 0.04, 0.1, tilt, tilt)
    if stance.support != "y":
        record = stance.record()[0]
        stand(q, record["anchor"], record["heading"])
    return q


def plain_values(stance: PlantedFeet, robot: WalkerRobot, q: Floats) -> Floats:
    """A second reading of the bounds, from places of points in the world."""
    arm = robot.arm
    assert arm is not None
    turn, origin = turn_of(q), q[:3]
    offset, twist = np.array(stance.offset), stance.twist
    if stance.support == "y":
        middle = stance.feet_on_ground()[1].mean(axis=0)
        offset = (turn.T @ (middle - origin))[:2]
        twist = stance.twist + heading_of(stance.pose[3:6]) - heading_of(q[3:6])
    inner = np.array([[np.cos(twist), -np.sin(twist)], [np.sin(twist), np.cos(twist)]])
    attach = robot.attachments()
    out = np.full(N_ROWS, np.nan)
    arms = attach[1] @ inner.T + offset - attach[0]
    out[:3] = np.linalg.norm(arms, axis=1)
    nearness = TwoFrames.of(robot.mechanism).nearness((*offset, twist))
    out[3] = robot.mechanism.guard**2 - nearness**2
    feet = robot.feet()
    feet[1] = feet[1] @ inner.T + offset
    for frame in range(2):
        for i in range(3):
            top = origin + turn[:, :2] @ feet[frame, i]
            out[4 + 3 * frame + i] = (top[2] - stance.heights[frame, i]) / turn[2, 2]  # along the plate's normal
    masses = [robot.mass.frames * robot.mass.share_delta, robot.mass.frames * (1 - robot.mass.share_delta)]
    places = [np.array([0, 0, robot.mass.height]), np.array([*offset, robot.mass.height])]
    yaw, pitch = q[6], 0.0
    out_of, up = np.array([np.cos(yaw), np.sin(yaw), 0.0]), np.array([0.0, 0.0, 1.0])
    here = arm.out * out_of + arm.up * up
    for length, mass, joint in zip(arm.links, arm.masses, q[7:], strict=True):
        pitch += joint
        along = np.cos(pitch) * out_of + np.sin(pitch) * up
        masses.append(mass)
        places.append(here + 0.5 * length * along)
        here = here + length * along
    masses.append(stance.payload)
    places.append(here)
    centre = (origin + np.average(places, axis=0, weights=masses) @ turn.T)[:2]
    ground = stance.feet_on_ground()[list(stance.standing())].reshape(-1, 3)[:, :2]
    if len(ground) == 3:
        corners = [*ground, ground[0]]
        inside = []
        for a, b in pairwise(corners):
            along = (b - a) / np.linalg.norm(b - a)
            inside.append(along[0] * (centre - a)[1] - along[1] * (centre - a)[0])
        out[10:13] = np.sort(inside)
    return out


def seen(stance: PlantedFeet, robot: WalkerRobot, q: Floats) -> Scratch:
    assert robot.arm is not None
    w = make_scratch(robot.arm.n_joints)
    chain = chain_of(robot, balance=0.0, footing=stance)
    see_tool(chain, q, w)
    see_bounds(chain, stance.record()[0], q, w)
    return w


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("support", ["delta", "y"])
@pytest.mark.parametrize("name", ROBOTS)
def test_the_bounds_are_those_of_a_second_reading(name: str, support: str, seed: int) -> None:
    robot = ROBOTS[name]
    stance = footing(robot, support, seed, tilt=0.1)
    q = near(stance, robot, seed)
    values = seen(stance, robot, q).values.copy()
    plain = plain_values(stance, robot, q)
    values[10:13] = np.sort(values[10:13])
    np.testing.assert_allclose(values[:13], plain[:13], atol=1e-12, rtol=0)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("support", ["delta", "y", "both"])
def test_the_bounds_gradients_are_those_of_central_differences(support: str, seed: int) -> None:
    robot = hoshino()
    stance = footing(robot, support, seed, tilt=0.1)
    q = near(stance, robot, seed)
    record, chain = stance.record()[0], chain_of(robot, balance=0.0, footing=stance)

    def values(p: Floats) -> Floats:
        w = make_scratch(4)
        if support != "y":
            p = p.copy()
            stand(p, record["anchor"], record["heading"])
        see_tool(chain, p, w)
        see_bounds(chain, record, p, w)
        return w.values.copy()

    slopes = differences(values, q)
    if support != "y":
        slopes[[0, 1, 3]] = 0.0
    np.testing.assert_allclose(seen(stance, robot, q).gradients, slopes.T, atol=1e-7, rtol=0)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_free_plates_gradients_are_those_of_central_differences(seed: int) -> None:
    """Before they are led along the feet; every row, with the mechanism that moves."""
    robot = hoshino()
    stance = footing(robot, "y", seed, tilt=0.1)
    q = near(stance, robot, seed)
    record, w = stance.record()[0], seen(stance, robot, q)

    def values(p: Floats) -> Floats:
        v = seen(stance, robot, p)
        out = np.empty(N_ROWS)
        bound_values(record, p, v, out)
        return out

    bound_gradients(record, q, w)
    np.testing.assert_allclose(w.gradients[:13], differences(values, q).T[:13], atol=1e-7, rtol=0)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_guard_of_any_mechanism_has_its_slope(seed: int) -> None:
    rng = np.random.default_rng(seed)
    delta, y, pose = rng.normal(size=(3, 2)), rng.normal(size=(3, 2)), rng.normal(size=3)
    slope = np.empty(3)

    def room(p: Floats) -> float:
        return float(guard_room(delta, y, p, 0.9, np.empty(3)))

    value = guard_room(delta, y, pose, 0.9, slope)
    ratio = singular_measure(delta, y, *pose) / singular_measure(delta, y, 0.0, 0.0, pose[2])
    assert value == pytest.approx(ratio - 1.0 + 0.81)
    np.testing.assert_allclose(slope, differences(room, pose), rtol=1e-6, atol=1e-7)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_plate_stands_where_its_feet_strain_least(seed: int) -> None:
    """Feet that give alike across the ground: x, y and alpha minimise the sum of the squared distances from where they were planted."""
    robot = hoshino()
    assert robot.arm is not None
    stance = PlantedFeet(robot=robot, support="delta", pose=np.array([0.1, -0.2, 0.4, 0.5, 0.0, 0.0]))
    planted = stance.feet_on_ground()[0]
    q = near(stance, robot, seed)

    def strain(free: Floats) -> float:
        pose = np.array([free[0], free[1], q[2], free[2], q[4], q[5]])
        turn = turn_of(pose)
        tops = pose[:3] + robot.feet()[0] @ turn[:, :2].T
        soles = tops - turn[:, 2] * (tops[:, 2] / turn[2, 2])[:, None]
        return float(((soles - planted)[:, :2] ** 2).sum())

    best = minimize(strain, q[[0, 1, 3]] + 0.01, method="BFGS", options={"gtol": 1e-12}).x
    np.testing.assert_allclose(q[[0, 1, 3]], best, atol=2e-6)


def test_a_tilt_of_ten_degrees_moves_the_plate_by_its_legs_length() -> None:
    robot = hoshino()
    stance = PlantedFeet(robot=robot, support="delta", pose=np.array([0, 0, 0.35, 0, 0, 0]))
    q = np.array([0, 0, 0.35 * np.cos(np.radians(10)), 0, np.radians(10), 0, *np.zeros(4)])
    record = stance.record()[0]
    stand(q, record["anchor"], record["heading"])
    assert q[0] == pytest.approx(0.35 * np.sin(np.radians(10)))
    assert q[1] == pytest.approx(0.0)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_derivatives_along_the_feet_are_those_of_central_differences(seed: int) -> None:
    robot = hoshino()
    stance = footing(robot, "delta", seed, tilt=0.1)
    q = near(stance, robot, seed)
    record = stance.record()[0]

    def stood(p: Floats) -> Floats:
        p = p.copy()
        stand(p, record["anchor"], record["heading"])
        return p[[0, 1, 3]]

    def follow(p: Floats) -> Floats:
        p = p.copy()
        stand(p, record["anchor"], record["heading"])
        first, second = np.empty((3, 3)), np.empty((3, 3, 3))
        follow_feet(p, record["anchor"], first, second)
        return first

    first, second = np.empty((3, 3)), np.empty((3, 3, 3))
    follow_feet(q, record["anchor"], first, second)
    np.testing.assert_allclose(first, differences(stood, q)[[2, 4, 5]].T, atol=1e-8)
    np.testing.assert_allclose(second, differences(follow, q)[[2, 4, 5]].transpose(1, 2, 0), atol=1e-8)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("support", ["delta", "y"])
def test_the_manipulability_of_a_standing_robot_has_its_gradient(support: str, seed: int) -> None:
    robot = hoshino()
    stance = footing(robot, support, seed, tilt=0.1)
    q = near(stance, robot, seed)
    record, chain = stance.record()[0], chain_of(robot, balance=0.0, footing=stance)
    rng = np.random.default_rng(seed)
    speeds, tool_speeds = rng.uniform(0.1, 0.5, q.size), rng.uniform(0.1, 0.3, 3)

    def measure(p: Floats) -> float:
        w = make_scratch(4)
        if support != "y":
            p = p.copy()
            stand(p, record["anchor"], record["heading"])
        see_tool(chain, p, w)
        see_bounds(chain, record, p, w)
        return float(see_measure(speeds, tool_speeds, w))

    w = seen(stance, robot, q)
    value = see_measure(speeds, tool_speeds, w)
    assert value == pytest.approx(np.sqrt(np.linalg.det(w.scaled @ w.scaled.T)), rel=1e-12)
    slopes = differences(measure, q) * speeds
    if support != "y":
        slopes[[0, 1, 3]] = 0.0
    np.testing.assert_allclose(w.gradient, slopes, atol=1e-7, rtol=1e-7)


def test_a_stance_that_cannot_be_is_named() -> None:
    with pytest.raises(LimitError, match="payload"):
        PlantedFeet(robot=hoshino(), support="delta", pose=np.zeros(6), payload=-1.0)
    with pytest.raises(LimitError, match="six finite numbers"):
        PlantedFeet(robot=hoshino(), support="delta", pose=np.array([0, 0, np.nan, 0, 0, 0]))
