"""Hooks that do not come off where a plan releases them: they are taken off where they were less turned."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from clamber.families.climber.execution import actor as actor_module
from clamber.families.climber.execution.actor import Actor
from clamber.families.climber.execution.climber import Climber
from clamber.families.climber.execution.executable_plan import ExecutablePlan, lay_course
from clamber.families.climber.execution.hold_map import HoldMap
from clamber.families.climber.trials.run_plan import climbing_task
from clamber.planning.problem.plan_source import open_plan

CIRCLE = Path(__file__).parents[2] / "examples" / "circle" / "plan.json"


def mapped(course: ExecutablePlan) -> HoldMap:
    """The holds of a course's board, known exactly."""
    return HoldMap({hold.number: np.array((hold.x, hold.y)) for hold in course.task.world.holds}, 0.0)


@pytest.fixture(scope="module")
def course() -> ExecutablePlan:
    opened = open_plan(CIRCLE)
    return lay_course(climbing_task(opened.task), opened.plan)


def moves_before(course: ExecutablePlan, step: int) -> int:
    """Of the body, since the limbs came to hold as they do before a step."""
    back = step - 1
    while back > 0 and course.holds(back - 1) == course.holds(step - 1):
        back -= 1
    return step - 1 - back


@pytest.mark.parametrize("comes_off", [0, 1, 2, None], ids=lambda at: f"after {at}")
def test_a_wedged_hook_is_tried_at_each_pose_back_with_the_same_holds(
    course: ExecutablePlan, monkeypatch: pytest.MonkeyPatch, comes_off: int | None
) -> None:
    step = next(k for k, a in enumerate(course.actions, 1) if a.kind == "release" and moves_before(course, k) >= 3)
    most, limb = moves_before(course, step), course.actions[step - 1].limb
    names = [one.name for one in course.task.robot.limbs]
    tasks = [SimpleNamespace(hold=course.holds(step - 1)[name], mode="stance") for name in names]
    body = SimpleNamespace(tasks=tasks, aim=course.pose(step - 1), settled=course.pose(step - 1))
    been: list[Any] = []
    tries = 0

    def release(_: Any, i: int) -> None:
        nonlocal tries
        if tries == comes_off:
            tasks[i].hold = 0
        tries += 1

    monkeypatch.setattr(actor_module, "release", release)
    monkeypatch.setattr(actor_module, "move_body", lambda _, pose: been.append(pose))
    actor = Actor(
        cast(Climber, SimpleNamespace(robot=course.task.robot, body=body, map=mapped(course), hangs=False)), course
    )
    outcome, count, why = actor.carry_out(step, step)
    back = most if comes_off is None else comes_off
    assert (outcome, count) == (("missed", 2) if comes_off is None else ("ok", 1 + (comes_off > 0)))
    assert ("wedged" in why) == (comes_off is None) and limb is not None
    assert tries == 1 + back
    there = [*range(step - 2, step - 2 - back, -1), *range(step - back, step)]
    assert len(been) == len(there)
    for pose, at in zip(been, there, strict=True):
        assert pose[:2] == pytest.approx(course.pose(at)[:2])
        assert np.cos(pose[2] - course.pose(at)[2]) == pytest.approx(1.0)
