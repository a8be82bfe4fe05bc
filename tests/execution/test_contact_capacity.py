"""Whether limbs bear a plan's stance with their elbows on given sides."""

import math

import numpy as np
import pytest

from clamber.families.climber.control.limb_chain import legs_of
from clamber.families.climber.execution.climber import Climber
from clamber.families.climber.execution.elbows import load_capacity
from clamber.families.climber.execution.executable_plan import ExecutablePlan, climbable, lay_course
from clamber.families.climber.planning.plans import thesis_code
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.climber.sim.climber_plant import ClimberPlant
from clamber.planning.problem.plan import Plan
from clamber.sim.limb_flaws import LimbFlaws
from clamber.tasks import load_task

RUNG = (106, 301, 205, 300, 3, 3)
"""A rung by the gait of the thesis."""


def a_rung() -> ExecutablePlan:
    task = load_task("ladder")
    assert isinstance(task, LimbedTask)
    strict = climbable(task)
    return lay_course(task, Plan.of_codes(strict, [thesis_code(strict, number) for number in RUNG], planner="by hand"))


@pytest.mark.parametrize("step", range(len(RUNG) + 1))
def test_a_stance_is_borne_as_well_as_by_a_robot_that_stands_there(step: int) -> None:
    course = a_rung()
    task, sides = course.task, course.elbows[step]
    climber = Climber(task.robot, task.world, ClimberPlant(task.robot, task.world, LimbFlaws(physics_rate=1000.0)))
    names = [limb.name for limb in task.robot.limbs]
    climber.start(
        course.pose(step), course.holds(step), idle=course.idle(step), elbows=dict(zip(names, sides, strict=True))
    )
    told = load_capacity(task.robot, legs_of(task.robot), task.world.positions(), course.stances[step], sides)
    # the free or idle limb's own weight hangs elsewhere there [N]
    assert told == pytest.approx(climber.body.stands(course.pose(step)), abs=1.0)


def test_a_hook_that_would_pull_up_bears_nothing_and_its_elbow_stays_on_its_side() -> None:
    course = a_rung()
    stance = course.stances[0].copy()
    carriers = [i for i in range(3) if int(stance["carriers"]) >> i & 1]
    # both ports go above the holds: what hung on them would now have to stand on them
    stance["y"] += 0.45
    places = course.task.world.positions()
    sides = [np.where(np.arange(3) == carriers[0], sign, course.elbows[0]) for sign in (1, -1)]
    assert (
        max(load_capacity(course.task.robot, legs_of(course.task.robot), places, stance, each) for each in sides) < -5.0
    )


def test_a_limb_without_a_posture_bears_nothing() -> None:
    course = a_rung()
    stance = course.stances[0].copy()
    stance["y"] -= 3.0
    legs, places = legs_of(course.task.robot), course.task.world.positions()
    assert load_capacity(course.task.robot, legs, places, stance, course.elbows[0]) == -math.inf
