"""Climbers of any weight: control takes each for one of the weight that it was made for, and drives its motors as much harder."""

from dataclasses import replace

import numpy as np
import pytest

from clamber.benchmarks.climb_speed import two_rungs
from clamber.control.chain import ChainError
from clamber.families.climber.robot.robot import LimbedRobot, body_inertia
from clamber.families.climber.trials.run_plan import ClimbRun, climbing_flaws, run_plan


def climbed(robot: LimbedRobot, **flaws: float) -> ClimbRun:
    task, plan = two_rungs()
    return run_plan(replace(task, robot=robot), plan, climbing_flaws(task, ()).with_changes(**flaws))


@pytest.mark.slow
@pytest.mark.parametrize("times", [0.1, 0.5, 3.0, 10.0])
def test_a_robot_of_another_weight_climbs_as_soon(times: float) -> None:
    robot = two_rungs()[0].robot
    runs = [climbed(one) for one in (robot, robot.at_weight(times * robot.weight))]
    assert all(run.report.done for run in runs), runs[1].report.reason
    assert runs[1].report.seconds == pytest.approx(runs[0].report.seconds, rel=0.05)


@pytest.mark.parametrize("times", [0.5, 3.0])
def test_torques_go_with_the_weight(times: float) -> None:
    """Without play, whose inertia in the plant does not grow; later on contacts make much of the least difference."""
    robot = two_rungs()[0].robot
    usual, other = (climbed(one, backlash=0.0).trace for one in (robot, robot.at_weight(times * robot.weight)))
    first = int((usual.time < 0.4).sum())
    np.testing.assert_allclose(other.torques[:first], times * usual.torques[:first], atol=times * 1e-3)


@pytest.mark.parametrize("times", [0.1, 0.3, 4.0])
def test_lighter_and_heavier_rotors_are_moved_as_fast_as_they_can_be(times: float) -> None:
    robot = two_rungs()[0].robot
    limbs = tuple(
        replace(
            limb,
            shoulder=replace(limb.shoulder, inertia=times * limb.shoulder.inertia),
            elbow=replace(limb.elbow, inertia=times * limb.elbow.inertia),
        )
        for limb in robot.limbs
    )
    run = climbed(replace(robot, limbs=limbs))
    assert run.report.done, run.report.reason


@pytest.mark.parametrize("speed", [1.5, 6.0])
def test_slower_and_faster_motors_climb(speed: float) -> None:
    robot = two_rungs()[0].robot
    run = climbed(replace(robot, motor=replace(robot.motor, no_load_speed=speed)))
    assert run.report.done, run.report.reason


def test_a_robot_at_another_weight_accelerates_as_before_and_comes_back() -> None:
    robot = two_rungs()[0].robot
    heavy = robot.at_weight(3.0 * robot.weight)
    assert heavy.weight == 3.0 * robot.weight and robot.at_weight(robot.weight) is robot
    assert body_inertia(heavy) == pytest.approx(3.0 * body_inertia(robot))
    for ours, theirs in zip(heavy.joints, robot.joints, strict=True):
        assert heavy.torque_limit_of(ours) / ours.inertia == pytest.approx(
            robot.torque_limit_of(theirs) / theirs.inertia
        )
        assert heavy.no_load_speed_of(ours) == robot.no_load_speed_of(theirs)
    back = heavy.at_weight(robot.weight)
    assert back.limbs[0].link_masses == pytest.approx(robot.limbs[0].link_masses)


def test_a_robot_without_rotors_is_refused_by_name() -> None:
    robot = two_rungs()[0].robot
    bare = replace(robot.limbs[0], elbow=replace(robot.limbs[0].elbow, inertia=0.0))
    with pytest.raises(ChainError, match=r"right elbow's share by inertia = 0\.0"):
        climbed(replace(robot, limbs=(bare, *robot.limbs[1:])))
