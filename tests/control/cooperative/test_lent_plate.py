"""The tool held by the arm and by what a walk lends of its plate."""

import math

import numpy as np
import pytest
from test_limits import START, Judge
from walkers import hoshino

from clamber.families.walker.control.cooperative.cooperator import Cooperator
from clamber.families.walker.control.cooperative.freedoms import HEIGHT, weights_of
from clamber.families.walker.control.cooperative.holding import RedundancyAllocation, ToolHolder
from clamber.families.walker.control.cooperative.planted_feet import PlantedFeet, Support
from clamber.families.walker.control.cooperative.settings import Cooperation, own_speeds
from clamber.families.walker.execution.free_base_freedoms import open_share
from clamber.types import Floats

PERIOD, RISE = 0.02, 0.002
FLAT = np.zeros((2, 3))
PLACE = np.array([0.01, -0.02, 0.05])
SUPPORTS: tuple[Support, ...] = ("delta", "y", "both")


def lent(gain: float = 0.5, payload: float = 0.0) -> RedundancyAllocation:
    return RedundancyAllocation(hoshino(), payload=payload, gain=gain, balance=0.02, rise=RISE, period=PERIOD)


def with_height(share: float) -> Floats:
    weights = weights_of("arm", 4)
    weights[HEIGHT] = share
    return weights


@pytest.mark.parametrize("support", SUPPORTS)
def test_with_nothing_lent_it_is_the_arm_alone(support: Support) -> None:
    """So a freedom that is faded out leaves the motion of the law that goes on without it."""
    robot, plate, weights = hoshino(), lent(), weights_of("arm", 4)
    settings = Cooperation(speeds=own_speeds(robot), tool_speeds=np.full(3, 0.2), gain=0.5, period=PERIOD)
    alone = Cooperator(robot, settings, PlantedFeet(robot=robot, support="y", pose=START[:6]), "arm")
    holder, q = ToolHolder(alone, START), START.copy()
    target = alone.place(START) + np.array([0.0, 0.0, 0.05])
    for k in range(200):
        pose = START[:6] + k * PERIOD * np.array([0.005, 0.002, 0.001, 0.01, 0.0, 0.0])
        q[:6] = pose
        plate.stand(q, support, PLACE, FLAT, (0.3, 0.45))
        q = plate.law.hold(q, target, weights).q
        np.testing.assert_allclose(q, holder.step(pose, target, weights).q, atol=1e-9)


@pytest.mark.parametrize("support", SUPPORTS)
@pytest.mark.parametrize("seed", range(4))
def test_no_limit_is_broken_and_the_plate_stays_within_its_room(support: Support, seed: int) -> None:
    """Towards targets in and out of reach; by a second reading of the geometry, and the room of the step besides."""
    robot, rng = hoshino(), np.random.default_rng(seed)
    payload = float(rng.choice([0.0, 2.0]))
    plate, q = lent(gain=float(rng.choice([0.5, 20.0])), payload=payload), START.copy()
    room = (START[HEIGHT] - float(rng.uniform(0.0, 0.03)), START[HEIGHT] + float(rng.uniform(0.0, 0.03)))
    heights = rng.uniform(-0.02, 0.02, (2, 3))
    stance = PlantedFeet(
        robot=robot, support=support, pose=START[:6], offset=(PLACE[0], PLACE[1]), twist=PLACE[2], heights=heights, payload=payload
    )  # fmt: skip
    speeds = own_speeds(robot)
    speeds[HEIGHT] = RISE
    judge = Judge(robot, stance, speeds, PERIOD)
    target = plate.law.place(q) + rng.uniform(-0.4, 0.4, 3)
    for _ in range(400):
        plate.stand(q, support, PLACE, heights, room)
        after = plate.law.hold(q, target, with_height(1.0)).q
        assert judge.excess(q, after) <= 1e-9
        assert room[0] - 1e-12 <= after[HEIGHT] <= room[1] + 1e-12
        q = after


def test_a_plate_that_is_sensed_beyond_its_room_comes_back_and_the_arm_goes_on() -> None:
    plate, q = lent(), START.copy()
    room = (START[HEIGHT] - 0.03, START[HEIGHT] - 0.001)
    target = plate.law.place(q) + np.array([0.0, 0.0, 0.03])
    for _ in range(400):
        plate.stand(q, "y", PLACE, FLAT, room)
        q = plate.law.hold(q, target, with_height(1.0)).q
    assert q[HEIGHT] <= room[1]
    assert np.linalg.norm(plate.law.place(q) - target) < 1e-5


def test_rates_do_not_jump_where_the_height_is_lent_and_taken_back() -> None:
    """A slide of 14 s between two phases that lend nothing, on the way past a point; the rates change as the fades do."""
    plate, q = lent(), START.copy()
    target = plate.law.place(q) + np.array(
        [0.1, 0.0, 0.2]
    )  # where the arm has come to is stretched: the height gets to its fastest
    rates = []
    for k in range(round(20.0 / PERIOD)):
        time = k * PERIOD - 3.0
        before = q.copy()
        q[0] += PERIOD * 0.005
        plate.stand(q, "y", PLACE, FLAT, (0.33, 0.45))
        moved = plate.law.hold(q, target, with_height(open_share(time, 14.0 - time))).q
        rates.append((moved - before) / PERIOD)
        q = moved
    rates_of = np.array(rates)[150:]  # 3 s for the arm to come to the point
    assert np.abs(rates_of[:, HEIGHT]).max() == pytest.approx(RISE, rel=1e-9)
    assert np.abs(rates_of[-150:, HEIGHT]).max() == 0.0
    jumps = np.abs(np.diff(rates_of, axis=0))
    # within 0.1 s of a fade of 1 s, the height from rest to its fastest
    assert jumps[:, HEIGHT].max() < RISE * PERIOD / 0.1
    assert jumps[:, 6:].max() < 0.02 * 0.35


def test_it_is_the_arms_own_manipulability_that_grows() -> None:
    """The height would count as a motion of the tool in that of both, and the arm be left stretched: a plate that is lent goes again."""
    plate, q, arm = lent(), START.copy(), weights_of("arm", 4)
    target = plate.law.place(q) + np.array([0.1, 0.0, 0.2])
    kept = {}
    for share in (0.0, 1.0):
        q = START.copy()
        for _ in range(1500):
            plate.stand(q, "y", PLACE, FLAT, (0.33, 0.43))
            step = plate.law.hold(q, target, with_height(share))
            own = plate.law.measure(q, arm)
            assert step.measure == pytest.approx(own, rel=1e-9)
            q = step.q
        kept[share] = own, float(q[HEIGHT])
    assert kept[0.0][1] == START[HEIGHT]
    assert kept[1.0][1] > START[HEIGHT] + 0.02
    assert kept[1.0][0] > 1.1 * kept[0.0][0]


def test_the_plates_heading_moves_the_tool_as_the_arms_first_joint_does() -> None:
    """Why a level plate's heading is of no use to a tool: joint and heading turn about the same axis."""
    robot, rng = hoshino(), np.random.default_rng(3)
    for _ in range(20):
        q = np.concatenate([rng.uniform(-0.3, 0.3, 3), [rng.uniform(-3.0, 3.0), 0.0, 0.0], rng.uniform(-1.5, 1.5, 4)])
        law = Cooperator(
            robot,
            Cooperation(speeds=np.ones(10), tool_speeds=np.ones(3), limited=False),
            PlantedFeet(robot=robot, support="y", pose=q[:6]),
        )
        jacobian = law.scaled_jacobian(q, np.ones(10))
        np.testing.assert_allclose(jacobian[:, 3], jacobian[:, 6], atol=1e-12)


def test_what_a_plate_within_the_levels_demand_can_do_for_the_tool() -> None:
    """Why tilting is of no use: 0.1 deg moves the farthest place of the tool by 1.4 mm."""
    robot = hoshino()
    arm = robot.arm
    assert arm is not None
    farthest = math.hypot(arm.out + sum(arm.links), arm.up)
    assert math.radians(0.1) * farthest == pytest.approx(1.42e-3, abs=1e-5)
