"""Plans that are to be carried out: the same on any number of threads, and told where time ended a search."""

import math
import sys
from dataclasses import replace
from typing import Any

import pytest

from clamber.families.climber.execution.executable_plan import climbable
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.climber.trials.planning import plan_to_climb, replanner
from clamber.families.climber.trials.planning_margins import PLANNING_MARGINS, STEADY
from clamber.planning.planners import PLANNERS, BuiltIn, find_planner
from clamber.planning.result import PlanResult
from clamber.tasks import Task, load_task
from clamber.trials.dynamics import RunEvents


def climb_of(name: str) -> LimbedTask:
    task = load_task(name)
    assert isinstance(task, LimbedTask)
    return climbable(task)


@pytest.mark.parametrize("name", ["ladder", "overhang"])
def test_the_plan_is_the_same_on_any_number_of_threads(name: str) -> None:
    task, cuts = climb_of(name), []
    plans = [
        plan_to_climb(
            task, "auto", seconds=math.inf, seed=0, threads=threads, events=RunEvents(cut=lambda: cuts.append(1))
        )
        for threads in (1, 2, 4, None)
    ]
    told = [None if plan is None else plan.to_json() for plan in plans]
    assert told[0] is not None
    assert told == [told[0]] * 4
    assert not cuts


@pytest.mark.parametrize(("took", "cuts"), [(4.9, 0), (5.0, 1 + len(PLANNING_MARGINS + STEADY))])
def test_every_search_that_its_time_ended_is_told(took: float, cuts: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """A search that finds nothing and has taken all its seconds was ended by them: then another machine may find a plan."""
    given: list[dict[str, Any]] = []
    task = climb_of("ladder")
    known = find_planner("greedy")(task, seconds=0.0)

    def slow(task: Task, *, seed: int = 0, seconds: float | None = None, threads: int | None = None) -> PlanResult:
        given.append({"seed": seed, "seconds": seconds, "threads": threads})
        return replace(known, status="stopped", seconds=took)

    monkeypatch.setattr(sys.modules[__name__], "slow", slow, raising=False)
    monkeypatch.setitem(PLANNERS, "slow", BuiltIn(f"{__name__}:slow", "", "replay"))
    told: list[int] = []
    replan = replanner("slow", seconds=5.0, seed=7, threads=1, events=RunEvents(cut=lambda: told.append(1)))
    assert replan(task) is None
    assert len(told) == cuts
    assert given == [{"seed": 7, "seconds": 5.0, "threads": 1}] * (1 + len(PLANNING_MARGINS + STEADY))
