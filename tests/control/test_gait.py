"""Tracks, steps and balance of a two-frame walker, against the paper's numbers, integration, and parts added up by hand."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from clamber.control.support import support_margin
from clamber.families.walker.control.gait import (
    DELTA,
    Limits,
    PhaseTimes,
    Y,
    eased_share,
    farthest_step,
    lengths_at,
    room_at,
    slide_balance,
    slide_places,
    slide_seconds,
)
from clamber.families.walker.control.track import (
    Track,
    along_twist,
    straight,
    through,
    twist_between,
)
from clamber.families.walker.control.walker_balance import mass_centre, mass_moment
from clamber.families.walker.robot import TwoFrames, WalkerRobot
from clamber.families.walker.robot.plane_poses import compose, seen_from
from clamber.families.walker.robot.weight import arm_places, weight_of
from clamber.tasks.robots import load_robot
from clamber.types import Floats
from tracks import turn_about

found = load_robot("hoshino")
assert isinstance(found, WalkerRobot)
ROBOT = found
RADIUS = ROBOT.legs.radius_delta
START = np.zeros(3)
ARM = np.array((0.0, math.pi / 2, 0.0, 0.0))  # upright over its axis
WHOLE = Limits(guard=0.9, reserve=0.0, balance=-1.0)  # what the mechanism can, whatever the balance
POSE = st.tuples(st.floats(-2, 2), st.floats(-2, 2), st.floats(-3, 3)).map(np.array)


def strides(track: Track, count: int = 4, limits: Limits = WHOLE) -> list[float]:
    """Ways that the frames go in turn, once the gait is in its stride."""
    poses, ways, gone = np.stack([track.start, track.start]), np.zeros(2), []
    for k in range(count):
        swing = Y if k % 2 == 0 else DELTA
        step = farthest_step(ROBOT, track, poses, ways, swing, neutral=0.0, arm=ARM, limits=limits)
        assert step is not None
        gone.append(step.way - ways[swing])
        poses[swing], ways[swing] = step.end, step.way
    return gone[1:]


@given(POSE, POSE)
def test_seeing_from_a_frame_undoes_going_into_it(a: Floats, b: Floats) -> None:
    np.testing.assert_allclose(seen_from(a, compose(a, b)), b, atol=1e-12)


@given(POSE, st.floats(0.0, 1.0))
def test_a_twist_goes_where_its_integral_goes(twist: Floats, share: float) -> None:
    pose = np.zeros(3)
    n = 400
    for _ in range(n):  # midpoint rule
        half = compose(pose, share / n * twist / 2)
        pose = np.array(
            (*compose(np.array((*pose[:2], half[2])), share / n * twist)[:2], pose[2] + share / n * twist[2])
        )
    np.testing.assert_allclose(along_twist(twist, share), pose, atol=1e-4)


def test_tracks_go_where_they_say() -> None:
    start = np.array((0.3, -0.2, 0.7))
    there = straight(start, 0.5, 0.8, RADIUS).pose(0.8)
    np.testing.assert_allclose(there, (0.3 + 0.8 * math.cos(1.2), -0.2 + 0.8 * math.sin(1.2), 0.7))
    centre = np.array((0.1, 0.4))
    round_it = turn_about(start, centre, 1.1, RADIUS)
    for way in np.linspace(0.0, round_it.length, 7):
        assert math.dist(round_it.pose(way)[:2], centre) == pytest.approx(math.dist(start[:2], centre))
    assert round_it.pose(round_it.length)[2] == pytest.approx(1.8)
    walked = through(start, np.array(((1.0, 0.0, 0.7), (1.0, 1.0, 0.7))), RADIUS)
    np.testing.assert_allclose(walked.pose(walked.length), (1.0, 1.0, 0.7), atol=1e-12)
    np.testing.assert_allclose(walked.pose(math.dist(start[:2], (1.0, 0.0))), (1.0, 0.0, 0.7), atol=1e-12)
    spun = Track.of(start, [np.array((0.2, 0.1, 1.0))], RADIUS)
    np.testing.assert_allclose(spun.pose(spun.length), compose(start, along_twist(np.array((0.2, 0.1, 1.0)), 1.0)))


@given(POSE, POSE)
def test_a_twist_toward_a_pose_goes_there(a: Floats, b: Floats) -> None:
    there = compose(a, along_twist(twist_between(a, b), 1.0))
    np.testing.assert_allclose(there[:2], b[:2], atol=1e-9)
    assert math.remainder(there[2] - b[2], math.tau) == pytest.approx(0.0, abs=1e-12)
    assert abs(twist_between(a, b)[2]) <= math.pi


@given(st.lists(POSE, min_size=1, max_size=8), st.sampled_from((0.0, 0.05, 0.3)))
def test_a_track_through_poses_passes_each_of_them_in_order(poses: list[Floats], within: float) -> None:
    every = np.array(poses)
    track = through(START, every, RADIUS, within=within)
    ways = np.linspace(0.0, track.length, 300)
    gone = np.array([track.pose(way) for way in ways])
    turns = np.remainder(gone[:, None, 2] - every[:, 2] + math.pi, math.tau) - math.pi
    off = np.hypot(np.hypot(*(gone[:, None, :2] - every[:, :2]).transpose(2, 0, 1)), RADIUS * turns)
    reached = 0
    for k in range(len(every)):  # a pose is met after the one before it
        near = np.flatnonzero(off[reached:, k] <= within + track.length / 150)
        assert near.size, f"pose {k} is passed by {off[reached:, k].min()}"
        reached += int(near[0])
    end = track.pose(track.length)
    assert np.hypot(*(end[:2] - every[-1, :2])) < 1e-9


def test_many_points_of_a_smooth_path_become_few_pieces() -> None:
    angles = np.linspace(0.0, math.pi, 400)
    circle = np.column_stack((np.sin(angles), 1.0 - np.cos(angles), angles))
    with_it = through(START, circle, RADIUS, within=1e-6)
    assert len(with_it.twists) == 1  # an arc is one twist
    np.testing.assert_allclose(with_it.twists[0], (math.pi, 0.0, math.pi), atol=1e-9)
    circle[:, 2] = 0.0
    kept = through(START, circle, RADIUS, within=5e-3)
    assert 8 <= len(kept.twists) <= 20  # chords of 5 mm sagitta are 0.2 m long
    there_and_back = np.array(((1.0, 0.0, 0.0), (0.5, 0.0, 0.0), (2.0, 0.0, 0.0)))
    assert through(START, there_and_back, RADIUS, within=5e-3).length == pytest.approx(3.0)


def test_lengths_are_those_of_the_mechanism() -> None:
    frames = TwoFrames.of(ROBOT.mechanism)
    places = np.random.default_rng(0).uniform((-0.05, -0.05, -0.2), (0.05, 0.05, 0.5), (20, 3))
    for place, lengths in zip(places, lengths_at(ROBOT, places), strict=True):
        np.testing.assert_allclose(lengths, frames.lengths(place), atol=1e-12)


@pytest.mark.parametrize("n", range(6))
def test_the_longest_steps_are_160_mm_at_30_and_60_degrees_on(n: int) -> None:
    for stride in strides(straight(START, math.radians(30 + 60 * n), 2.0, RADIUS)):
        assert stride == pytest.approx(0.16006, abs=0.0015)  # found to 1 mm
    for stride in strides(straight(START, math.radians(60 * n), 2.0, RADIUS)):
        assert stride == pytest.approx(0.1377, abs=0.0015)


def test_a_turn_on_the_spot_steps_by_66_degrees_and_about_a_point_half_a_metre_off_by_20() -> None:
    for stride in strides(turn_about(START, np.zeros(2), 6.0, RADIUS)):
        assert math.degrees(stride / RADIUS) == pytest.approx(65.9, abs=0.5)
    track = turn_about(START, np.array((0.0, 0.5)), 2.0, RADIUS)
    per_way = 2.0 / track.length
    assert math.degrees(np.mean(strides(track)) * per_way) == pytest.approx(20.0, abs=2.0)


def test_130_mm_a_minute_need_the_time_of_a_whole_cycle() -> None:
    """Equation 1 of Hoshino and others (1995), v = (1 - duty) / duty * step / T: T as the whole cycle is the only reading that fits."""
    duty = PhaseTimes(lift=10.0, slide=16.9, lower=10.0, settle=0.0).duty
    assert duty == pytest.approx(0.5)
    assert (1.0 - duty) / duty * 0.160 / 73.85 * 60.0 == pytest.approx(0.130, abs=1e-4)


def test_a_step_of_160_mm_takes_17_seconds_by_the_actuators_own_speed() -> None:
    ways = np.stack([np.zeros(51), np.linspace(-0.0616, 0.0985, 51), np.zeros(51)], axis=1)
    seconds = slide_seconds(ROBOT, ways, 0.5)
    assert seconds == pytest.approx(0.160 / 0.00947 + 0.5, rel=0.02)


@given(st.floats(0.2, 60.0), st.floats(0.01, 2.0))
def test_a_slide_starts_and_ends_at_rest_and_is_never_faster_than_reckoned(seconds: float, ramp: float) -> None:
    times = np.linspace(0.0, seconds, 500)
    shares = np.array([eased_share(float(t), seconds, ramp) for t in times])
    rates = np.diff(shares) / np.diff(times)
    rise = min(ramp, 0.5 * seconds)
    assert shares[0] == 0.0
    assert shares[-1] == pytest.approx(1.0)
    assert rates.min() >= -1e-9
    assert rates.max() <= 1.0 / (seconds - rise) * (1.0 + 1e-6)
    if ramp > 0.05 * seconds:
        assert rates[0] < 0.2 * rates.max()


@pytest.mark.parametrize("swing", [DELTA, Y])
def test_no_step_leaves_its_room_or_its_balance(swing: int) -> None:
    limits = Limits()
    for seed in range(10):
        rng = np.random.default_rng(seed)
        track = Track.of(START, [rng.uniform((-1, -1, -1), (1, 1, 1))], RADIUS)
        step = farthest_step(ROBOT, track, np.zeros((2, 3)), np.zeros(2), swing, neutral=0.0, arm=ARM, limits=limits)
        assert step is not None
        places = slide_places(START, START, step.end, swing, np.linspace(0, 1, 200))
        assert room_at(ROBOT, places, limits).min() > -1e-4  # seen at 24 places, here at 200
        assert slide_balance(ROBOT, places, swing, ARM).min() >= limits.balance - 1e-3
        further = farthest_step(
            ROBOT, track, np.zeros((2, 3)), np.zeros(2), swing, neutral=0.0, arm=ARM, limits=limits, longest=0.03
        )
        assert further is not None
        assert further.way == pytest.approx(min(0.03, step.way), abs=1e-3)


def by_hand(place: Floats, arm: Floats, payload: float) -> Floats:
    spec = ROBOT.arm
    assert spec is not None
    share, height = ROBOT.mass.share_delta, ROBOT.mass.height
    total = ROBOT.mass.frames * (share * np.array((0, 0, height)) + (1 - share) * np.array((*place[:2], height)))
    mass, radius, up, pitch = ROBOT.mass.frames, spec.out, spec.up, 0.0
    aside = np.array((math.cos(arm[0]), math.sin(arm[0])))
    for length, link, angle in zip(spec.links, spec.masses, arm[1:], strict=True):
        pitch += angle
        r, z = length * math.cos(pitch), length * math.sin(pitch)
        total = total + link * np.array((*((radius + r / 2) * aside), up + z / 2))
        mass, radius, up = mass + link, radius + r, up + z
    total = total + payload * np.array((*(radius * aside), up))
    return np.asarray(total / (mass + payload))


@pytest.mark.parametrize("seed", range(10))
def test_the_centre_of_mass_is_that_of_the_parts(seed: int) -> None:
    rng = np.random.default_rng(seed)
    place, arm, payload = rng.uniform(-0.1, 0.1, 3), rng.uniform(-1, 1, 4), rng.uniform(0, 10)
    expected = by_hand(place, arm, payload)
    mass, centre = mass_moment(ROBOT, place, arm, payload)
    np.testing.assert_allclose(centre, expected, atol=1e-12)
    assert weight_of(ROBOT, payload=payload).total == pytest.approx(mass)
    pose = np.array((0.3, -0.4, 0.5, 1.2, 0.0, 0.0))
    turned = compose(pose[[0, 1, 3]], np.array((*expected[:2], 0.0)))[:2]
    np.testing.assert_allclose(mass_centre(ROBOT, pose, place, arm, payload), (*turned, 0.5 + expected[2]), atol=1e-12)
    assert ROBOT.arm is not None
    np.testing.assert_allclose(
        np.linalg.norm(np.diff(arm_places(ROBOT.arm, arm.tolist()), axis=0), axis=1), ROBOT.arm.links
    )


def test_ten_kilograms_at_eight_hundred_millimetres_stand_in_the_middle_and_tip_at_the_end_of_a_slide() -> None:
    """Mass 80 kg, of which 6 kg are the arm, here folded in over its axis; the load is told as a payload of a longer arm."""
    reach = math.acos((0.8 - 0.05) / 0.75)
    arm = np.array((math.pi / 2, reach, 0.0, 0.0))
    still = np.zeros((1, 3))
    centre = mass_moment(ROBOT, np.zeros(3), arm, 10.0)[1]
    assert np.hypot(*centre[:2]) == pytest.approx(0.089 + 6.0 * 0.4 / 90.0, abs=0.02)  # the arm's own weight on top
    least = min(
        slide_balance(ROBOT, still, Y, np.array((angle, reach, 0.0, 0.0)), 10.0)[0]
        for angle in np.linspace(0, math.tau, 73)
    )
    ends = np.array([[0.0, 0.0985, 0.0], [0.0, -0.0616, 0.0]])
    tips = min(
        slide_balance(ROBOT, ends, swing, np.array((angle, reach, 0.0, 0.0)), 10.0).min()
        for swing in (DELTA, Y)
        for angle in np.linspace(0, math.tau, 73)
    )
    assert 0.0 < least < 0.03
    assert tips < -0.03
    light = min(
        slide_balance(ROBOT, ends, swing, np.array((angle, math.acos(0.55 / 0.75), 0.0, 0.0)), 5.0).min()
        for swing in (DELTA, Y)
        for angle in np.linspace(0, math.tau, 73)
    )
    assert light > 0.0


@pytest.mark.parametrize("seed", range(10))
def test_the_support_margin_is_the_distance_to_the_nearest_edge(seed: int) -> None:
    rng = np.random.default_rng(seed)
    feet = rng.uniform(-0.3, 0.3, (6, 2))
    from scipy.spatial import ConvexHull

    hull = ConvexHull(feet)
    for point in rng.uniform(-0.3, 0.3, (20, 2)):
        outside = (hull.equations[:, :2] @ point + hull.equations[:, 2]).max()
        assert support_margin(feet, np.ones(6, np.int32), point) == pytest.approx(-outside, abs=1e-9)
    assert support_margin(feet, np.array([1, 1, 0, 0, 0, 0], np.int32), np.zeros(2)) == -math.inf
