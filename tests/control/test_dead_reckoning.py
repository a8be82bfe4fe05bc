"""Where the plate is by the feet that stand: poses are found back, feet that do not count do not, and errors are shared."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from clamber.families.walker.control.dead_reckoning import leg_places, orient, reckon, soles_in_world
from clamber.families.walker.robot import WalkerRobot
from clamber.tasks.robots import load_robot
from clamber.types import Floats

SEEDS = range(20)


def drawn(seed: int) -> tuple[Floats, Floats, Floats]:
    """A pose of the plate, places of its legs, their lengths."""
    rng = np.random.default_rng(seed)
    robot = load_robot("hoshino")
    assert isinstance(robot, WalkerRobot)
    pose = np.array((*rng.uniform(-2, 2, 2), 0.4, rng.uniform(-3, 3), *rng.uniform(-0.2, 0.2, 2)))
    places = np.empty((6, 2))
    leg_places(robot.feet(), np.array((*rng.uniform(-0.06, 0.06, 2), rng.uniform(-0.2, 0.5))), places)
    return pose, places, rng.uniform(0.28, 0.42, 6)


def soles_of(pose: Floats, places: Floats, lengths: Floats) -> Floats:
    turn = Rotation.from_euler("ZYX", pose[3:]).as_matrix()
    feet: Floats = pose[:3] + np.column_stack([places, -lengths]) @ turn.T
    return feet


@pytest.mark.parametrize("seed", SEEDS)
def test_orientation_and_soles_are_those_of_the_rotation(seed: int) -> None:
    pose, places, lengths = drawn(seed)
    matrix, soles = np.empty((3, 3)), np.empty((6, 3))
    orient(*pose[3:], matrix)
    np.testing.assert_allclose(matrix, Rotation.from_euler("ZYX", pose[3:]).as_matrix(), atol=1e-12)
    soles_in_world(pose, places, lengths, soles, matrix)
    np.testing.assert_allclose(soles, soles_of(pose, places, lengths), atol=1e-12)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_plate_on_known_footholds_is_found_and_lifted_feet_do_not_count(seed: int) -> None:
    pose, places, lengths = drawn(seed)
    soles, matrix = soles_of(pose, places, lengths), np.empty((3, 3))
    rng = np.random.default_rng(seed)
    stands = np.ones(6, np.int32)
    stands[3 * (seed % 2) : 3 * (seed % 2) + 3] = 0
    wrong = soles + np.where(stands[:, None] > 0, 0.0, rng.uniform(-1, 1, (6, 3)))
    guess, out = pose + rng.uniform(-0.3, 0.3, 6), np.empty((6, 3))
    assert reckon(places, lengths, wrong[:, :2].copy(), wrong[:, 2].copy(), stands, guess, out, matrix)
    np.testing.assert_allclose(guess, pose, atol=1e-9)
    np.testing.assert_allclose(out, soles, atol=1e-9)


def test_the_heading_goes_on_past_whole_turns() -> None:
    pose, places, lengths = drawn(0)
    soles, matrix, out = soles_of(pose, places, lengths), np.empty((3, 3)), np.empty((6, 3))
    guess = pose + np.array((0, 0, 0, 4 * math.pi + 0.1, 0, 0))
    assert reckon(places, lengths, soles[:, :2].copy(), soles[:, 2].copy(), np.ones(6, np.int32), guess, out, matrix)
    assert guess[3] == pytest.approx(pose[3] + 4 * math.pi)


def test_levelling_by_ten_degrees_moves_the_plate_by_sixty_millimetres() -> None:
    """Rigid legs normal to the plate, soles that stay on the whole: the plate goes by its height times the sine of the tilt."""
    robot = load_robot("hoshino")
    assert isinstance(robot, WalkerRobot)
    places, matrix, out = np.empty((6, 2)), np.empty((3, 3)), np.empty((6, 3))
    leg_places(robot.feet(), np.zeros(3), places)
    tilt, stands = math.radians(10.0), np.ones(6, np.int32)
    tilted = np.array((0.0, 0.0, 0.35 * math.cos(tilt), 0.0, tilt, 0.0))
    soles = soles_of(tilted, places, np.full(6, 0.35))
    level = tilted.copy()
    assert reckon(places, 0.35 - soles[:, 2], soles[:, :2].copy(), soles[:, 2].copy(), stands, level, out, matrix)
    assert level[4:] == pytest.approx((0.0, 0.0), abs=1e-12)
    assert level[2] == pytest.approx(0.35, abs=1e-12)
    assert level[0] == pytest.approx(-0.35 * math.sin(tilt), abs=1e-9)  # 60.8 mm


def test_two_feet_tell_no_posture_and_the_pose_stays() -> None:
    pose, places, lengths = drawn(1)
    soles, matrix, out = soles_of(pose, places, lengths), np.empty((3, 3)), np.empty((6, 3))
    guess = pose.copy()
    stands = np.array([1, 0, 0, 1, 0, 0], np.int32)
    assert not reckon(places, lengths, soles[:, :2].copy(), soles[:, 2].copy(), stands, guess, out, matrix)
    np.testing.assert_array_equal(guess, pose)
