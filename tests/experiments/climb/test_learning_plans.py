"""Plans that are searched for anew without the grabs that failed in rehearsal."""

from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np
import pytest

from clamber.errors import SpecError
from clamber.families.climber.execution.climb_report import ActionReport, ClimbReport
from clamber.families.climber.execution.executable_plan import lay_course
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.climber.trials.planning import PlanValidation, grab_at_fault, plan_to_climb
from clamber.families.climber.trials.planning_margins import STEADY, with_margins
from clamber.families.climber.trials.run_plan import climbing_task
from clamber.planning.planners import find_planner
from clamber.planning.problem.plan import Plan
from clamber.planning.problem.plan_source import open_plan
from clamber.tasks import load_task

EXAMPLES: Final = Path(__file__).parents[3] / "examples"


def grabs(plan: Plan) -> set[tuple[str | None, int | None]]:
    return {(action.limb, action.hold) for action in plan.actions if action.kind == "grab"}


def ended_at(step: int) -> ClimbReport:
    return ClimbReport([ActionReport(step, step, "", "", "fell", 0.0, 1.0, 1, 0.0, None, None)])


def test_a_climb_went_wrong_with_the_grab_that_failed_or_the_one_that_led_there() -> None:
    plan = open_plan("ladder-hand").plan
    steps = [step for step, action in enumerate(plan.actions, 1) if action.kind == "grab"]
    assert grab_at_fault(plan, ended_at(steps[1])) == steps[1]
    move = next(step for step in range(steps[1], len(plan.actions)) if plan.actions[step - 1].kind == "move")
    assert grab_at_fault(plan, ended_at(move)) == max(step for step in steps if step < move)
    first = next(step for step, action in enumerate(plan.actions, 1) if action.kind == "release" and step > steps[2])
    own = [step for step in steps if step < first and plan.actions[step - 1].limb == plan.actions[first - 1].limb]
    assert grab_at_fault(plan, ended_at(first)) == own[-1]
    assert grab_at_fault(plan, ClimbReport()) is None


@pytest.mark.slow
def test_a_limb_never_takes_a_hold_that_is_barred_to_it() -> None:
    task = climbing_task(load_task("ladder"))
    free = find_planner("beam")(task, seconds=60.0).plan
    limb, hold = next((action.limb, action.hold) for action in free.actions if action.kind == "grab")
    assert limb is not None and hold is not None
    barred = climbing_task(load_task("ladder", [f"rules.barred.{limb}=[{hold}]"]))
    result = find_planner("beam")(barred, seconds=60.0)
    assert result.has_plan
    assert (limb, hold) not in grabs(result.plan)


def test_nothing_speaks_against_the_plan_for_the_circle_under_the_rules_that_can_be_carried_out() -> None:
    opened = open_plan(EXAMPLES / "circle" / "plan.json")
    assert lay_course(climbing_task(opened.task), opened.plan).objections == ()


def test_bars_name_limbs_and_holds_that_there_are() -> None:
    with pytest.raises(SpecError, match=r"rules\.barred\.tail"):
        load_task("ladder", ["rules.barred.tail=[1]"])
    with pytest.raises(SpecError, match="does not have"):
        load_task("ladder", ["rules.barred.left=[99]"])


def test_cautions_bar_holds_besides_those_of_the_task() -> None:
    task = climbing_task(load_task("ladder", ["rules.barred.left=[7]"]))
    more = with_margins(task, replace(STEADY[0], barred=(("left", 9), ("right", 8))))
    assert {name: set(numbers) for name, numbers in more.rules.barred.items()} == {"left": {7, 9}, "right": {8}}


@pytest.mark.slow
def test_a_grab_that_failed_is_made_elsewhere_and_then_done_without() -> None:
    task = climbing_task(load_task("ladder"))
    tried: list[Plan] = []

    def first_grab(plan: Plan) -> int:
        return next(step for step, action in enumerate(plan.actions, 1) if action.kind == "grab")

    def stumbles(task: LimbedTask, plan: Plan) -> PlanValidation:
        tried.append(plan)
        lost = tried[1] if len(tried) > 1 else plan  # the first is of those that are easy: no lessons
        grab = lost.actions[first_grab(lost) - 1]
        if (grab.limb, grab.hold) not in grabs(plan):
            return PlanValidation(3, 1.0)
        step = next(
            s for s, a in enumerate(plan.actions, 1) if (a.kind, a.limb, a.hold) == ("grab", grab.limb, grab.hold)
        )
        return PlanValidation(0, 0.1, step)

    plan = plan_to_climb(task, "auto", seconds=60.0, seed=0, threads=1, validate_plan=stumbles)
    assert plan is tried[-1] and len(tried) >= 3
    for again in tried[2:-1]:  # the same actions in another order
        assert Counter(again.codes(task).tolist()) == Counter(tried[1].codes(task).tolist())
        assert not np.array_equal(again.codes(task), tried[1].codes(task))
