"""Climbs in a plane carried out in space: the same robot, holds and goals there, and jaws about what stands out of a wall."""

import math
from dataclasses import replace

import numpy as np
import pytest
from spatial_again import in_space

from clamber.families.spatial.execution.course import Course
from clamber.families.spatial.sim.spatial_flaws import Deviations, SpatialFlaws
from clamber.families.spatial.sim.spatial_plant import SpatialSim
from clamber.family import family_of
from clamber.planning.problem.plan import Plan
from clamber.planning.problem.problems import plan_family
from clamber.tasks import load_task
from clamber.trials.work import fit_family
from clamber.units import GRAVITY

GECKO = "gecko-climb"
"""Four limbs that grip, too weak for the control of climbers."""


def test_robot_holds_and_goal_are_those_of_the_plane() -> None:
    plane, task = load_task(GECKO), in_space(GECKO)
    assert task.robot.chains.total_mass * GRAVITY == pytest.approx(plane.robot.weight, rel=1e-5)  # MJCF has six digits
    kept = [(hold.x, hold.y) for hold in plane.world.holds if hold.direction is None]
    assert np.allclose(task.world.places[:, (0, 2)], kept, atol=1e-8)
    assert not task.world.places[:, 1].any()
    assert task.robot.limb_names == plane.robot.limb_names
    goal = task.goals[-1]
    lowest = plane.start.y - task.start.along
    assert goal.along_min == pytest.approx(1.4 - lowest)


def test_tips_are_where_they_are_in_the_plane() -> None:
    """At the start's joints, by MuJoCo: the chain is the plane's own model, the pose its turned one."""
    plane, task = load_task(GECKO), in_space(GECKO)
    start = plane_start_joints(plane)
    plan = Plan.of_codes(task, [])
    pose = Course.of(task, plan).start.pose
    plant = SpatialSim(task.robot, task.world, SpatialFlaws(), Deviations.none(task.robot, task.world))
    plant.reset(pose, start.ravel(), [-1] * len(task.robot.limb_names))
    tips = plant.truth().tips
    for limb, tip in zip(plane.robot.limbs, tips, strict=True):
        hold = next(hold for hold in plane.world.holds if hold.number == plane.start.holds[limb.name])
        assert tip[[0, 2]] == pytest.approx((hold.x, hold.y), abs=1e-6)  # of MJCF's six digits
        assert tip[1] == pytest.approx(0.0, abs=1e-9)


def plane_start_joints(plane: object) -> np.ndarray:
    """Joints of the plane's start [rad], shape (limbs, 2)."""
    replay = plan_family(plane).problem(plane).replay(())
    return family_of(plane).trajectories.plan(plane, replay).positions[0]


def test_a_push_out_of_the_wall_is_borne_besides_the_weight() -> None:
    """Tips in one line would bear the weight, but the robot would swing about that line."""
    plane, task = load_task(GECKO), in_space(GECKO)
    assert task.rules.push == pytest.approx((0.0, -0.15 * plane.robot.weight, 0.0))


CORNERS = "[['0 cm','0 cm'],['50 cm','0 cm'],['20 cm','90 cm']]"


@pytest.mark.parametrize("key", [f"goal.region={CORNERS}", f"board.keep_out=[{CORNERS}]", "goal.holds.upper-left=48"])
def test_what_has_no_counterpart_in_space_stays_with_climbers(key: str) -> None:
    plane = load_task(GECKO, [key])
    family, item, note = fit_family(family_of(plane), plane)
    assert family.name == "limbed" and item is plane and note is None


@pytest.mark.parametrize(("out", "takes"), [(0.0, True), (0.014, True), (-0.014, True), (0.018, False)])
def test_jaws_take_a_peg_anywhere_within_them_and_stay_there(out: float, takes: bool) -> None:
    """A peg that is `out` of the wall's plane [m] by other than was believed; jaws are 32 mm deep."""
    task = in_space(GECKO)
    start = Course.of(task, Plan.of_codes(task, [])).start
    places = task.world.places.copy()
    places[:, 1] -= out
    places[:, 0] += 0.004
    plant = SpatialSim(
        task.robot, task.world, SpatialFlaws(), replace(Deviations.none(task.robot, task.world), places=places)
    )
    plant.reset(start.pose, start.joints, [-1] * 4)
    plant.grip(0, True)
    before = plant.truth().tips[0]
    for _ in range(4):
        plant.actuate(np.zeros(8))
        plant.step()
    assert (plant.truth().attached[0] >= 0) == takes
    assert math.isclose(plant.truth().tips[0, 1], before[1], abs_tol=2e-4)
