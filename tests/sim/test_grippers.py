"""Grippers in MuJoCo: they catch what is between their jaws and nothing else, hold in every direction, and slip above their strength."""

import mujoco
import numpy as np
import pytest

from clamber.families.climber.execution.postures import postures
from clamber.families.climber.robot.robot import LimbedRobot
from clamber.families.climber.sim.climber_plant import ClimberPlant
from clamber.families.climber.sim.grippers import capture_radius
from clamber.families.climber.world.library import load_board
from clamber.sim.limb_flaws import LimbFlaws
from clamber.tasks.robots import load_robot
from clamber.types import Floats

IDEAL = LimbFlaws(physics_rate=1000.0)
POSE = np.array((0.2286, 0.1374, 0.0))
HELD = {0: (4, -1), 1: (3, 1), 2: (2, -1)}
ALL, NONE = np.ones(3, np.int32), np.zeros(3, np.int32)


def robot() -> LimbedRobot:
    made = load_robot("libra-grippers")
    assert isinstance(made, LimbedRobot)
    return made


def placed(pegs: Floats | None = None) -> ClimberPlant:
    """On the ladder, all three tips where the map has pegs, the jaws open."""
    board = load_board("ladder")
    plant = ClimberPlant(robot(), board, IDEAL, pegs=pegs)
    plant.model.opt.gravity[:] = 0.0  # what moves is moved by the grippers alone
    q = np.zeros((3, 2))
    for i, (number, elbow) in HELD.items():
        place = board.positions()[number - 1]
        q[i] = next(one.angles for one in postures(robot().limbs[i], POSE, place) if one.angles[1] * elbow > 0.0)
    plant.reset(POSE, q)
    plant._qpos[plant._at[1:]] = (
        q.ravel()
    )  # the plant begins on the true pegs; here the tips stay where the map has them
    mujoco.mj_forward(plant.model, plant._data)
    return plant


def ticks(plant: ClimberPlant, count: int, grips: np.ndarray, torques: Floats | None = None) -> None:
    for _ in range(count):
        plant.actuate(np.zeros((3, 2)) if torques is None else torques, grips)
        plant.step()


def test_open_jaws_hold_nothing_and_closed_ones_keep_the_tip_on_the_peg() -> None:
    plant = placed()
    ticks(plant, 1, NONE)
    assert not plant.sense().gripped.any()
    ticks(plant, 20, ALL)
    np.testing.assert_array_equal(plant.sense().gripped, 1)
    pegs = load_board("ladder").positions()[[3, 2, 1]]
    np.testing.assert_allclose(plant.truth().tips, pegs, atol=2e-4)  # [m]
    ticks(plant, 1, np.array((1, 1, 0), np.int32))
    np.testing.assert_array_equal(plant.sense().gripped, (1, 1, 0))


@pytest.mark.parametrize("share", [0.5, 0.97, 1.05, 1.5])
@pytest.mark.parametrize("angle", np.radians((0.0, 80.0, -80.0)))  # from the grab direction; open jaws are behind
def test_jaws_catch_a_peg_within_their_circle_and_draw_it_to_the_tip(share: float, angle: float) -> None:
    board = load_board("ladder")
    radius = capture_radius(robot().limbs[0].end, board.holds[0].radius)
    pegs = board.positions()
    towards = angle + placed().truth().q[0].sum()  # the jaws open along the limb, and the port looks along x
    pegs[3] += share * radius * np.array((np.cos(towards), np.sin(towards)))
    plant = placed(pegs)
    ticks(plant, 1, ALL)
    assert bool(plant.sense().gripped[0]) is (share < 1.0)
    if share < 1.0:
        ticks(plant, 80, ALL)
        np.testing.assert_allclose(plant.truth().tips[0], pegs[3], atol=5e-4)  # [m]


@pytest.mark.parametrize("angle", np.radians((0.0, 90.0, 180.0, 270.0)))
@pytest.mark.parametrize("share", [0.9, 1.1])
def test_a_grip_bears_a_load_from_any_side_up_to_its_strength(share: float, angle: float) -> None:
    strength = robot().limbs[0].end.strength
    assert strength is not None
    plant = placed()
    only = np.array((1, 0, 0), np.int32)
    ticks(plant, 60, only)
    model, data = plant.model, plant._data
    link = model.site("right tip").bodyid[0]
    for part in np.linspace(0.0, 1.0, 40):  # slowly: nothing but the load acts
        fx, fy = part * share * strength * np.array((np.cos(angle), np.sin(angle)))
        x, y = plant.truth().tips[0] - data.xipos[link, :2]
        data.xfrc_applied[link] = (fx, fy, 0.0, 0.0, 0.0, x * fy - y * fx)
        ticks(plant, 1, only)
        if part < 1.0 and plant.sense().gripped[0]:
            assert plant.grippers.forces[0] == pytest.approx(part * share * strength, abs=0.05 * strength)
    ticks(plant, 10, only)
    assert bool(plant.sense().gripped[0]) is (share < 1.0)
    assert plant.grippers.slips == (0 if share < 1.0 else 1)


def test_a_gripper_that_missed_stays_shut_on_nothing_until_it_is_opened() -> None:
    board = load_board("ladder")
    pegs = board.positions()
    pegs[3] += 0.05
    plant = placed(pegs)
    ticks(plant, 5, ALL)
    assert not plant.sense().gripped[0]
    ticks(plant, 1, np.array((0, 1, 1), np.int32))
    ticks(plant, 1, ALL)
    np.testing.assert_array_equal(plant.sense().gripped[1:], 1)
