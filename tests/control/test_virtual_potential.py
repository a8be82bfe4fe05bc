"""The virtual potential about the body: Khatib's field on free limbs, whatever their number."""

import math

import numpy as np
import pytest

from clamber.families.climber.execution.body_gains import BodyGains
from clamber.families.climber.execution.whole_body import MOST_REPELLED, WholeBody
from clamber.families.climber.robot.robot import LimbedRobot
from clamber.tasks.robots import load_robot
from clamber.types import Floats

STRENGTH, RANGE = 0.1, 0.2


def robot_named(name: str) -> LimbedRobot:
    robot = load_robot(name)
    assert isinstance(robot, LimbedRobot)
    return robot


def repelled(robot: LimbedRobot, i: int, angles: Floats, mode: str = "swing_joint") -> tuple[Floats, float]:
    """Torques that the potential adds to limb `i`, and its gap [m]; the other limbs hold."""
    torques = []
    for strength in (STRENGTH, 0.0):
        body = WholeBody(robot, period=0.005, gains=BodyGains(potential=strength, potential_range=RANGE))
        for k, task in enumerate(body.tasks):
            task.mode = "unloaded_contact" if k != i else mode  # type: ignore[assignment]
            task.angles = angles.copy()
        body.see(np.tile(angles, (body.n, 1)), np.zeros((body.n, 2)), 0.3, 0.0)
        torques.append(body.command().copy())
        if strength:
            gap = float(body.gaps[i])
    added = torques[0] - torques[1]
    assert not np.delete(added, i, axis=0).any()  # what clings is not repelled
    return added[i], gap


def energy(robot: LimbedRobot, gap: float) -> float:
    """Khatib's potential [J]."""
    reach = RANGE * max(limb.length for limb in robot.limbs)
    size = STRENGTH * robot.weight * reach**3
    return 0.5 * size * (1.0 / gap - 1.0 / reach) ** 2 if gap < reach else 0.0


@pytest.mark.parametrize("name", ["libra", "gecko4"])
def test_the_torques_are_minus_the_gradient_of_khatibs_potential(name: str) -> None:
    robot = robot_named(name)
    reach = RANGE * max(limb.length for limb in robot.limbs)
    rng = np.random.default_rng(0)
    near = 0
    for i in range(len(robot.limbs)):
        for _ in range(12):
            angles = np.array((rng.uniform(-1.5, 1.5), rng.choice((-1.0, 1.0)) * rng.uniform(1.8, 2.8)))
            added, gap = repelled(robot, i, angles)
            if gap >= reach:
                assert not added.any()
            if not 0.45 * reach < gap < reach:  # nearer, the force is the largest that it may be
                continue
            near += 1
            ahead, behind = (
                [energy(robot, repelled(robot, i, angles + sign * step)[1]) for step in 1e-6 * np.eye(2)]
                for sign in (1.0, -1.0)
            )
            slope = (np.array(ahead) - behind) / 2e-6
            np.testing.assert_allclose(added, -slope, rtol=1e-4, atol=1e-5)
    assert near >= 5


def test_a_limb_folded_into_the_body_is_pushed_out_with_no_more_than_the_most() -> None:
    robot = robot_named("libra")
    limb = robot.limbs[0]
    angles = np.array((0.0, math.pi - 0.05))  # the tip back in the body
    added, gap = repelled(robot, 0, angles)
    assert gap < 0.0 and added.any()
    assert repelled(robot, 0, angles + 0.05 * np.sign(added))[1] >= gap
    assert np.abs(added).max() <= MOST_REPELLED * robot.weight * limb.length


def test_limbs_that_push_at_a_hold_or_have_no_potential_are_as_they_were() -> None:
    robot = robot_named("libra")
    angles = np.array((0.0, math.pi - 0.05))
    assert repelled(robot, 0, angles, "swing_joint")[0].any()
    assert not repelled(robot, 0, angles, "contact_push")[0].any()
    assert BodyGains().potential == 0.0
