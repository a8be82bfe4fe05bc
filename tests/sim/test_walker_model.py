"""The simulated walker against closed forms: masses, statics on three feet, creep, the mechanism, its softness where it is singular."""

import math

import mujoco
import numpy as np
import pytest
from scipy.optimize import minimize
from walker_by_hand import LEVEL, hoshino, legs_with, lengths, let_pass, standing

from clamber.families.walker.sim.walker_flaws import WalkerFlaws
from clamber.families.walker.sim.walker_model import WalkerBuild, walker_spec
from clamber.families.walker.world.ground import Ground
from clamber.units import GRAVITY


def link_places(arm: tuple[float, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Middles of the arm's links and its tool point in the plate, by equation 8 of the paper."""
    robot = hoshino().arm
    assert robot is not None
    out, up, pitch = robot.out, robot.up, 0.0
    middles = []
    for length, angle in zip(robot.links, arm[1:], strict=True):
        pitch += angle
        middles.append((out + length / 2 * math.cos(pitch), up + length / 2 * math.sin(pitch)))
        out, up = out + length * math.cos(pitch), up + length * math.sin(pitch)
    c, s = math.cos(arm[0]), math.sin(arm[0])
    return np.array([(c * x, s * x, z) for x, z in middles]), np.array((c * out, s * out, up))


@pytest.mark.parametrize("arm", [(0.0, 0.0, 0.0, 0.0), (1.0, 0.7, -0.9, 0.4), (-2.0, 1.5, -2.0, -1.0)])
def test_masses_and_their_centre_are_those_of_the_file(arm: tuple[float, ...]) -> None:
    robot = hoshino()
    assert robot.arm is not None
    place = (0.03, -0.02, 0.2)
    sim = standing(place, arm=arm)
    true = sim.truth()
    model = sim.model
    assert model.body_mass.sum() == pytest.approx(80.0)
    share = robot.mass.share_delta
    middles, tool = link_places(arm)
    moments = np.array(robot.arm.masses) @ middles
    frames = robot.mass.frames * np.array(((1 - share) * place[0], (1 - share) * place[1], robot.mass.height))
    # up to what motors and feet give way under the weight
    np.testing.assert_allclose(true.centre - true.pose[:3], (moments + frames) / 80.0, atol=1e-3)
    np.testing.assert_allclose(true.tool - true.pose[:3], tool, atol=2e-3)


def test_inertia_is_the_sum_of_the_parts() -> None:
    """Of the whole robot about its centre of mass, upright axis: discs, balls and rods by the parallel-axis theorem."""
    robot, build = hoshino(), WalkerBuild()
    assert robot.arm is not None
    arm = (0.0, 0.0, 0.0, 0.0)
    sim = standing(arm=arm)
    data = sim._data
    mujoco.mj_forward(sim.model, data)
    mujoco.mj_comPos(sim.model, data)
    mujoco.mj_crb(sim.model, data)
    # the composite inertia is about the subtree's centre of mass: xx, yy, zz, xy, xz, yz, then mass times offset, mass
    measured = data.crb[sim.model.body("delta").id][2]
    r, each = robot.legs.radius_delta, build.leg_mass + build.foot_mass
    discs = (robot.mass.frames - 6.0 * each) * r**2 / 2.0
    rods = build.leg_mass * robot.legs.nominal**2 / 120.0 + 0.4 * build.foot_mass * 0.02**2
    middles, _ = link_places(arm)
    masses, spans = np.array(robot.arm.masses), np.array(robot.arm.links)
    links = masses @ (spans**2 / 12.0 + middles[:, 0] ** 2)
    centre = masses @ middles[:, 0] / 80.0
    wanted = discs + 6.0 * (each * r**2 + rods) + links - 80.0 * centre**2
    assert measured == pytest.approx(wanted, rel=2e-3)


@pytest.mark.parametrize("standing_frame", [0, 1])
@pytest.mark.parametrize("seed", range(3))
def test_three_feet_carry_what_statics_says(standing_frame: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    place = (*rng.uniform(-0.04, 0.04, 2), rng.uniform(-0.1, 0.3))
    arm = (rng.uniform(-3.0, 3.0), 1.2, -1.5, rng.uniform(-1.0, 1.0))
    sim = standing(place, lifted=1 - standing_frame, arm=arm)
    let_pass(sim, 3.0)
    true = sim.truth()
    np.testing.assert_array_equal(true.touching, np.arange(2)[:, None] == [[standing_frame] * 3] * 2)
    feet = true.feet[standing_frame]
    level = np.vstack((np.ones(3), feet[:, :2].T))
    wanted = np.linalg.solve(level, 80.0 * GRAVITY * np.array((1.0, *true.centre[:2])))
    # a foot's force acts where its ball touches: up to 0.01 mm from the middle of the sole, and 1 mm above it
    np.testing.assert_allclose(true.forces[standing_frame, :, 2], wanted, atol=0.05)
    np.testing.assert_allclose(true.forces.sum(axis=(0, 1)), (0.0, 0.0, 80.0 * GRAVITY), atol=1e-3)
    np.testing.assert_allclose(sim.sense().forces[standing_frame], wanted, atol=0.5)
    np.testing.assert_array_equal(sim.sense().forces[1 - standing_frame], 0.0)


@pytest.mark.parametrize("lifted", [None, 1])
@pytest.mark.parametrize("uphill", [None, 0.0, 90.0])
def test_a_robot_that_stands_does_not_creep(lifted: int | None, uphill: float | None) -> None:
    """Less than 0.1 mm a minute along the ground; with MuJoCo's usual friction it is 165 mm."""
    slope = 0.0 if uphill is None else math.radians(10.0)
    ground = Ground(name="slope", slope=slope, uphill=math.radians(uphill or 0.0))
    legs = legs_with(lifted, length=0.33)
    feet = hoshino().feet()
    legs -= ground.heights(feet)  # the plate is level
    sim = standing(lifted=lifted, ground=ground, legs=legs)
    let_pass(sim, 2.0)
    before = sim.truth()
    let_pass(sim, 20.0)
    after = sim.truth()
    assert np.linalg.norm(after.pose[:3] - before.pose[:3]) < 0.1e-3 / 3.0
    assert np.abs(after.pose[3:] - before.pose[3:]).max() < math.radians(0.002)


def test_the_plate_is_level_on_a_slope_where_the_legs_say_so() -> None:
    ground = Ground(name="slope", slope=math.radians(10.0), uphill=math.radians(30.0))
    sim = standing(ground=ground, legs=legs_with(None, length=0.33) - ground.heights(hoshino().feet()))
    let_pass(sim, 2.0)
    true = sim.truth()
    # what is left is legs, arm and ground that give way unevenly under the weight
    assert np.abs(true.pose[4:]).max() < math.radians(0.1)
    assert (true.touching == 1).all()


@pytest.mark.parametrize("struts", [False, True])
@pytest.mark.parametrize("seed", range(4))
def test_the_frames_go_where_the_lengths_of_the_actuators_say(seed: int, struts: bool) -> None:
    rng = np.random.default_rng(seed)
    robot = hoshino()
    goal = np.array((*rng.uniform(-0.03, 0.03, 2), rng.uniform(-0.15, 0.5)))
    sim = standing(lifted=1, struts=struts)
    start, aim = lengths(robot, np.zeros(3)), lengths(robot, goal)
    seconds = float(np.abs(aim - start).max() / (0.8 * robot.mechanism.speed))
    ticks = round(seconds / sim.period)
    for tick in range(ticks):
        sim.actuate(start + (aim - start) * (tick + 1) / ticks, legs_with(1), sim.sense().arm)
        sim.step()
    let_pass(sim, 1.0)
    np.testing.assert_allclose(sim.sense().actuators, aim, atol=2e-6)
    np.testing.assert_allclose(sim.truth().place, goal, atol=1e-5)


def test_tendons_and_struts_move_alike() -> None:
    """On the way too: the two models of the actuators share no code but their aims."""
    robot, goal = hoshino(), np.array((0.05, 0.03, 0.3))
    start, aim = lengths(robot, np.zeros(3)), lengths(robot, goal)
    sims = [standing(lifted=1, struts=struts) for struts in (False, True)]
    for tick in range(500):
        for sim in sims:
            sim.actuate(start + (aim - start) * min(1.0, (tick + 1) / 400), legs_with(1), np.array((0, 1.1, -1, -0.9)))
            sim.step()
        tendons, struts = (sim.truth() for sim in sims)
        np.testing.assert_allclose(tendons.place, struts.place, atol=2e-5)
        np.testing.assert_allclose(tendons.pose[:3], struts.pose[:3], atol=5e-5)


def soft_turn(start: np.ndarray, moment: float, stiffness: float) -> np.ndarray:
    """How the Y-frame gives way to a moment: the least energy of three springs, on the way down from where it is."""
    robot = hoshino()
    free = lengths(robot, start)
    scale = np.array((1e-3, 1e-3, 1e-2))

    def energy(change: np.ndarray) -> float:
        stretch = lengths(robot, start + scale * change) - free
        return 0.5 * stiffness * float(stretch @ stretch) - moment * scale[2] * change[2]

    change = np.zeros(3)
    for _ in range(5):  # a simplex that starts anew does not get stuck
        change = minimize(
            energy, change, method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-14, "maxiter": 4000}
        ).x
    return scale * change


@pytest.mark.parametrize("struts", [False, True])
@pytest.mark.parametrize(("share", "degrees"), [(0.0, 0.0034), (0.8, 0.058), (0.9, 2.26)])
def test_a_frame_near_the_singular_circle_is_soft_as_three_springs_are(
    share: float, degrees: float, struts: bool
) -> None:
    """Under 10 N m. At 0.9 it does not spring but snaps across the circle, into the mechanism's other assembly."""
    robot = hoshino()
    theta = math.radians(40.0)
    start = np.array((share * robot.mechanism.singular_distance(theta), 0.0, theta))
    sim = standing(tuple(start), lifted=1, struts=struts)
    before = sim.truth().place
    sim._data.xfrc_applied[sim.model.body("y").id, 5] = 10.0
    let_pass(sim, 5.0)
    change = sim.truth().place - before
    wanted = soft_turn(start, 10.0, WalkerBuild().actuator.stiffness)
    assert math.degrees(wanted[2]) == pytest.approx(degrees, rel=0.02)
    np.testing.assert_allclose(change, wanted, rtol=0.02, atol=2e-6)
    crossed = math.hypot(*(start + wanted)[:2]) > robot.mechanism.singular_distance(theta + wanted[2])
    assert crossed == (share == 0.9)


def test_masses_off_the_file_are_drawn_from_the_seed() -> None:
    robot = hoshino()

    def masses(**keys: float | int) -> np.ndarray:
        return walker_spec(robot, LEVEL, WalkerFlaws(**keys)).compile().body_mass

    right = masses()
    one, same, other = masses(seed=1, mass_error=0.1), masses(seed=1, mass_error=0.1), masses(seed=2, mass_error=0.1)
    np.testing.assert_array_equal(one, same)
    assert (one[2:] != other[2:]).any()
    ratios = one[right > 0.0] / right[right > 0.0]
    assert (np.abs(ratios - 1.0) <= 0.1).all()
    assert len(np.unique(ratios.round(9))) == len(ratios)
