"""The fifteen scenes of Climb-SDK, restated, and tasks of several goals."""

from typing import Any

import numpy as np
import pytest

from clamber.families.spatial.planning.problem import SpatialProblem
from clamber.planning.beam import plan_beam
from clamber.tasks import load_task, task_names

SCENES = tuple(name for name in task_names() if name.startswith("scene-"))


def test_there_are_fifteen_scenes() -> None:
    assert len(SCENES) == 15


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_every_scene_is_planned_and_every_margin_holds(name: str) -> None:
    found = plan_beam(load_task(name), width=60)
    assert found.has_plan, found.reason
    verdict = found.check()
    assert verdict.ok and verdict.goals_met == verdict.goals


def test_progress_does_not_fall_where_a_goal_is_met() -> None:
    """Each goal is entered where it is nearest the one before, and what lies behind it counts only from there."""
    task: Any = load_task("scene-bend")
    problem = SpatialProblem(task, 1)
    ways = problem.params.array("goals")["way"]  # type: ignore[call-overload]
    assert ways == pytest.approx([0.9, 0.9 + 1.6, 0.9 + 1.6 + np.hypot(0.4, 0.8)])
    stances = np.repeat(problem.start, 6)
    stances["x"], stances["y"] = (0.0, 0.0, 0.0, 0.8, 1.6, 2.0), (0.0, -0.9, -0.9, -0.9, -0.9, -0.1)
    stances["stage"] = (0, 0, 1, 1, 1, 2)
    body = problem.measured(stances)[:, problem.features.index("body")]
    assert body == pytest.approx([0.0, 0.9, 0.9, 1.7, 2.5, ways[-1]])
    assert problem.way == pytest.approx(ways[-1])


def test_a_push_on_the_body_has_to_be_borne() -> None:
    """The start's wrenches add up to weight and push."""
    push = np.array((0.0, 3.0, 0.0))
    task: Any = load_task("scene-wall", ["rules.push=['0 N', '3 N', '0 N']"])
    stance = SpatialProblem(task, 1, exact=True).replay([0]).stances[-1]
    weight = task.robot.chains.total_mass * np.array(task.world.gravity)
    assert stance["wrench"][:, :3].sum(axis=0) == pytest.approx(-(weight + push), abs=1e-6)
