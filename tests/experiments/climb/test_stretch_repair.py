"""Grabs made where the limbs that hold are least stretched: the same actions, and every rule still kept."""

from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from clamber.errors import SpecError
from clamber.families.climber.execution.executable_plan import lay_course
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.climber.trials.run_plan import climbing_task
from clamber.families.climber.trials.stretch_repair import BENT, SHIFT, WORTH, steadied_result, with_stretch_repaired
from clamber.planning.planners import find_planner
from clamber.planning.problem.codes import HOLD
from clamber.planning.problem.plan import Plan
from clamber.planning.problem.plan_source import open_plan
from clamber.planning.problem.problems import normalisation_of, plan_family
from clamber.planning.shorten import polish_plan
from clamber.tasks import load_task
from clamber.types import Floats, Ints


def room(task: LimbedTask, codes: Ints) -> Floats:
    """What limbs leave of reach and joint ranges after every action, as shares of these."""
    sticks = normalisation_of(task)
    replay = plan_family(task).problem(task).replay(codes)
    assert replay.ok
    shares = [
        replay.margins[:, i] / sticks.sizes[check.name] for i, check in enumerate(sticks.checks) if check.name in BENT
    ]
    return np.min(shares, axis=0)


def steps_of_grabs(codes: Ints) -> list[int]:
    return [int(at) + 1 for at in np.flatnonzero(codes >> SHIFT == HOLD)]


@pytest.fixture(scope="module", params=["ladder", "h", "modified-ladder"])
def found(request: pytest.FixtureRequest) -> tuple[LimbedTask, Plan]:
    task = climbing_task(load_task(request.param))
    return task, find_planner("beam")(task, seconds=120.0).plan


@pytest.mark.slow
def test_a_steadied_plan_has_the_same_actions_and_ends_in_the_same_stance(found: tuple[LimbedTask, Plan]) -> None:
    task, plan = found
    codes = plan.codes(task)
    problem = plan_family(task).problem(task)
    for step in steps_of_grabs(codes):
        made = with_stretch_repaired(task, codes, step)
        assert Counter(made.tolist()) == Counter(codes.tolist())
        before, after = problem.replay(codes), problem.replay(made)
        assert before.ok and after.ok
        for key in ("x", "y", "angle", "hold"):
            assert np.array_equal(before.stances[-1][key], after.stances[-1][key])


def test_the_grab_that_is_steadied_gains_and_nothing_comes_nearer_to_a_limit(found: tuple[LimbedTask, Plan]) -> None:
    task, plan = found
    codes = plan.codes(task)
    before = room(task, codes)
    for turn, step in enumerate(steps_of_grabs(codes)):
        made = with_stretch_repaired(task, codes, step)
        after = room(task, made)
        new = steps_of_grabs(made)[turn]
        assert made[new - 1] == codes[step - 1]
        assert new == step or after[new - 1] >= before[step - 1] + WORTH
        assert after.min() >= before.min() - 1e-12


def test_a_grab_is_made_before_the_step_that_stretches_the_limbs() -> None:
    opened = open_plan(Path(__file__).parents[3] / "examples" / "circle" / "plan.json")
    task = climbing_task(opened.task)
    codes = opened.plan.codes(task)
    assert [action.title for action in opened.plan.actions[89:91]] == ["right grabs 5", "+y"]
    later = codes.copy()
    later[89:91] = codes[90], codes[89]
    assert np.array_equal(with_stretch_repaired(task, later, 91), codes)


def test_a_plan_that_does_not_hold_stays_as_it_is() -> None:
    opened = open_plan("h-hand")
    task = climbing_task(opened.task)
    codes = opened.plan.codes(task)
    assert lay_course(task, opened.plan).objections
    assert np.array_equal(with_stretch_repaired(task, codes, steps_of_grabs(codes)[0]), codes)


def test_a_steadied_result_can_be_carried_out_and_says_what_was_done(found: tuple[LimbedTask, Plan]) -> None:
    task, plan = found
    polished = polish_plan(task, plan, width=0, effort=0)
    for step in steps_of_grabs(plan.codes(task)):
        result = steadied_result(polished, step)
        assert lay_course(task, result.plan).objections == ()
        moved = result.plan.actions != plan.actions
        assert result.planner == f"{plan.planner}{', steadied' * moved}" == result.plan.planner
        assert ("made elsewhere" if moved else "where it is steadiest") in result.reason


def test_only_grabs_are_steadied(found: tuple[LimbedTask, Plan]) -> None:
    task, plan = found
    polished = polish_plan(task, plan, width=0, effort=0)
    grabs = steps_of_grabs(plan.codes(task))
    for step in (0, len(plan.actions) + 1, next(s for s in range(1, len(plan.actions)) if s not in grabs)):
        with pytest.raises(SpecError, match=f"one of {grabs[0]}, "):
            steadied_result(polished, step)


def test_a_walker_has_no_grabs_to_steady() -> None:
    result = find_planner("greedy")(load_task("patch-walk"), seconds=120.0)
    assert result.has_plan
    with pytest.raises(SpecError, match="must be a limbed climber"):
        steadied_result(result, 1)
