"""Grabs from a hang: the hook comes home on a hold that it comes to from the side, and a try that missed does as little harm as can be."""

import copy
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from clamber.actions.plan import Plan, load_plan
from clamber.execution.climb import hook
from clamber.execution.climb.approach import Approach
from clamber.execution.climb.climber import Climber
from clamber.execution.climb.course import Course, lay_course
from clamber.execution.climb.here import task_from_here
from clamber.execution.climb.sequencer import Sequencer
from clamber.experiments.climb.noise import draw_for
from clamber.experiments.climb.plants import drawn_plant
from clamber.experiments.climb.rehearsal import REHEARSED
from clamber.experiments.climb.run_plan import believing_climber, climbing_flaws, climbing_task
from clamber.tasks import load_task, task_from_document
from clamber.types import Floats

ROOT = Path(__file__).parents[2]
RIGHT, LEFT = 0, 1
BEFORE = 137
"""Step of the saved plan that brings the body below the right limb's hold: four moves, then the left limb grabs 8 in farther on."""


@pytest.fixture(scope="module")
def single_row() -> Course:
    task = climbing_task(load_task("across-hanging"))
    whole = load_plan(ROOT / "examples" / "across" / "plan.json")
    course = lay_course(task, whole)
    document = copy.deepcopy(task_from_here(course, BEFORE, course.holds(BEFORE - 1), set()).document)
    document.pop("subgoals")  # it is beyond them
    here = climbing_task(task_from_document(document, "on the single row"))
    course = lay_course(here, Plan.of_codes(here, whole.codes(task)[BEFORE - 1 : BEFORE + 4], planner="beam"))
    assert not course.objections
    assert course.actions[-1].title == "left grabs 28"
    return course


@pytest.mark.parametrize("seed", [2, 13])
def test_a_hook_that_comes_from_the_side_to_a_hanging_body_comes_home(single_row: Course, seed: int) -> None:
    task = single_row.task
    drawn = draw_for(task, REHEARSED, seed)
    plant = drawn_plant(task, climbing_flaws(task, ()), drawn)
    climber = believing_climber(task, plant, REHEARSED, drawn)
    report = Sequencer(climber, single_row).run()
    taken = report.actions[-1]
    assert (taken.title, taken.outcome, taken.tries) == ("left grabs 28", "ok", 1), report.reason
    pegs = {
        hold.number: place for hold, place in zip(task.world.holds, task.world.positions() + drawn.pegs, strict=True)
    }
    tips = plant.truth().tips
    # on its peg, not on the flare before it, 8 to 16 mm off
    for limb, number in ((RIGHT, 26), (LEFT, 28)):
        assert tips[limb] == pytest.approx(pegs[number], abs=3e-3), (limb, number)
    # and the map has learned from no false seat
    learned = (climber.holds[28] - climber.holds[26]) - (pegs[28] - pegs[26])
    assert np.hypot(*learned) < 5e-3


@pytest.mark.parametrize("past", [-0.006, 0.02, 0.035])
@pytest.mark.parametrize("aside", [-0.02, 0.0, 0.02])
def test_a_hook_that_missed_goes_back_the_way_it_came(
    monkeypatch: pytest.MonkeyPatch, past: float, aside: float
) -> None:
    g, hold = np.array((-0.6, 0.8)), np.array((1.0, 0.5))
    h = np.array((-g[1], g[0]))
    places: list[Floats] = []
    monkeypatch.setattr(hook, "move_tip", lambda climber, i, place, seconds: places.append(place))
    monkeypatch.setattr(hook, "stand_off_of", lambda climber, i, doubt: 0.05)
    tip = hold + past * g + aside * h
    climber = SimpleNamespace(body=SimpleNamespace(tip=cast("Callable[[int], Floats]", lambda i: tip)))
    found = Approach(np.zeros(2), np.zeros((1, 2)), g, 0.05)
    hook.back_off(cast(Climber, climber), LEFT, hold, 0.004, found)
    before = [tip, *places]
    for start, end in pairwise(before):
        along, across = (end - start) @ g, (end - start) @ h
        deep = max((start - hold) @ g, (end - hold) @ g)
        # beside or beyond the hold only straight back; across only where the whole hook is before it
        assert (abs(across) < 1e-12 and along < 0.0) or deep == pytest.approx(-0.05)
    assert places[-1] == pytest.approx(hold - 0.05 * g)
