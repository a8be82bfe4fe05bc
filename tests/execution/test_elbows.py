"""Elbows of a plan that is to be carried out: the side with which hooks bear, also beside other holds."""

import math
from pathlib import Path

import numpy as np
import pytest

from clamber.families.climber.control.limb_chain import legs_of
from clamber.families.climber.execution.elbows import load_capacity
from clamber.families.climber.execution.executable_plan import ExecutablePlan, lay_course
from clamber.families.climber.execution.postures import postures
from clamber.families.climber.trials.run_plan import climbing_task
from clamber.planning.problem.plan_source import open_plan

CIRCLE = Path(__file__).parents[2] / "examples" / "circle" / "plan.json"
TWINS = {21: 24, 24: 21, 23: 25, 25: 23}
"""Pegs an inch apart."""


@pytest.fixture(scope="module")
def course() -> ExecutablePlan:
    opened = open_plan(CIRCLE)
    return lay_course(climbing_task(opened.task), opened.plan)


def test_two_hooks_bear_the_body_in_every_stance(course: ExecutablePlan) -> None:
    """By the controller's own reckoning: where they lacked 6 N, one climb in eight fell."""
    places = course.task.world.positions()
    lack = [
        load_capacity(course.task.robot, legs_of(course.task.robot), places, stance, sides)
        for stance, sides in zip(course.stances, course.elbows, strict=True)
    ]
    assert min(lack) > -2.5


def test_a_hook_on_a_peg_with_a_twin_has_the_twin_before_its_mouth(course: ExecutablePlan) -> None:
    """Well before its lips, whose corners are 42 deg to either side: wherever the two pegs are, the hook turns past neither."""
    robot, places = course.task.robot, course.task.world.positions()
    rows = {hold.number: place for hold, place in zip(course.task.world.holds, places, strict=True)}
    angles = []
    for step in range(len(course.stances)):
        for i, limb in enumerate(robot.limbs):
            number = course.holds(step)[limb.name]
            if number in TWINS:
                side = course.elbows[step, i]
                (on,) = (one for one in postures(limb, course.pose(step), rows[number]) if side * one.angles[1] > 0.0)
                to = rows[TWINS[number]] - rows[number]
                angles.append(math.acos(np.clip(on.grab @ to / np.hypot(*to), -1.0, 1.0)))
    assert angles and math.degrees(max(angles)) < 20.0
