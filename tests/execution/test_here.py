"""The task that is left where a plan went wrong, on the board without what could not be got."""

from pathlib import Path

import pytest

from clamber.actions.plan import load_plan
from clamber.execution.climb.course import Course, lay_course
from clamber.execution.climb.here import task_from_here
from clamber.experiments.climb.run_plan import climbing_task
from clamber.tasks import load_task
from clamber.tasks.limbed import LimbedTask

SAVED = Path(__file__).parents[2] / "examples" / "across" / "plan.json"


def across(*settings: str) -> Course:
    task = climbing_task(load_task("across-hanging", settings))
    assert isinstance(task, LimbedTask)
    return lay_course(task, load_plan(SAVED))


@pytest.mark.parametrize("missed", [set(), {29}, {24, 30}, {3}])
def test_rules_and_board_forget_a_hold_that_could_not_be_got(missed: set[int]) -> None:
    course = across()
    barred = set(course.task.rules.barred["bottom"])
    assert {24, 29, 30} <= barred
    left = task_from_here(course, 1, course.holds(0), missed)
    assert {hold.number for hold in left.world.holds} == {hold.number for hold in course.task.world.holds} - missed
    assert set(left.rules.barred["bottom"]) == barred - missed
    assert course.task.rules.barred["bottom"] == tuple(sorted(barred))  # the task itself stays as it is


def test_a_hold_that_the_robot_is_on_or_a_goal_asks_for_stays() -> None:
    course = across("goal.holds.right=29")
    on = course.holds(0)
    left = task_from_here(course, 1, on, {29, 28, *on.values()})
    assert {hold.number for hold in course.task.world.holds} - {hold.number for hold in left.world.holds} == {28}
