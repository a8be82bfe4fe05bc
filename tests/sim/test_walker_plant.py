"""The walker's plant: aims, sensors, truth, and that it keeps its protocol's word."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from walker_by_hand import POSE, hoshino, legs_with, lengths, let_pass, standing

from clamber.execution.plant import PlantStoppedError
from clamber.families.walker.execution.plant import WalkerPlant
from clamber.families.walker.robot import WalkerRobot
from clamber.families.walker.sim.walker_flaws import Inclinometers, WalkerFlaws
from clamber.families.walker.sim.walker_plant import WalkerSim, plate_angles, plate_axes, plate_quaternion
from clamber.families.walker.world.ground import Block, Ground
from clamber.sim.plant_rules import PlantError
from clamber.units import GRAVITY


def test_it_is_a_walker_plant() -> None:
    plant: WalkerPlant = standing()
    assert plant.period == 0.02
    plant.pause()
    plant.step()
    assert plant.sense().time == 0.02


def test_it_is_put_down_where_its_lowest_foot_touches() -> None:
    step = Ground(name="step", blocks=(Block(x_min=-0.1, x_max=1.0, y_min=0.2, y_max=1.0, height=0.03),))
    legs = legs_with(None)
    legs[0, 0] -= 0.03  # its foot is at (0, 0.238), on the step
    sim = standing(ground=step, legs=legs, pose=np.array((0.0, 0.0, 5.0, 0.3, 0.0, 0.0)))
    true = sim.truth()
    assert true.pose[2] == pytest.approx(0.35, abs=2e-3)
    assert true.pose[3] == pytest.approx(0.3, abs=1e-3)
    sim = standing(ground=step, legs=legs)
    true = sim.truth()
    assert true.feet[0, 0, 2] == pytest.approx(0.03, abs=2e-3)
    assert true.touching.sum() >= 3


def test_what_is_sensed_is_so() -> None:
    place = (0.03, -0.02, 0.2)
    sim = standing(place, flaws=WalkerFlaws(inclinometers=Inclinometers(offsets=(0.002, -0.001))))
    let_pass(sim, 2.0)
    sensed, true = sim.sense(), sim.truth()
    robot = hoshino()
    np.testing.assert_allclose(sensed.actuators, lengths(robot, true.place), atol=1e-12)
    np.testing.assert_allclose(sensed.forces, true.forces[..., 2], atol=0.5)
    assert sensed.forces.sum() == pytest.approx(80.0 * GRAVITY, abs=0.01)
    inclines = (-true.pose[4] + 0.002, math.asin(math.cos(true.pose[4]) * math.sin(true.pose[5])) - 0.001)
    np.testing.assert_allclose(sensed.inclines, inclines, atol=1e-7)
    # soles by the plate's pose and the legs' lengths; feet give way to the sides by next to nothing here
    alpha = true.pose[3]
    for f, angle in enumerate((alpha, alpha + true.place[2])):
        c, s = math.cos(angle), math.sin(angle)
        along = robot.feet()[f] @ np.array(((c, s), (-s, c)))
        origin = true.pose[:2] + (true.place[:2] if f else 0.0)
        np.testing.assert_allclose(true.feet[f, :, :2], origin + along, atol=1e-3)
        np.testing.assert_allclose(true.feet[f, :, 2], true.pose[2] - sensed.legs[f], atol=1e-3)


def test_aims_are_even_within_a_period() -> None:
    """A motor's own aim is a straight line between the ticks, at every physics step, and what follows it is no staircase."""
    sim = standing(lifted=1)
    legs = legs_with(1)
    act = int(sim.model.actuator("y leg 0").actadr[0])
    seen = []
    for tick in range(10):
        legs[1] += 0.1e-3  # the leg's top speed
        sim.actuate(sim.sense().actuators, legs, sim.sense().arm)
        before = sim._data.act[act]
        sim.step()
        seen.append(sim._data.act[act] - before)
        assert sim._data.act[act] == pytest.approx(legs[1, 0], abs=1e-12), tick
    np.testing.assert_allclose(seen, 0.1e-3, atol=1e-12)


def test_motors_keep_to_their_speeds_strokes_and_steps() -> None:
    sim = standing(lifted=1)
    robot = hoshino()
    legs = legs_with(1)
    legs[1, 0] = 0.1  # 0.15 m beyond the stroke
    legs[1, 1] = 0.31234  # no whole step of the motor
    aims = sim.sense().actuators + np.array((0.0, 0.0, 0.02))
    before = sim.sense().legs.copy()
    sim.actuate(aims, legs, sim.sense().arm)
    let_pass(sim, 1.0)
    now = sim.sense()
    assert before[1, 0] - now.legs[1, 0] == pytest.approx(robot.legs.speed * 1.0, abs=3e-4)
    assert now.actuators[2] - 0.2384 == pytest.approx(robot.mechanism.speed * 1.0, abs=2e-4)
    let_pass(sim, 15.0)
    now = sim.sense()
    assert now.legs[1, 0] == pytest.approx(robot.legs.shortest, abs=2e-5)
    assert now.legs[1, 1] == pytest.approx(0.3123, abs=2e-5)


def test_resets_begin_anew_to_the_last_bit() -> None:
    sim = standing(flaws=WalkerFlaws(seed=3, force_noise=1.0, inclinometers=Inclinometers(noise=1e-3)))
    robot = hoshino()
    assert robot.arm is not None
    runs = []
    for _ in range(2):
        sim.reset(POSE, np.zeros(3), legs_with(None), np.array(robot.arm.rest))
        sensed = []
        for _ in range(10):
            sim.actuate(lengths(robot, np.array((0.01, 0.0, 0.0))), legs_with(None), np.array(robot.arm.rest))
            sim.step()
            now = sim.sense()
            sensed.append(np.concatenate((now.actuators, now.legs.ravel(), now.forces.ravel(), now.inclines)))
        runs.append(np.array(sensed))
    np.testing.assert_array_equal(*runs)


def test_load_cells_have_the_stated_noise() -> None:
    sim = standing(lifted=1, flaws=WalkerFlaws(seed=3, force_noise=2.0))
    let_pass(sim, 1.0)
    readings = np.array([sim.sense().forces[1].copy() for _ in range(2000)])
    assert readings.std() == pytest.approx(2.0, rel=4.0 / math.sqrt(2 * 6000))
    assert abs(readings.mean()) < 4.0 * 2.0 / math.sqrt(6000)


def test_a_payload_moves_the_centre_of_mass_and_the_margin_of_statics() -> None:
    arm = (math.pi / 2, 0.0, 0.0, 0.0)  # straight out, over a foot of the Delta-frame
    bare, loaded = (standing(arm=arm, flaws=WalkerFlaws(payload=payload)).truth() for payload in (0.0, 10.0))
    assert loaded.tool[1] - loaded.pose[1] == pytest.approx(0.8, abs=3e-3)
    wanted = (80.0 * bare.centre + 10.0 * loaded.tool) / 90.0
    np.testing.assert_allclose(loaded.centre, wanted, atol=2e-3)
    assert loaded.forces.sum(axis=(0, 1))[2] == pytest.approx(90.0 * GRAVITY, abs=1.0)


def test_slippery_feet_slide_on_a_slope_that_is_steeper_than_their_friction() -> None:
    """With the centre of mass over the middle of three feet; friction 0.15 holds up to 8.5 deg, 0.2 up to 11.3 deg."""
    slope = math.radians(10.0)
    ground = Ground(name="slope", slope=slope, friction=1.0)
    moved = {}
    for friction in (0.15, 0.2):
        legs = legs_with(1, length=0.33) - ground.heights(hoshino().feet())
        sim = standing(lifted=1, ground=ground, legs=legs, flaws=WalkerFlaws(friction=friction))
        before = sim.truth().pose[0]
        let_pass(sim, 3.0)
        moved[friction] = before - sim.truth().pose[0]
    assert moved[0.15] > 0.1
    assert abs(moved[0.2]) < 1e-4


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"payload": -1.0}, "payload"),
        ({"friction": 0.0}, "friction"),
        ({"mass_error": 1.0, "seed": 0}, "mass_error"),
        ({"force_noise": 1.0}, "needs a seed"),
        ({"inclinometers": Inclinometers(noise=1e-3)}, "inclinometers.noise"),
        ({"control_rate": 300.0}, "must divide"),
        ({"seed": -1}, "seed"),
    ],
)
def test_impossible_flaws_are_refused(keys: dict[str, object], words: str) -> None:
    with pytest.raises(PlantError, match=words):
        WalkerFlaws().with_changes(**keys)
    with pytest.raises(PlantError, match="no such property"):
        WalkerFlaws().with_changes(frictoin=1.0)


@pytest.mark.parametrize("seed", range(4))
def test_angles_of_a_posture_come_back(seed: int) -> None:
    angles = tuple(np.random.default_rng(seed).uniform(-1.5, 1.5, 3))
    axes = plate_axes(*plate_quaternion(*angles))
    np.testing.assert_allclose(plate_angles(axes), angles, atol=1e-12)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)


def test_a_simulation_that_loses_its_numbers_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)  # MuJoCo writes its warnings into a file there
    sim = standing()
    sim._qvel[0] = math.nan
    with pytest.raises(PlantStoppedError, match="lost its numbers"):
        sim.step()


def on_a_slope(robot: WalkerRobot) -> WalkerSim:
    """Its plate as the ground, 10 degrees up along x, the Y-frame lifted; as soon as it has been put down."""
    ground = Ground(name="slope", slope=math.radians(10.0))
    sim = WalkerSim(robot, ground, WalkerFlaws())
    assert robot.arm is not None
    pose = np.array((0.0, 0.0, 0.35, 0.0, -ground.slope, 0.0))
    sim.reset(pose, np.array((0.02, -0.03, 0.1)), legs_with(1), np.array(robot.arm.rest))
    return sim


@pytest.mark.parametrize("struts", [False, True])
def test_actuators_hold_a_lifted_frame_on_a_slope(struts: bool) -> None:
    """Force and moment balance of the Y-frame in its plane: three thrusts along the actuators against its weight down the slope."""
    robot = hoshino()
    ground = Ground(name="slope", slope=math.radians(10.0))
    sim = standing(
        (0.02, -0.03, 0.1), lifted=1, ground=ground, pose=np.array((0, 0, 0.35, 0, -ground.slope, 0)), struts=struts
    )
    let_pass(sim, 3.0)
    true = sim.truth()
    on_delta, on_y = robot.attachments()
    c, s = math.cos(true.place[2]), math.sin(true.place[2])
    arms = on_y @ np.array(((c, s), (-s, c)))
    ways = arms + true.place[:2] - on_delta
    pushes = true.thrusts[:, None] * ways / np.linalg.norm(ways, axis=1, keepdims=True)
    mass = (1.0 - robot.mass.share_delta) * robot.mass.frames
    down = plate_axes(*plate_quaternion(*true.pose[3:]))[2]  # the world's z in the plate's axes
    assert down[0] == pytest.approx(math.sin(ground.slope), rel=0.05)  # legs give way a little under the weight
    assert pushes.sum(axis=0) == pytest.approx(mass * GRAVITY * down[:2], abs=0.1)
    turning = arms[:, 0] * pushes[:, 1] - arms[:, 1] * pushes[:, 0]
    assert turning.sum() == pytest.approx(0.0, abs=0.05)


def test_motors_give_no_more_than_their_files_say() -> None:
    """A frame that its actuators cannot hold slides down the slope, at most as fast as its weight less their force makes it."""
    robot = hoshino()
    weak = replace(robot, mechanism=replace(robot.mechanism, force=5.0))
    strong = replace(robot, mechanism=replace(robot.mechanism, force=500.0))
    held, slid = on_a_slope(strong), on_a_slope(weak)
    before = held.truth().place[0]
    for sim in (held, slid):
        let_pass(sim, 0.5)
    assert held.truth().place[0] == pytest.approx(before, abs=1e-4)
    assert slid.truth().place[0] < before - 0.01
    assert np.abs(slid.truth().thrusts).max() <= 5.0
    legs = replace(robot, legs=replace(robot.legs, force=100.0))  # three carry 262 N each
    sunk = on_a_slope(legs)
    height = on_a_slope(robot).truth().pose[2]
    assert sunk.truth().pose[2] < height - 0.005
