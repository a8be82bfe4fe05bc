"""Holds in contact dynamics: they break at their strength or outside their direction, for good, and others stay as they were."""

import math
from dataclasses import replace

import numpy as np
import pytest

from clamber.families.climber.execution.postures import postures
from clamber.families.climber.robot.robot import LimbedRobot
from clamber.families.climber.sim.climber_plant import ClimberPlant
from clamber.families.climber.trials.noise import Noise
from clamber.families.climber.trials.run_plan import climbing_flaws, climbing_task, run_plan
from clamber.families.climber.world.board import Board, Hold
from clamber.planning.problem.plan import Plan
from clamber.sim.limb_flaws import LimbFlaws
from clamber.tasks.robots import load_robot
from clamber.trials.work import open_work

FLAWS = LimbFlaws(physics_rate=1000.0)
RIGHT = 0
NONE = np.zeros(3, np.int32)


def hanging(hold: Hold, robot_name: str = "libra-grippers") -> ClimberPlant:
    """A robot without torques that hangs still on one hold, straight below it."""
    robot = load_robot(robot_name)
    assert isinstance(robot, LimbedRobot)
    plant = ClimberPlant(robot, Board(name="one", title="", holds=(hold,)), FLAWS)
    limb = robot.limbs[RIGHT]
    pose = np.array((0.0, 0.0, 0.5 * math.pi))  # the right limb upwards
    pose[:2] = (hold.x + limb.port_y, hold.y - 0.95 * limb.length - limb.port_x)
    q = np.zeros((3, 2))
    q[RIGHT] = postures(limb, pose, np.array((hold.x, hold.y)))[0].angles
    plant.reset(pose, q)
    return plant


def settle(plant: ClimberPlant, seconds: float, grips: np.ndarray) -> None:
    for _ in range(round(seconds / plant.period)):
        plant.actuate(np.zeros((3, 2)), grips)
        plant.step()


def pulled_until_it_breaks(plant: ClimberPlant, rate: float, most: float, grips: np.ndarray) -> float:
    """Force of a push straight down that grows by `rate` [N/s] when the hold gives way; infinite if `most` does not break it."""
    force = 0.0
    while force < most:
        plant.push((0.0, -force))
        plant.actuate(np.zeros((3, 2)), grips)
        plant.step()
        if plant.truth().broken:
            return force
        force += rate * plant.period
    return math.inf


@pytest.mark.parametrize("strength", [60.0, 120.0])
def test_a_hold_breaks_within_one_percent_of_its_strength(strength: float) -> None:
    shut = np.array((1, 0, 0), np.int32)
    plant = hanging(Hold(number=7, x=0.0, y=0.0, radius=0.005, strength=strength))
    settle(plant, 12.0, shut)
    assert plant.sense().gripped[RIGHT]
    force = pulled_until_it_breaks(plant, 8.0, 200.0, shut)
    assert plant.robot.weight + force == pytest.approx(strength, rel=0.01)
    (told,) = plant.truth().broken
    assert told.hold == 7
    assert told.force == pytest.approx(strength, rel=0.01)
    assert not plant.sense().gripped[RIGHT]
    before = plant.truth().pose[1]
    settle(plant, 0.3, shut)
    assert plant.truth().pose[1] < before - 0.2  # it drops, jaws shut or not
    plant.reset(np.array((0.0, -0.4, 0.0)), np.zeros((3, 2)))
    assert plant.truth().broken == ()


def test_a_strong_hold_bears_the_same_push_and_a_weakened_one_does_not() -> None:
    shut = np.array((1, 0, 0), np.int32)
    for weaken in (False, True):
        plant = hanging(Hold(number=1, x=0.0, y=0.0, radius=0.005))
        settle(plant, 12.0, shut)
        if weaken:
            plant.weaken(1, 60.0)
        force = pulled_until_it_breaks(plant, 20.0, 60.0, shut)
        assert math.isfinite(force) == weaken


@pytest.mark.parametrize(("lean", "breaks"), [(0.0, False), (20.0, False), (40.0, True), (180.0, True)])
def test_a_hold_gives_way_to_a_pull_outside_its_direction(lean: float, breaks: bool) -> None:
    """Straight down at rest: the angle between that and the hold's direction decides."""
    shut = np.array((1, 0, 0), np.int32)
    plant = hanging(Hold(number=1, x=0.0, y=0.0, radius=0.005))
    settle(plant, 12.0, shut)
    pose, q = plant.truth().pose.copy(), plant.truth().q.copy()
    direction = math.radians(lean - 90.0)
    other = hanging(Hold(number=1, x=0.0, y=0.0, radius=0.005, direction=direction, cone=math.radians(30.0)))
    other.reset(pose, q)
    settle(other, 0.5, shut)
    assert bool(other.truth().broken) == breaks
    if breaks:
        assert "from its direction" in other.truth().broken[0].why


@pytest.mark.slow
def test_a_climb_on_a_hold_that_is_too_weak_ends_with_its_cause() -> None:
    """Once a robot of 40 N climbed past a hold of 1 N."""
    work = open_work("ladder-hand")
    task, plan = climbing_task(work.item), work.plan
    assert plan is not None
    grabbed = next(action.hold for action in plan.actions if action.hold is not None)
    holds = tuple(replace(hold, strength=1.0) if hold.number == grabbed else hold for hold in task.world.holds)
    weak = replace(task, world=replace(task.world, holds=holds))
    run = run_plan(weak, plan, climbing_flaws(weak, ()), noise=Noise.of("none"), force=True)
    assert not run.done
    assert run.report.broken
    assert run.report.broken[0].hold == grabbed
    assert f"hold {grabbed} broke" in run.reason
    assert run.to_json()["broken"][0]["hold"] == grabbed
    assert run.trace.notes is not None
    assert run.trace.notes["broken"][0]["hold"] == grabbed


@pytest.mark.slow
@pytest.mark.parametrize(("direction", "breaks"), [(90.0, True), (-90.0, False)])
def test_a_hold_gives_way_to_a_hook_that_pulls_outside_its_direction(direction: float, breaks: bool) -> None:
    """A hook has no jaws: what it pulls is the sum of its contacts, which is downwards and to a side on a ladder."""
    work = open_work("ladder-hand")
    task, plan = climbing_task(work.item), work.plan
    assert plan is not None
    grabbed = next(action.hold for action in plan.actions if action.hold is not None)
    limits = {"direction": math.radians(direction), "cone": math.radians(80.0)}
    holds = tuple(replace(hold, **limits) if hold.number == grabbed else hold for hold in task.world.holds)
    odd = replace(task, world=replace(task.world, holds=holds))
    few = Plan.of_codes(odd, plan.codes(odd, "plan")[:3])
    run = run_plan(odd, few, climbing_flaws(odd, ()), noise=Noise.of("none"), force=True)
    assert [(told.hold, "from its direction" in told.why) for told in run.report.broken] == [(grabbed, True)] * breaks
