"""A walker's motions, on legs that stand on springs: level, lower, lift, slide, and what they refuse."""

import math

import numpy as np
import pytest
from spring_walks import BEST, RADIUS, ROBOT, stood
from springs_walker import flat, slope, tiles

from clamber.families.walker.control.gait import DELTA, Y
from clamber.families.walker.execution import motions
from clamber.families.walker.execution.settings import WalkSettings
from clamber.families.walker.execution.walker import FallenError, RefusedError
from clamber.types import Floats


def forward(walker: object, swing: int, way: float) -> Floats:
    frames = walker.frames()  # type: ignore[attr-defined]
    return np.asarray(frames[swing] + way * np.array((math.cos(BEST), math.sin(BEST), 0.0)))


@pytest.mark.parametrize("uphill", np.radians((0.0, 75.0, 200.0)))
def test_a_start_tilted_by_ten_degrees_returns_to_level(uphill: float) -> None:
    tilt = math.radians(10.0)
    walker, plant = stood(slope(tilt, uphill), tilt=tilt, uphill=uphill)
    assert plant.tilt() == pytest.approx(tilt, abs=math.radians(0.5))  # feet sink in unevenly
    motions.find_ground(walker)
    motions.level(walker)
    motions.settle(walker, 4.0)
    assert math.degrees(plant.tilt()) < 0.06
    moved = walker.pose[:2] - plant.truth().pose[:2]  # dead reckoning has gone along with 60 mm
    assert np.hypot(*plant.truth().pose[:2]) > 0.055
    assert np.abs(moved).max() < 0.002
    assert walker.sensed.min() > ROBOT.legs.shortest
    assert walker.sensed.max() < ROBOT.legs.longest


def test_levelling_without_noise_ends_within_a_step_of_the_motors() -> None:
    tilt = math.radians(6.0)
    walker, plant = stood(slope(tilt), tilt=tilt, noise=0.0)
    motions.level(walker)
    motions.settle(walker, 6.0)
    assert plant.tilt() < ROBOT.legs.resolution / RADIUS


def test_legs_and_actuators_keep_their_speeds_and_strokes() -> None:
    tilt = math.radians(10.0)
    walker, plant = stood(slope(tilt, BEST), tilt=tilt, uphill=BEST)
    motions.level(walker)  # strokes are asserted by the plant at every tick
    end = forward(walker, Y, 0.055)
    motions.lift(walker, Y, end)
    motions.slide(walker, Y, end)
    motions.lower(walker, walker.of_frame(Y))
    assert plant.fastest[0] <= ROBOT.mechanism.speed * 1.01
    assert plant.fastest[1] <= ROBOT.legs.speed * (1.0 + 1e-9)


@pytest.mark.parametrize("swing", [DELTA, Y])
def test_a_slide_takes_the_frame_where_it_is_to_go_and_the_other_stays(swing: int) -> None:
    walker, plant = stood(noise=0.0)
    before = plant.truth().feet[1 - swing].copy()
    end = walker.frames()[swing] + np.array((0.01, 0.03, math.radians(5.0)))
    motions.lift(walker, swing)
    motions.slide(walker, swing, end)
    assert motions.lower(walker, walker.of_frame(swing)) == []
    feet = plant.truth().feet[swing]
    c, s = math.cos(end[2]), math.sin(end[2])
    np.testing.assert_allclose(feet[:, :2], end[:2] + ROBOT.feet()[swing] @ ((c, s), (-s, c)), atol=1e-3)
    np.testing.assert_allclose(plant.truth().feet[1 - swing, :, :2], before[:, :2], atol=1e-3)
    # they have stopped on the ground; those that landed first lose a little to those that came after
    assert np.all(plant.forces[3 * swing : 3 * swing + 3] > 0.5 * walker.settings.touch)
    motions.settle(walker, 4.0)
    assert np.all(plant.forces[3 * swing : 3 * swing + 3] > 60.0)


def test_six_feet_down_forbid_a_slide_and_nothing_moves() -> None:
    walker, plant = stood()
    motions.settle(walker, 0.5)
    actuators, ticks = plant.actuators.copy(), walker.ticks
    with pytest.raises(RefusedError, match="is on the ground"):
        motions.slide(walker, Y, forward(walker, Y, 0.05))
    assert walker.ticks == ticks
    np.testing.assert_array_equal(plant.actuators, actuators)


def test_one_foot_that_still_feels_the_ground_forbids_a_slide() -> None:
    walker, plant = stood()
    motions.lift(walker, Y)
    walker.free_aims[4] = ROBOT.legs.longest
    while plant.forces[4] < 40.0:
        walker.tick()
    with pytest.raises(RefusedError, match="leg 2 of the Y-frame is on the ground"):
        motions.slide(walker, Y, forward(walker, Y, 0.05))


def test_a_slide_beyond_the_mechanism_is_refused_with_what_is_missing() -> None:
    walker, _ = stood()
    motions.lift(walker, Y)
    ticks = walker.ticks
    with pytest.raises(RefusedError, match="beyond what the mechanism can") as caught:
        motions.slide(walker, Y, forward(walker, Y, 0.2))
    assert caught.value.margin < -0.05
    assert walker.ticks == ticks


def test_a_lift_that_would_tip_the_robot_is_refused_before_anything_moves() -> None:
    out = np.array((0.0, math.acos(0.75 / 0.75), 0.0, 0.0))
    walker, _ = stood(payload=16.0, arm=out)
    motions.find_ground(walker)
    refused = 0
    for frame in (DELTA, Y):
        stands = walker.stands.copy()
        stands[walker.of_frame(frame)] = 0
        margin = walker.margin(stands)
        if margin < walker.settings.limits.balance:
            refused += 1
            with pytest.raises(RefusedError, match="centre of mass") as caught:
                motions.lift(walker, frame)
            assert caught.value.margin == pytest.approx(margin - walker.settings.limits.balance, abs=1e-3)
            assert walker.stands.all()
    assert refused


def test_a_posture_beyond_the_legs_is_refused_and_names_the_leg() -> None:
    walker, _ = stood(noise=0.0)
    motions.check_stroke(walker, np.array((0.44, 0.0, 0.0)), walker.stands)
    with pytest.raises(
        RefusedError, match=r"leg \d of the .*-frame would have to be .* can be 250 to 450 mm"
    ) as caught:
        motions.check_stroke(walker, np.array((0.44, 0.0, math.radians(12.0))), walker.stands)
    longest = 0.44 / math.cos(math.radians(12.0)) + RADIUS * math.tan(math.radians(12.0))
    assert caught.value.margin == pytest.approx(0.45 - longest, abs=1e-3)


@pytest.mark.parametrize("seed", range(3))
def test_each_foot_stops_where_it_finds_its_own_ground(seed: int) -> None:
    ground = tiles(0.15, 0.015, seed)
    walker, plant = stood(ground)
    assert motions.find_ground(walker) == []
    assert np.all(plant.forces > 5.0)
    motions.level(walker)
    motions.find_ground(walker)
    feet = plant.truth().feet.reshape(6, 3)
    under = np.array([ground(x, y) for x, y, _ in feet])
    np.testing.assert_allclose(feet[:, 2], under, atol=5e-3)  # they sink in
    believed = walker.heights - walker.heights.mean()
    np.testing.assert_allclose(believed, under - under.mean(), atol=2.5e-3)


def test_a_foot_over_a_hole_finds_no_ground_and_the_others_stand() -> None:
    def ground(x: float, y: float) -> float:
        return -0.5 if y < -0.28 and abs(x) < 0.05 else 0.0  # leg 3 of the Y-frame comes over it

    walker, plant = stood(ground)
    end = forward(walker, Y, -0.055)
    motions.lift(walker, Y)
    motions.slide(walker, Y, end)
    without = motions.lower(walker, walker.of_frame(Y))
    assert without == [5]
    assert plant.forces[3] > 0.5 * walker.settings.touch  # they wait for the third with what stopped them
    assert plant.forces[4] > 0.5 * walker.settings.touch
    assert walker.soles[5, 2] == pytest.approx(-walker.settings.deepest, abs=2e-3)


def test_load_passes_slowly_so_that_the_plate_stays_level() -> None:
    walker, plant = stood()
    motions.settle(walker, 5.0)
    worst = 0.0
    tick = walker.tick

    def watched() -> None:
        nonlocal worst
        tick()
        worst = max(worst, plant.tilt())

    walker.tick = watched  # type: ignore[method-assign]
    motions.lift(walker, DELTA)
    assert math.degrees(worst) < 0.1


def test_a_robot_that_is_pushed_over_is_told_to_fall() -> None:
    walker, plant = stood(settings=WalkSettings())
    motions.lift(walker, Y)
    plant.payload = 60.0  # somebody hangs on to the arm
    with pytest.raises(FallenError):
        walker.wait(10.0)


@pytest.mark.slow
def test_motions_on_flat_ground_keep_the_feet_that_stand_where_they_are() -> None:
    walker, plant = stood(flat)
    for k in range(3):
        swing = (Y, DELTA)[k % 2]
        end = forward(walker, swing, 0.05 if k == 0 else 0.11)
        motions.lift(walker, swing, end)
        motions.slide(walker, swing, end)
        motions.lower(walker, walker.of_frame(swing))
        motions.settle(walker)
    assert plant.dragged < 5e-4
    true = plant.truth()
    np.testing.assert_allclose(walker.pose[:2], true.pose[:2], atol=1e-3)
    np.testing.assert_allclose(walker.frames()[:, 1], (0.11, 0.16), atol=1e-3)


def test_feet_that_land_early_on_a_terrace_take_no_load_from_those_that_stand() -> None:
    """Two of three land 30 mm above the third. They wait for it with what stopped them: five feet share a load most evenly in a way that
    may ask one of the old ones to pull.
    """
    walker, plant = stood(
        lambda x, y: 0.03 if y > 0.15 and abs(x) > 0.1 else 0.0, noise=0.0, settings=WalkSettings(clear=None)
    )
    end = forward(walker, Y, 0.06)
    motions.lift(walker, Y, end)
    motions.slide(walker, Y, end)
    before, lost, worst, tick = plant.forces[:3].copy(), 0.0, 0.0, walker.tick

    def watched() -> None:
        nonlocal lost, worst
        tick()
        lost, worst = max(lost, float((before - plant.forces[:3]).max())), max(worst, plant.tilt())

    walker.tick = watched  # type: ignore[method-assign]
    assert not motions.lower(walker, walker.of_frame(Y))
    assert np.ptp(walker.heights[3:]) == pytest.approx(0.03, abs=2e-3)
    assert lost < 3.0 * walker.settings.touch
    assert math.degrees(worst) < 0.1
