"""The task that is left where a plan went wrong, on the board without what could not be got."""

from pathlib import Path

import pytest

from clamber.families.climber.execution.executable_plan import ExecutablePlan, lay_course
from clamber.families.climber.execution.remaining_task import task_from_here
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.climber.trials.run_plan import climbing_task
from clamber.planning.problem.plan import load_plan
from clamber.planning.problem.problems import plan_family
from clamber.tasks import load_task

EXAMPLES = Path(__file__).parents[2] / "examples"
SAVED = EXAMPLES / "across" / "plan.json"


def across(*settings: str) -> ExecutablePlan:
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


@pytest.mark.parametrize(("name", "saved"), [("circle", "circle"), ("across-hanging", "across")])
def test_what_is_left_of_a_plan_is_a_plan_for_what_is_left_of_its_task(name: str, saved: str) -> None:
    """Sub-goals that were met stay met, turns count on, and a limb that moved last still carries nothing."""
    task = climbing_task(load_task(name))
    plan = load_plan(EXAMPLES / saved / "plan.json")
    course = lay_course(task, plan)
    codes = plan.codes(task)
    goals = set()
    for step in range(1, len(codes) + 1, 7):
        left = task_from_here(course, step, course.holds(step - 1), set())
        problem = plan_family(left).problem(left)
        replay = problem.replay(codes[step - 1 :])
        assert replay.ok, (step, replay.reasons)
        assert problem.is_done(replay.stances[-1:])
        assert not problem.is_done(replay.stances[:1])
        goals.add(len(left.goals))
    assert goals == set(range(1, len(task.goals) + 1))
