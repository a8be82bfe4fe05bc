"""Grabs to which a limb would find no way, told before anything moves."""

import math
from pathlib import Path

import numpy as np
import pytest

from clamber.families.climber.execution.executable_plan import ExecutablePlan, lay_course
from clamber.families.climber.execution.swing_feasibility import grabs_without_way
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.climber.trials.noise import Noise
from clamber.families.climber.trials.planning_margins import PLANNING_MARGINS, with_margins
from clamber.families.climber.trials.run_plan import climbing_flaws, climbing_task, run_plan
from clamber.planning.planners import find_planner
from clamber.planning.problem.plan import Plan
from clamber.planning.problem.plan_source import open_plan
from clamber.tasks import load_task

EXAMPLES = Path(__file__).parents[2] / "examples"
ERROR = 0.00635


def course_of(what: str | Path) -> ExecutablePlan:
    opened = open_plan(what)
    return lay_course(climbing_task(opened.task), opened.plan)


@pytest.mark.parametrize(
    "what",
    [
        "ladder-hand",
        EXAMPLES / "across" / "plan.json",
        pytest.param(EXAMPLES / "circle" / "plan.json", marks=pytest.mark.slow),
    ],
    ids=str,
)
def test_plans_that_climb_have_ways_to_all_that_they_grab(what: str | Path) -> None:
    assert grabs_without_way(course_of(what), ERROR) == []


def ringed(number: int, radius: float) -> LimbedTask:
    """The ladder with a ring of pegs about one of its own."""
    task = climbing_task(load_task("ladder"))
    hold = next(hold for hold in task.world.holds if hold.number == number)
    pegs = ", ".join(
        f'{{number={900 + k}, x="{hold.x + radius * math.cos(angle)} m", y="{hold.y + radius * math.sin(angle)} m"}}'
        for k, angle in enumerate(np.arange(0.0, math.tau, math.tau / 10))
    )
    return climbing_task(load_task("ladder", [f"board.added=[{pegs}]"]))


@pytest.mark.parametrize(("radius", "blocked"), [(0.045, True), (2.0, False)])
def test_pegs_where_a_hook_comes_from_leave_it_no_way(radius: float, blocked: bool) -> None:
    opened = open_plan("ladder-hand")
    codes = opened.plan.codes(opened.task)[:12]
    grabs = [step for step, action in enumerate(opened.plan.actions, 1) if action.kind == "grab"]
    hold = opened.plan.actions[grabs[0] - 1].hold
    assert hold is not None
    task = ringed(hold, radius)
    told = grabs_without_way(lay_course(task, Plan.of_codes(task, codes)), ERROR)
    assert (grabs[0] in told) == blocked


@pytest.mark.long
def test_what_has_no_way_on_paper_is_missed_in_climbs() -> None:
    """The shortest cautious plan for H: its forces are easy, and a third of its climbs miss one grab."""
    task = climbing_task(load_task("h"))
    found = find_planner("exact")(with_margins(task, PLANNING_MARGINS[0]))
    plan = Plan.of_codes(task, found.plan.codes(task))
    blocked = grabs_without_way(lay_course(task, plan), ERROR)
    assert len(blocked) == 1
    flaws, noise = climbing_flaws(task, ()), Noise.of("usual")
    reports = [run_plan(task, plan, flaws, noise=noise, seed=seed).report for seed in range(5001, 5007)]
    missed = [report.actions[-1].first for report in reports if "finds no way" in report.reason]
    assert missed and set(missed) == set(blocked)


@pytest.mark.slow
def test_it_is_the_same_each_time() -> None:
    opened = open_plan("ladder-hand")
    task = ringed(10, 0.12)
    course = lay_course(task, Plan.of_codes(task, opened.plan.codes(opened.task)))
    told = [grabs_without_way(course, ERROR) for _ in range(2)]
    assert told[0] == told[1]
    assert np.all(np.diff(told[0]) > 0)
