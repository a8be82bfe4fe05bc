"""Regions of the two-frame mechanism as exact arcs, beside grids, scans and closed forms."""

import math

import numpy as np
import pytest
from scipy.ndimage import label
from test_two_frames import hoshino, random_frames, random_pose, similar_frames

from clamber.families.walker.robot.curves import BRANCH, ELLIPSE
from clamber.families.walker.robot.geometry import TwoFrames
from clamber.families.walker.robot.turning import turning_range
from clamber.families.walker.robot.workspace import Workspace, best_directions, half_plane, stride, workspace
from tiers import first_fast

MM = 1e-3
CM2 = 1e-4
DEG = math.pi / 180.0
RADIUS = 238.4 * MM


def rho_at(theta: float) -> float:
    return 2.0 * RADIUS * math.sin(abs(60.0 * DEG - theta) / 2.0)


def grid(frames: TwoFrames, theta: float, guard: float | None, size: float, cells: int) -> tuple[np.ndarray, float]:
    """Cells of a square whose middles have all lengths in range, by complex numbers, and the area of a cell."""
    step = 2.0 * size / cells
    line = -size + step * (np.arange(cells) + 0.5)
    place = line[:, None] + 1j * line[None, :]  # [x, y]
    arms = np.exp(1j * theta) * (frames.y @ (1, 1j)) - frames.delta @ (1, 1j)
    lengths = abs(place[..., None] + arms)
    held = (lengths >= frames.shortest).all(axis=-1) & (lengths <= frames.longest).all(axis=-1)
    if guard is not None:
        v, moment_of = place[..., None] + arms, np.exp(1j * theta) * (frames.y @ (1, 1j))

        def measure(v: np.ndarray) -> np.ndarray:
            rows = np.stack([v.real, v.imag, (np.conj(moment_of) * v).imag], axis=-1)
            return np.linalg.det(rows)

        held &= measure(v) / measure(arms) >= 1.0 - guard**2
    return held, step * step


def mechanism(a: np.ndarray, b: np.ndarray, shortest: float, longest: float) -> TwoFrames:
    return TwoFrames(a, b, shortest, longest, 0.9)


@pytest.mark.slow
@pytest.mark.parametrize(("theta", "area"), [(-15, 4.78), (0, 168.3), (10, 401.2), (20, 596.3), (40, 1402.6)])
@pytest.mark.parametrize("guard", [None, 0.9, 1.0])
def test_areas_are_those_of_a_grid_count(theta: float, area: float, guard: float | None) -> None:
    space = workspace(hoshino(), theta * DEG, guard=guard)
    held, cell = grid(hoshino(), theta * DEG, guard, 0.33, 1500)
    assert space.area == pytest.approx(held.sum() * cell, rel=2e-3, abs=2e-6)
    if guard is None:
        assert space.area / CM2 == pytest.approx(area, rel=1e-3)


@pytest.mark.parametrize("seed", first_fast(range(24), 8))
@pytest.mark.parametrize("make", [random_frames, similar_frames])
def test_regions_of_any_mechanism_are_those_of_a_grid(make, seed: int) -> None:
    """Areas and numbers of connected parts; a part or a gap of a few cells may escape the grid."""
    rng = np.random.default_rng(seed)
    some = make(seed)
    frames = mechanism(some.delta, some.y, rng.uniform(0.1, 0.3), rng.uniform(0.5, 0.7))
    theta = rng.uniform(-math.pi, math.pi)
    guard = rng.choice([None, 0.7, 1.0])
    held, cell = grid(frames, theta, guard, 1.6, 800)
    space = workspace(frames, theta, guard=guard)
    assert space.area == pytest.approx(held.sum() * cell, rel=5e-3, abs=40 * cell)
    numbered, _ = label(held, np.ones((3, 3)))
    counted = np.sort(np.bincount(numbered.ravel())[1:] * cell)[::-1]
    large = [part.area for part in space.parts if part.area > 100 * cell]
    np.testing.assert_allclose(large, [one for one in counted if one > 100 * cell], rtol=0.02)
    middle = numbered[400, 400]
    central = space.central
    if middle and space.depth((0.0, 0.0)) > 0.01:
        assert central is not None
        assert central.area == pytest.approx((numbered == middle).sum() * cell, rel=0.02)
    if space.depth((0.0, 0.0)) < 0.0:
        assert central is None


def loops_of(space: Workspace):
    return [loop for part in space.parts for loop in part.loops]


@pytest.mark.parametrize("theta", [-15, 0, 10, 25, 30, 40, 46.5])
@pytest.mark.parametrize("guard", [None, 0.9])
def test_boundaries_are_closed_and_lie_on_the_limits(theta: float, guard: float | None) -> None:
    space = workspace(hoshino(), theta * DEG, guard=guard)
    for loop in loops_of(space):
        for arc, after in zip(loop, (*loop[1:], loop[0]), strict=True):
            np.testing.assert_allclose(arc.end, after.start, atol=1e-9)
            assert max(abs(space.depth(point)) for point in arc.points()) < 1e-12
            np.testing.assert_allclose(arc.points()[-1], arc.end, atol=1e-12)


@pytest.mark.parametrize("seed", range(40))
def test_conics_of_singular_poses_bound_what_they_should(seed: int) -> None:
    """Ellipses and hyperbolas, either side of them: closed boundaries on the limits, strides and extents that end there."""
    rng = np.random.default_rng(seed)
    some = random_frames(seed)
    frames = mechanism(some.delta, some.y, rng.uniform(0.1, 0.3), rng.uniform(0.5, 0.8))
    theta, guard = rng.uniform(-math.pi, math.pi), rng.choice([0.5, 0.7, 0.9, 1.0])
    space = workspace(frames, theta, guard=guard)
    assert space.curves[6, 0] in (ELLIPSE, BRANCH)
    for loop in loops_of(space):
        for arc, after in zip(loop, (*loop[1:], loop[0]), strict=True):
            np.testing.assert_allclose(arc.end, after.start, atol=1e-9)
            assert max(abs(space.depth(point)) for point in arc.points()) < 1e-10
    for angle in np.arange(0.0, math.tau, 0.9):
        along = np.array([math.cos(angle), math.sin(angle)])
        if space.central is not None:
            least, most = space.extent(angle)
            points = np.vstack([arc.points(0.002) for arc in space.central.loops[0]]) @ along
            assert (least, most) == (pytest.approx(points.min(), abs=2e-5), pytest.approx(points.max(), abs=2e-5))
        ahead = stride(frames, theta, angle, guard=guard).ahead
        for s, inside in ((0.5 * ahead, True), (ahead - 1e-6, True), (ahead + 1e-6, False)):
            pose = (*(s * along), theta)
            if ahead > 1e-5:
                assert (frames.room(pose) >= 0.0 and frames.nearness(pose) <= guard) == inside


@pytest.mark.parametrize("seed", range(10))
def test_area_does_not_depend_on_where_the_delta_frame_is_drawn(seed: int) -> None:
    rng = np.random.default_rng(seed)
    frames = random_frames(seed)
    turn, shift = rng.uniform(-3, 3), rng.uniform(-1, 1, 2)
    c, s = math.cos(turn), math.sin(turn)
    moved = frames.delta @ np.array([[c, s], [-s, c]]) + shift
    other = workspace(mechanism(moved, frames.y, 0.2, 0.6), 0.3 + turn)
    here = workspace(mechanism(frames.delta, frames.y, 0.2, 0.6), 0.3)
    np.testing.assert_allclose([p.area for p in other.parts], [p.area for p in here.parts], rtol=1e-9, atol=1e-12)


def test_one_ring_and_one_disc_have_their_textbook_areas() -> None:
    a = np.zeros((3, 2))
    ring = workspace(mechanism(a, a, 0.1, 0.3), 0.0)
    assert len(ring.parts) == 1 and len(ring.parts[0].loops) == 2
    assert ring.area == pytest.approx(math.pi * (0.3**2 - 0.1**2), rel=1e-12)
    assert ring.central is None
    half = workspace(mechanism(a, a, 0.1, 0.3), 0.0, besides=np.array([half_plane((1.0, 0.0), 0.0)]))
    assert half.area == pytest.approx(0.5 * ring.area, rel=1e-12)
    far = np.array([[0.2, 0.0], [-0.2, 0.0], [-0.2, 0.0]])
    lens = workspace(mechanism(far, a, 1e-6, 0.3), 0.0)  # two discs of radius r, d apart
    r, d = 0.3, 0.4
    closed = 2 * r * r * math.acos(d / (2 * r)) - 0.5 * d * math.sqrt(4 * r * r - d * d)
    assert lens.area == pytest.approx(closed, rel=1e-9)


def test_the_part_without_singular_poses_is_inside_the_circle_through_the_rings_middles() -> None:
    for theta in (20.0, 30.0, 40.0):
        space = workspace(hoshino(), theta * DEG, guard=1.0)
        central = space.central
        assert central is not None
        reach = [np.linalg.norm(arc.points(), axis=1).max() for loop in central.loops for arc in loop]
        assert max(reach) <= rho_at(theta * DEG) * (1 + 1e-12)
        assert hoshino().singular_measure((0, 0, theta * DEG)) != 0.0


# Steps


def test_the_longest_steps_are_the_printed_ones() -> None:
    """Hoshino and others: 160 mm at 30 + 60 n deg. 49.8 mm for a drawn-in actuator would make it 160.0."""
    directions, length = best_directions(hoshino(), 0.0)
    np.testing.assert_allclose(np.array(directions) / DEG, [30, 90, 150, 210, 270, 330], atol=1e-6)
    assert length / MM == pytest.approx(160.06, abs=0.01)
    ahead = stride(hoshino(), 0.0, 30 * DEG)
    assert (ahead.back / MM, ahead.ahead / MM) == (pytest.approx(61.6, abs=0.05), pytest.approx(98.5, abs=0.05))
    assert stride(hoshino(), 0.0, 0.0).length / MM == pytest.approx(137.7, abs=0.05)
    # along 30 deg one actuator is pushed ahead to its end, and back until two others are drawn out
    assert ahead.back == pytest.approx(0.300 - RADIUS, abs=1e-12)


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("guard", [None, 0.9])
def test_a_stride_ends_where_a_scan_of_the_line_does(seed: int, guard: float | None) -> None:
    rng = np.random.default_rng(seed)
    theta, angle = rng.uniform(-17, 47) * DEG, rng.uniform(0, math.tau)
    start = tuple(0.15 * rho_at(theta) * rng.uniform(-1, 1, 2))
    frames = hoshino()
    along = np.array([math.cos(angle), math.sin(angle)])

    def held(s: float) -> bool:
        pose = (start[0] + s * along[0], start[1] + s * along[1], theta)
        return frames.room(pose) >= 0.0 and (guard is None or frames.nearness(pose) <= guard)

    found = stride(frames, theta, angle, start=start, guard=guard)
    if not held(0.0):
        assert found.length == 0.0
        return
    for sign, end in ((1.0, found.ahead), (-1.0, found.back)):
        scan = next(s for s in np.arange(0.0, 1.0, 1e-4) if not held(sign * s))
        assert end == pytest.approx(scan - 0.5e-4, abs=0.6e-4)


@pytest.mark.parametrize("theta", [-12.0, 0.0, 8.0, 22.0, 40.0])
def test_steps_repeat_every_sixty_degrees(theta: float) -> None:
    for angle in np.arange(0.0, 60.0, 7.0):
        lengths = [stride(hoshino(), theta * DEG, (angle + 60 * k) * DEG).length for k in range(6)]
        np.testing.assert_allclose(lengths, lengths[0], atol=1e-12)


@pytest.mark.parametrize("theta", [-15.0, -5.0, 5.0, 10.0])
def test_the_best_direction_turns_half_as_fast_as_the_frames(theta: float) -> None:
    """Up to 11 deg; then it parts in two."""
    directions, _ = best_directions(hoshino(), theta * DEG)
    np.testing.assert_allclose(np.array(directions) / DEG % 60.0, (30.0 + theta / 2.0) % 60.0, atol=1e-5)


# Turns


def test_the_range_of_angles_is_the_printed_one_mirrored() -> None:
    found = turning_range(hoshino(), (0.0, 0.0, 0.0))
    assert (found.least / DEG, found.most / DEG) == (pytest.approx(-17.98, abs=0.005), pytest.approx(47.96, abs=0.005))
    assert found.least / DEG == pytest.approx(60 - 2 * math.degrees(math.asin(0.300 / (2 * RADIUS))), abs=1e-9)
    assert found.most / DEG == pytest.approx(60 - 2 * math.degrees(math.asin(0.050 / (2 * RADIUS))), abs=1e-9)


@pytest.mark.parametrize("seed", range(30))
def test_a_turn_ends_where_a_scan_does(seed: int) -> None:
    rng = np.random.default_rng(seed)
    frames = hoshino() if seed % 2 else mechanism(random_frames(seed).delta, random_frames(seed).y, 0.1, 0.7)
    guard = 0.9 if seed % 3 == 0 and seed % 2 else None
    pose = random_pose(rng) if seed % 2 == 0 else np.array([*rng.uniform(-0.04, 0.04, 2), rng.uniform(0, 30) * DEG])
    about = rng.uniform(-0.6, 0.6, 2)

    def held(turn: float) -> bool:
        arm = complex(*(pose[:2] - about)) * np.exp(1j * turn) + complex(*about)
        there = (arm.real, arm.imag, pose[2] + turn)
        return frames.room(there) >= 0.0 and (guard is None or frames.nearness(there) <= guard)

    found = turning_range(frames, pose, about=(about[0], about[1]), guard=guard)
    if not held(0.0):
        assert found.span == 0.0
        return
    for sign, end in ((1.0, found.most), (-1.0, -found.least)):
        scan = next((a for a in np.arange(0.0, math.pi, 2e-4) if not held(sign * a)), math.pi)
        assert end == pytest.approx(scan, abs=2.1e-4)


def test_half_a_metre_off_a_step_turns_by_about_twenty_degrees() -> None:
    for angle in np.arange(0.0, 360.0, 15.0):
        about = (0.5 * math.cos(angle * DEG), 0.5 * math.sin(angle * DEG))
        assert turning_range(hoshino(), (0, 0, 0), about=about).span / DEG == pytest.approx(20.0, abs=2.5)
