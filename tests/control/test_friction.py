"""Friction fed forward: whose direction it has, moving and at rest."""

import numpy as np
import pytest

from clamber.control.controller import Controller, still_aim
from clamber.control.law_settings import LawSettings
from clamber.limb_bench.bench_limb import bench_limb
from clamber.sim.bench_limb import BenchLimb


@pytest.fixture(scope="module")
def leg() -> BenchLimb:
    return bench_limb()


def added(
    leg: BenchLimb, source: str, speeds: list[np.ndarray], pull: float = 0.0, aim_speed: float = 0.0
) -> np.ndarray:
    """What friction adds at the last of some ticks with measured joint speeds, of a law that pulls by J^T (pull, 0)."""
    torques = []
    for part in (1.0, 0.0):
        settings = LawSettings(
            law="hybrid", kp=0.0, kd=0.0, forced=("x",), force_damping=0.0, feed_friction=part, friction_from=source
        )
        law = Controller(leg.chain, settings, period=0.005)
        aim = still_aim(leg.start)
        aim["wrench"][0, 0], aim["twist"][0, 1] = pull, aim_speed
        for speed in speeds:
            torque = law.command(aim, np.stack((leg.q0, speed))[None])[0].copy()
        torques.append(torque)
    return np.asarray(torques[0] - torques[1])


REST = np.zeros(2)


def test_at_rest_neither_aim_nor_measured_speed_tells_a_direction(leg: BenchLimb) -> None:
    for source in ("aim", "measured"):
        np.testing.assert_allclose(added(leg, source, [REST], pull=20.0), 0.0, atol=1e-12)


def test_a_moving_aim_tells_the_direction_of_all_but_torque(leg: BenchLimb) -> None:
    motion = np.linalg.solve(leg.chain.jacobian(leg.q0)[:2], (0.0, 0.1))
    joints = leg.chain.joints
    wanted = joints["damping"] * motion + joints["friction"] * np.sign(motion)
    for source in ("aim", "last"):
        np.testing.assert_allclose(added(leg, source, [REST], aim_speed=0.1), wanted, rtol=1e-6)


def test_torque_has_the_direction_of_the_pull(leg: BenchLimb) -> None:
    pull = leg.chain.jacobian(leg.q0)[:2].T @ (20.0, 20.0)
    # along x alone the shoulder pulls nothing
    wanted = leg.chain.joints["friction"] * (0.0, np.sign(leg.chain.jacobian(leg.q0)[0, 1]))
    assert np.abs(pull).min() > 0.0
    np.testing.assert_allclose(added(leg, "torque", [REST], pull=20.0), wanted, atol=1e-6)


def test_last_is_torque_until_a_joint_moves_and_then_remembers(leg: BenchLimb) -> None:
    friction = leg.chain.joints["friction"]
    np.testing.assert_allclose(
        added(leg, "last", [REST], pull=20.0), added(leg, "torque", [REST], pull=20.0), atol=1e-12
    )
    there, slower = np.array((0.1, 0.1)), np.array((-0.01, -0.01))
    for way in (1.0, -1.0):
        np.testing.assert_allclose(added(leg, "last", [way * there, REST], pull=20.0), way * friction, atol=1e-12)
        # speeds below the threshold may be the encoder's
        np.testing.assert_allclose(
            added(leg, "last", [way * there, way * slower], pull=20.0), way * friction, atol=1e-12
        )


def test_friction_that_was_remembered_is_forgotten_by_a_reset(leg: BenchLimb) -> None:
    settings = LawSettings(law="hybrid", kp=0.0, kd=0.0, forced=("x",), feed_friction=1.0, friction_from="last")
    law = Controller(leg.chain, settings, period=0.005)
    aim = still_aim(leg.start)
    law.command(aim, np.stack((leg.q0, (0.1, 0.1)))[None])
    law.reset()
    np.testing.assert_allclose(law.command(aim, np.stack((leg.q0, REST))[None]), 0.0, atol=1e-12)
