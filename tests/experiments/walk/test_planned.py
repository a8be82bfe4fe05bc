"""Planned walks: with room to spare, refused where a check is violated, and carried out in contact dynamics."""

import math

import numpy as np
import pytest

from clamber.errors import SpecError
from clamber.families.walker.planning.task import WalkerTask
from clamber.families.walker.trials.planned import careful, lay_plan, walk_of
from clamber.families.walker.trials.run_walk import run_walk, walk_flaws
from clamber.planning.planners import plan_task
from clamber.planning.problem.codes import MOVE, pack
from clamber.planning.problem.plan import Plan
from clamber.tasks import load_task
from clamber.trials.work import open_work


def load(*changes: str) -> WalkerTask:
    task = load_task("terrace-walk", changes)
    assert isinstance(task, WalkerTask)
    return task


def test_a_careful_task_asks_for_more_room() -> None:
    task = careful(load("rules.balance=5 cm"))
    assert task.rules.balance == pytest.approx(0.05)
    assert task.rules.clearance == pytest.approx(0.02)
    assert task.rules.stroke == pytest.approx(0.006)
    assert task.robot.mechanism.guard == pytest.approx(0.78)


def test_a_plan_that_violates_a_check_is_refused_with_the_step() -> None:
    task = load()
    plan = Plan.of_codes(task, np.full(30, pack(MOVE, 0, 0), np.int32), planner="none")
    with pytest.raises(SpecError, match=r"actions.*stroke"):
        lay_plan(task, plan)


def test_what_is_carried_out_is_opened_with_its_family() -> None:
    assert open_work("ladder").family.name == "limbed"
    climb = open_work("ladder-hand", None, ("plant.backlash=1deg",))
    assert climb.plan is not None and climb.plant == ("backlash=1deg",)
    opened = open_work("terrace-walk", None, ("start.payload=1 kg",))
    assert opened.family.name == "walker" and opened.item.start.payload == 1.0 and opened.plan is None
    assert open_work("level-walk").item.name == "level-walk"
    with pytest.raises(SpecError, match="--task"):
        open_work("terrace-walk", "patch-walk")


@pytest.mark.slow
def test_a_planned_walk_steps_onto_a_terrace() -> None:
    terrace = "ground.blocks=[{x_min='62 cm', x_max='2 m', y_min='-2 m', y_max='2 m', height='4 cm'}]"
    task = careful(load("goal={x_min='50 cm'}", "start.x=25 cm", terrace))
    result = plan_task(task, "auto")
    assert result.has_plan, result.reason
    walk = walk_of(task)
    run = run_walk(walk, walk_flaws(walk, ()), lay=lay_plan(task, result.plan))
    assert run.done, run.reason
    assert run.report.missed is not None
    assert run.report.missed[0] < 0.005 and run.report.missed[1] < math.radians(0.5)
    assert math.degrees(run.tilt) < 0.1
    assert run.margin > 0.02
    assert run.true.pose[-1, 0] > 0.49
    assert run.true.feet[-1, ..., 2].max() > 0.03  # a foot stands on the terrace
