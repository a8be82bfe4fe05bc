"""Another way on from somewhere in a plan: what comes before stays, and doubtful grabs are done without."""

from functools import cache

import numpy as np
import pytest

from clamber.families.climber.execution.executable_plan import lay_course
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.climber.trials.planning_margins import PLANNING_MARGINS, with_margins
from clamber.families.climber.trials.rerouting import (
    LACK,
    cut_before,
    doubtful_grabs,
    grabs_of,
    other_end,
    repaired,
    without,
)
from clamber.families.climber.trials.run_plan import climbing_task
from clamber.planning.planners import find_planner
from clamber.planning.problem.plan import Plan
from clamber.planning.problem.problems import plan_family
from clamber.tasks import load_task


@cache
def found(name: str, planner: str = "beam") -> tuple[LimbedTask, Plan]:
    task = climbing_task(load_task(name))
    result = find_planner(planner)(with_margins(task, PLANNING_MARGINS[0]))
    return task, Plan.of_codes(task, result.plan.codes(task))


def steps_of_grabs(plan: Plan) -> list[int]:
    return [step for step, action in enumerate(plan.actions, 1) if action.kind == "grab"]


@pytest.mark.slow
@pytest.mark.parametrize("back", [1, 3])
def test_another_end_keeps_what_comes_before_and_does_without_the_grab(back: int) -> None:
    task, plan = found("ladder")
    step = steps_of_grabs(plan)[5]
    grab, cut = plan.actions[step - 1], cut_before(plan, step, back)
    assert plan.actions[cut].kind == "grab"
    assert sum(action.kind == "grab" for action in plan.actions[cut : step - 1]) == back
    made = other_end(lay_course(task, plan), plan, step, back, without(PLANNING_MARGINS[0], plan, step), 60.0)
    assert made is not None
    codes = made.codes(task)
    assert np.array_equal(codes[:cut], plan.codes(task)[:cut])
    assert all((one.limb, one.hold) != (grab.limb, grab.hold) for one in made.actions[cut:])
    problem = plan_family(task).problem(task)
    replay = problem.replay(codes)
    assert replay.ok and problem.is_done(replay.stances[-1:])


def test_a_cut_before_the_first_grab_is_the_start() -> None:
    _, plan = found("ladder")
    assert cut_before(plan, steps_of_grabs(plan)[0], 1) == 0
    assert cut_before(plan, steps_of_grabs(plan)[2], 9) == 0


def test_limbs_hold_by_the_grabs_that_they_made_last() -> None:
    task, plan = found("ladder")
    course = lay_course(task, plan)
    for step in range(1, len(plan.actions) + 1):
        steps = grabs_of(course, step)
        assert steps == sorted(steps, reverse=True)
        holds = course.holds(step)
        for at in steps:
            grab = plan.actions[at - 1]
            assert grab.limb is not None and holds[grab.limb] == grab.hold
            assert all(one.limb != grab.limb or one.kind == "move" for one in plan.actions[at:step])


@pytest.mark.slow
def test_a_plan_without_doubts_is_not_mended() -> None:
    task, plan = found("ladder")
    assert doubtful_grabs(lay_course(task, plan)) == []
    assert repaired(task, plan, PLANNING_MARGINS[0], 60.0) is plan


@pytest.mark.slow
def test_hooks_that_lack_what_is_wished_put_the_grab_in_doubt(monkeypatch: pytest.MonkeyPatch) -> None:
    """With a wish that no stance meets, every grab is in doubt."""
    task, plan = found("ladder")
    monkeypatch.setattr("clamber.families.climber.trials.rerouting.LACK", -1e9)
    course = lay_course(task, plan)
    assert LACK > 0.0
    assert doubtful_grabs(course) == steps_of_grabs(plan)


@pytest.mark.long
def test_the_plan_for_h_loses_its_doubtful_grab() -> None:
    task, plan = found("h", "exact")
    doubtful = doubtful_grabs(lay_course(task, plan))
    assert doubtful
    made = repaired(task, plan, PLANNING_MARGINS[0], 60.0)
    assert made is not None
    assert doubtful_grabs(lay_course(task, made)) == []
    cut = cut_before(plan, doubtful[0], 4)
    assert np.array_equal(made.codes(task)[:cut], plan.codes(task)[:cut])
