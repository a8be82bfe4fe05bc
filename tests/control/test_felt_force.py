"""What a tip feels, from motors and encoders."""

import math

import numpy as np
import pytest

from clamber.families.climber.control.felt_force import FLAT, feel_forces
from clamber.families.climber.execution.fall import FallWatch
from clamber.families.climber.execution.whole_body import WholeBody
from clamber.families.climber.robot.robot import LimbedRobot
from clamber.tasks.robots import load_robot
from clamber.types import Floats

PERIOD = 0.005
ANGLE = 0.2
BENT = np.array((0.0, 1.5))


def libra() -> WholeBody:
    robot = load_robot("libra")
    assert isinstance(robot, LimbedRobot)
    return WholeBody(robot, period=PERIOD)


def tip_in_world(body: WholeBody, i: int, q: Floats) -> Floats:
    limb = body.robot.limbs[i]
    first = ANGLE + limb.port_angle + q[0]
    second = first + q[1] + limb.hook_beta
    return limb.l1 * np.array((math.cos(first), math.sin(first))) + limb.l2_effective * np.array(
        (math.cos(second), math.sin(second))
    )


def jacobian(body: WholeBody, i: int, q: Floats) -> Floats:
    step = 1e-6 * np.eye(2)
    return np.stack([(tip_in_world(body, i, q + s) - tip_in_world(body, i, q - s)) / 2e-6 for s in step], axis=1)


def weight_torques(body: WholeBody, i: int, q: Floats) -> Floats:
    """The gradient of the links' potential energy."""
    limb, (upper, lower) = body.robot.limbs[i], body.chains[i].joints

    def energy(angles: Floats) -> float:
        first = ANGLE + limb.port_angle + angles[0]
        second = first + angles[1]
        elbow = limb.l1 * math.sin(first)
        heights = (
            upper["centre"][0] * math.sin(first) + upper["centre"][1] * math.cos(first),
            elbow + lower["centre"][0] * math.sin(second) + lower["centre"][1] * math.cos(second),
        )
        return 9.80665 * float(upper["mass"] * heights[0] + lower["mass"] * heights[1])

    step = 1e-6 * np.eye(2)
    return np.array([(energy(q + s) - energy(q - s)) / 2e-6 for s in step])


def feel(body: WholeBody, q: Floats, qd: Floats, before: Floats, torques: Floats) -> Floats:
    felt, forces = np.zeros((body.n, 2)), np.zeros((body.n, 2))
    body.pose[2] = ANGLE
    work = body.work._replace(q=q, qd=qd, torques=np.array(torques))
    feel_forces(work, before.copy(), felt, forces, PERIOD, 1.0)
    return forces


@pytest.mark.parametrize("seed", range(5))
def test_a_tip_at_rest_feels_the_force_whose_torques_its_motors_hold(seed: int) -> None:
    body, rng = libra(), np.random.default_rng(seed)
    q = BENT + rng.uniform(-1.0, 1.0, (body.n, 2))
    forces = rng.normal(0.0, 20.0, (body.n, 2))
    torques = np.array([jacobian(body, i, q[i]).T @ forces[i] + weight_torques(body, i, q[i]) for i in range(body.n)])
    still = np.zeros((body.n, 2))
    np.testing.assert_allclose(feel(body, q, still, still, torques), forces, atol=1e-5)


@pytest.mark.parametrize("seed", range(5))
def test_a_tip_in_the_air_feels_nothing_however_its_motors_turn(seed: int) -> None:
    body, rng = libra(), np.random.default_rng(seed)
    q = BENT + rng.uniform(-1.0, 1.0, (body.n, 2))
    qd = rng.choice((-1.0, 1.0), (body.n, 2)) * rng.uniform(0.1, 2.0, (body.n, 2))
    qdd = rng.normal(0.0, 10.0, (body.n, 2))
    joints = [chain.joints for chain in body.chains]
    torques = np.array([
        each["rotor"] * qdd[i] + each["damping"] * qd[i] + each["friction"] * np.sign(qd[i])
        + weight_torques(body, i, q[i])
        for i, each in enumerate(joints)
    ])  # fmt: skip
    np.testing.assert_allclose(feel(body, q, qd, qd - PERIOD * qdd, torques), 0.0, atol=1e-5)


def test_a_stretched_limb_does_not_tell() -> None:
    body = libra()
    q = np.zeros((body.n, 2))
    q[:, 1] = 1.0
    q[0, 1] = 0.5 * FLAT - body.robot.limbs[0].hook_beta
    still = np.zeros((body.n, 2))
    forces = feel(body, q, still, still, still)
    assert np.isinf(forces[0]).all() and np.isfinite(forces[1:]).all()


def test_a_limb_that_holds_and_cannot_tell_keeps_the_watch_quiet() -> None:
    body = libra()
    watch = FallWatch(body)
    watch.reset()
    body.held[0] = 1
    body.q[:, 1] = 1.0
    watch.see()
    assert watch.carried < 10.0
    body.q[0, 1] = -body.robot.limbs[0].hook_beta
    assert not any(watch.see() for _ in range(100))
    assert watch.carried == math.inf
    body.held[0] = 0  # what swings does not carry, whether it can tell or not
    watch.see()
    assert watch.carried < 10.0
