"""A free limb that pulls, and the play of joints that are loaded."""

import numpy as np

from clamber.families.climber.control.backlash import follow_play, pull_torques
from clamber.families.climber.control.limb_chain import chain_of_limb
from clamber.families.climber.execution.whole_body import WholeBody
from clamber.families.climber.robot.robot import LimbedRobot
from clamber.tasks.robots import load_robot
from clamber.types import Floats
from clamber.units import GRAVITY

ROBOT = load_robot("libra")
assert isinstance(ROBOT, LimbedRobot)
BODY = WholeBody(ROBOT, period=0.005)
STILL = np.zeros(3)


def test_the_torque_is_the_force_through_the_jacobian_and_the_limbs_own_weight() -> None:
    """But for friction, which is fed forward, and of which a motor that turns takes all, one that stands up to as much either way: what
    surely loads the joint is the least that it may be."""
    rng = np.random.default_rng(3)
    for i, limb in enumerate(ROBOT.limbs):
        q, force = rng.uniform(-1.2, 1.2, 2), rng.normal(0.0, 10.0, 2)
        pose = np.array((0.3, -0.2, 0.4))
        torques, loads = np.zeros(2), np.zeros(2)
        pull_torques(BODY.legs[i], (q, np.zeros(2)), (pose, STILL), force, 150.0, torques, loads)
        angle = -(pose[2] + limb.port_angle)
        turn = np.array(((np.cos(angle), -np.sin(angle)), (np.sin(angle), np.cos(angle))))
        chain, down = chain_of_limb(ROBOT, limb.name), turn @ np.array((0.0, -GRAVITY))
        weight = chain.with_gravity((down[0], down[1], 0.0)).bias(q, np.zeros(2))
        friction, both = chain.joints["friction"], chain.jacobian(q)[:2].T @ (turn @ force) + weight
        assert np.all(np.abs(torques - both) <= friction + 1e-12)
        np.testing.assert_allclose(loads, np.sign(torques) * np.maximum(np.abs(torques) - friction, 0.0), atol=1e-9)
        turning = np.sign(both - weight) * 1e3
        pull_torques(BODY.legs[i], (q, turning), (pose, STILL), force, 0.0, torques, loads)
        np.testing.assert_allclose(loads, torques - friction * np.sign(turning), atol=1e-9)


def test_damping_takes_power_from_a_tip_that_moves_with_the_body_too() -> None:
    rng = np.random.default_rng(4)
    for i in range(3):
        q, qd, twist = rng.uniform(-1.0, 1.0, 2), rng.normal(0.0, 1.0, 2), np.zeros(3)
        still, damped, loads = np.zeros(2), np.zeros(2), np.zeros(2)
        arguments = (BODY.legs[i], (q, qd), (STILL, twist), np.zeros(2))
        pull_torques(*arguments, 0.0, still, loads)
        pull_torques(*arguments, 150.0, damped, loads)
        assert (damped - still) @ qd < 0.0


def test_a_pressed_joint_comes_to_rest_at_the_side_that_its_load_pushes_it_to() -> None:
    play, sure, half = np.zeros((3, 2)), np.zeros((3, 2)), np.radians(1.0)
    loads = np.array(((1.0, -1.0), (-2.0, 0.5), (0.0, 3.0)))
    for _ in range(400):
        follow_play(
            BODY.legs, (np.zeros((3, 2)), np.zeros((3, 2))), 0.0, (np.zeros(3, np.int64), np.zeros((3, 2))),
            (np.ones(3, np.int64), loads), np.array((0.025, half)), play, sure,
        )  # fmt: skip
    np.testing.assert_allclose(play, half * np.tanh(loads / 0.05), atol=1e-4)
    np.testing.assert_allclose(sure, np.tanh(np.abs(loads) / 0.05), atol=1e-3)


def holding_joints(rng: np.random.Generator, speeds: Floats) -> tuple[Floats, Floats, Floats, Floats, Floats]:
    """Limbs that hold with any forces, their motors turning at these speeds: torques without friction, friction, and of their play the
    side before and after a while, [rad], and how sure it is."""
    half, rate, angle = np.radians(1.0), np.array((0.025, np.radians(1.0))), 0.3
    q, forces = rng.uniform(-1.2, 1.2, (3, 2)), rng.normal(0.0, 3.0, (3, 2))
    before = half * rng.choice((-1.0, 1.0), (3, 2))
    play, sure = before.copy(), rng.uniform(0.0, 1.0, (3, 2))
    for _ in range(2000):
        follow_play(
            BODY.legs, (q, speeds), angle, (np.ones(3, np.int64), forces), (np.zeros(3, np.int64), np.zeros((3, 2))), rate,
            play, sure,
        )  # fmt: skip
    torques, dry = np.zeros((3, 2)), np.zeros((3, 2))
    for i, limb in enumerate(ROBOT.limbs):
        turn = angle + limb.port_angle
        down = GRAVITY * np.array((-np.sin(turn), -np.cos(turn)))
        chain = chain_of_limb(ROBOT, limb.name)
        weight = chain.with_gravity((down[0], down[1], 0.0)).bias(q[i], np.zeros(2))
        torques[i], dry[i] = chain.jacobian(q[i])[:2].T @ forces[i] + weight, chain.joints["friction"]
    return torques, dry, before, play, sure


def test_a_holding_joint_keeps_its_side_within_its_friction_unsure_of_it_and_takes_that_of_its_load_beyond() -> None:
    rng = np.random.default_rng(5)
    half, kept, followed = np.radians(1.0), 0, 0
    for _ in range(40):
        torques, dry, before, play, sure = holding_joints(rng, np.zeros((3, 2)))
        inside, beyond = np.abs(torques) < dry, np.abs(torques) > dry + 0.1
        np.testing.assert_array_equal(play[inside], before[inside])
        np.testing.assert_allclose(sure[inside], 0.0, atol=1e-9)
        np.testing.assert_allclose(play[beyond], half * np.sign(torques)[beyond], rtol=0.05)
        assert np.all(sure[beyond] > 0.95)
        kept, followed = kept + int(inside.sum()), followed + int(beyond.sum())
    assert kept > 20 and followed > 20


def test_friction_of_a_motor_that_turns_is_all_against_it_so_its_joint_tells_its_side() -> None:
    rng = np.random.default_rng(6)
    half, told = np.radians(1.0), 0
    for _ in range(40):
        speeds = rng.choice((-0.3, 0.3), (3, 2))
        torques, dry, _, play, sure = holding_joints(rng, speeds)
        loads = torques - dry * np.sign(speeds)
        clear = np.abs(loads) > 0.1
        np.testing.assert_allclose(play[clear], half * np.sign(loads)[clear], rtol=0.05)
        assert np.all(sure[clear] > 0.95)
        told += int((clear & (np.abs(torques) < dry)).sum())
    assert told > 20
