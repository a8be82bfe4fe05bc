"""The simulated plant of robots in space: forces balance the weight, end effectors attach where they can, tips stay where they are."""

import math

import numpy as np
import pytest
from standing import Standing

from clamber.families.spatial.sim.spatial_flaws import SpatialFlaws
from clamber.families.spatial.statics.collision_kernels import limb_body_gap, pair_gap
from clamber.families.spatial.statics.kinematics_kernels import limb_frames
from clamber.families.spatial.statics.records import WORK, robot_record
from clamber.planning.problem.check import UNLIMITED
from clamber.types import Floats

OWN = ("wall-gripper", "stones-quadruped", "rubble-hexapod", "corners-magnet", "ceiling-gripper")


@pytest.mark.parametrize("name", OWN)
def test_a_robot_that_stands_is_carried_by_its_contacts_and_feels_it(name: str) -> None:
    """The wrenches on tips add up to the weight, and an accelerometer at rest feels gravity's opposite in its own axes."""
    stand = Standing(name)
    stand.stay(1.5)
    truth, sensed = stand.plant.truth(), stand.plant.sense()
    up = -np.array(stand.task.world.gravity)
    assert not truth.broken
    assert truth.wrenches[:, :3].sum(axis=0) == pytest.approx(
        stand.weight * up / np.linalg.norm(up), abs=0.03 * stand.weight
    )
    assert truth.pose.rotation @ sensed.accelerometer == pytest.approx(up, abs=0.3)
    assert list(truth.attached) == list(stand.held)


def test_the_model_moves_its_tips_where_statics_have_them() -> None:
    stand = Standing("handrails-triped")
    chains, robot = stand.robot.chains, robot_record(stand.robot.chains, stand.robot.contacts)
    joints = stand.joints + np.random.default_rng(1).uniform(-0.5, 0.5, len(stand.joints))
    stand.plant.reset(stand.pose, joints, [-1] * len(stand.held))
    work = np.zeros(1, WORK)
    starts = np.concatenate(([0], np.cumsum(chains.n_joints)))
    for limb, n in enumerate(chains.n_joints):
        work["posture"][0, limb, :n] = joints[starts[limb] : starts[limb + 1]]
        limb_frames(robot[0], limb, work[0])
        tip = stand.pose.position + stand.pose.rotation @ work["origin"][0, limb, n]
        assert stand.plant.truth().tips[limb] == pytest.approx(tip, abs=1e-9)


def test_limbs_that_are_driven_against_each_other_do_not_pass() -> None:
    """Two legs in the air press on each other; their capsules, as plans have them, give way by less than a millimetre."""
    stand = Standing("rubble-hexapod")
    one, other = (stand.robot.chains.limb_names.index(name) for name in ("RM", "RF"))
    for limb, turn in ((one, 0.6), (other, -0.6)):
        stand.joints[3 * limb + 1] += 0.5  # lifts the foot
        stand.joints[3 * limb] += turn
    gaps = []
    for _ in range(10):
        stand.stay(0.1)
        gaps.append(gap(stand, one, other))
    assert gaps[0] > -1e-3
    assert gaps[-1] == pytest.approx(0.0, abs=1e-3)
    assert min(gaps) > -1e-3


def test_a_limb_that_is_folded_against_the_base_does_not_pass_into_it() -> None:
    """The last link of a leg comes to rest on the base, its end, which colliders leave out, by less than its radius in it."""
    stand = Standing("rubble-hexapod")
    robot, lower = robot_record(stand.robot.chains, stand.robot.contacts)[0], stand.robot.chains.lower[0]
    stand.joints[0] = 0.0
    stand.joints[1:3] = lower[1:3]
    gaps = []
    for _ in range(15):
        stand.stay(0.1)
        gaps.append(float(limb_body_gap(robot, 0, origins(stand)[0], UNLIMITED)))
    assert -stand.robot.chains.radius[0, 2] < min(gaps) < 0.0


def origins(stand: Standing) -> Floats:
    """Where the joints of all limbs truly are, base frame [m], shape (limbs, joints + 1, 3)."""
    chains, robot = stand.robot.chains, robot_record(stand.robot.chains, stand.robot.contacts)
    work = np.zeros(1, WORK)
    joints = np.split(stand.plant.truth().joints[0], np.cumsum(chains.n_joints)[:-1])
    for limb, mine in enumerate(joints):
        work["posture"][0, limb, : len(mine)] = mine
        limb_frames(robot[0], limb, work[0])
    placed: Floats = work["origin"][0]
    return placed


def gap(stand: Standing, one: int, other: int) -> float:
    """Between the links of two limbs [m]."""
    at, robot = origins(stand), robot_record(stand.robot.chains, stand.robot.contacts)[0]
    return float(pair_gap(robot, one, other, at[one], at[other]))


def test_a_look_at_how_things_are_changes_nothing() -> None:
    """In the air tips move with the joints, so that what is worked out anew at a look is not what the last step began with."""
    ends = []
    for look in (False, True):
        stand = Standing("wall-gripper")
        stand.plant.grip(0, False)
        stand.joints[1] += 0.3
        for _ in range(60):
            stand.stay(stand.plant.period)
            if look:
                stand.plant.truth()
        truth = stand.plant.truth()
        ends.append(np.concatenate((truth.joints.ravel(), truth.velocity, truth.wrenches.ravel())))
    np.testing.assert_array_equal(ends[0], ends[1])


def test_an_end_effector_attaches_only_near_a_hold_and_when_it_is_told_to() -> None:
    stand = Standing("corners-magnet")
    plant = stand.plant
    plant.grip(0, False)
    stand.stay(0.05)
    assert plant.sense().closed[0] == 0 and plant.truth().attached[0] == -1
    plant.grip(0, True)
    stand.stay(0.05)
    assert plant.sense().closed[0] == 1 and plant.truth().attached[0] == stand.held[0]
    plant.grip(0, False)
    stand.joints[1] += 0.3  # lifts the foot
    stand.stay(0.5)
    plant.grip(0, True)
    stand.stay(0.2)
    assert plant.sense().closed[0] == 0
    stand.joints[1] -= 0.3  # back: it is still told to attach
    stand.stay(0.5)
    assert plant.truth().attached[0] == stand.held[0]


def test_what_an_imu_tells_adds_up_to_how_the_base_moves() -> None:
    """Knocks that last less than a control period are told as what they do in that."""
    stand = Standing("wall-gripper", SpatialFlaws(backlash=math.radians(0.5), seed=1))
    plant, gravity = stand.plant, np.array(stand.task.world.gravity)
    before = plant.truth()
    moved = np.zeros(3)
    for tick in range(200):
        plant.push(np.array((20.0 * math.sin(tick), 10.0, 0.0, 0.0, 0.0, 0.0)))
        stand.stay(plant.period)
        moved += plant.period * (plant.truth().pose.rotation @ plant.sense().accelerometer + gravity)
    gained = plant.truth().velocity[:3] - before.velocity[:3]
    assert moved == pytest.approx(gained, abs=2e-3)
