"""Plans rehearsed before they are climbed: the easiest that is carried out each time is taken."""

import math
from itertools import count
from types import SimpleNamespace

import pytest

from clamber.families.climber.planning.task import LimbedTask
from clamber.families.climber.trials.noise import Noise
from clamber.families.climber.trials.planning import QUIET, SEEDS, PlanValidation, plan_to_climb, validations
from clamber.families.climber.trials.run_plan import climbing_flaws, climbing_task
from clamber.planning.problem.plan import Plan
from clamber.planning.problem.plan_source import open_plan
from clamber.trials.dynamics import RunEvents


@pytest.mark.slow
def test_a_plan_is_climbed_by_as_often_as_it_is_carried_out() -> None:
    opened = open_plan("ladder-hand")
    task = climbing_task(opened.task)
    few = Plan.of_codes(task, opened.plan.codes(task)[:3], planner="hand")
    assert validations(climbing_flaws(task, ()), QUIET)(task, few) == PlanValidation(len(SEEDS), 1.0)
    lost = validations(climbing_flaws(task, ()), QUIET, Noise.of("none", ("peg_error=30mm",)))(task, opened.plan)
    assert lost.climbed == 0 and lost.share < 1.0


def test_rehearsals_are_told_apart_by_climbs_then_by_how_far_they_came() -> None:
    assert PlanValidation(len(SEEDS), 1.0).flawless and not PlanValidation(len(SEEDS) - 1, 1.0).flawless
    assert PlanValidation(1, 0.2) > PlanValidation(0, 0.9) > PlanValidation(0, 0.3)


def test_each_search_after_the_first_is_told_with_what_it_is_for(monkeypatch: pytest.MonkeyPatch) -> None:
    opened = open_plan("ladder-hand")
    task = climbing_task(opened.task)
    grab = next(step for step, action in enumerate(opened.plan.actions, 1) if action.kind == "grab")
    searches, notes = count(), list[str]()
    rehearsals = iter((PlanValidation(2, 0.9), PlanValidation(0, 0.5, grab), PlanValidation(len(SEEDS), 1.0)))

    def planner(task: LimbedTask, seconds: float) -> SimpleNamespace:
        return SimpleNamespace(has_plan=next(searches) > 0, plan=opened.plan, seconds=0.0)

    monkeypatch.setattr("clamber.planning.beam.plan_beam", planner)
    monkeypatch.setattr("clamber.families.climber.trials.planning.repaired", lambda *_: None)
    monkeypatch.setattr(
        "clamber.families.climber.trials.planning.with_stretch_repaired", lambda task, codes, failed: codes
    )
    events = RunEvents(note=notes.append)
    assert plan_to_climb(
        task, "beam", seconds=1.0, seed=0, events=events, validate_plan=lambda task, plan: next(rehearsals)
    )
    again = "searching for a plan again, as "
    assert notes == [
        f"{again}none that keeps so much in reserve can be carried out",
        f"{again}no rehearsal was without a failure",
        f"{again}the rehearsal failed at step {grab}, {opened.plan.actions[grab - 1].title}",
    ]


@pytest.mark.long
def test_every_candidate_may_be_asked_for_and_the_one_that_does_best_is_taken() -> None:
    asked: list[Plan] = []

    def fails(task: LimbedTask, plan: Plan) -> PlanValidation:
        asked.append(plan)
        return PlanValidation(0, 0.5)

    task = climbing_task(open_plan("ladder-hand").task)
    plan = plan_to_climb(task, "auto", seconds=math.inf, seed=0, threads=1, validate_plan=fails)
    assert asked and plan is asked[0]
