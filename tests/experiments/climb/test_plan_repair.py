"""Plans that are made surer by rehearsals: what is changed, and when a change is kept."""

from collections.abc import Callable, Sequence

import numpy as np
import pytest

from clamber.families.climber.execution.executable_plan import lay_course
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.climber.trials.plan_repair import Climbs, Lesson, ValidatedPlan, learn
from clamber.families.climber.trials.planning_margins import PLANNING_MARGINS, with_margins
from clamber.families.climber.trials.run_plan import climbing_task
from clamber.families.climber.trials.trial import ClimbTrial
from clamber.planning.planners import find_planner
from clamber.planning.problem.plan import Plan
from clamber.tasks import load_task

SEEDS = range(40, 48)


@pytest.fixture(scope="module")
def climb() -> tuple[LimbedTask, Plan]:
    task = climbing_task(load_task("ladder"))
    return task, Plan.of_codes(task, find_planner("beam")(with_margins(task, PLANNING_MARGINS[0])).plan.codes(task))


def trial(seed: int, step: int, *, done: bool) -> ClimbTrial:
    return ClimbTrial(
        seed=seed, done=done, outcome="ok" if done else "fell", step=step, kind="grab", limb="left", reason="",
        seconds=1.0, short=0.0, pushes=1, grabs=1, stalled=0, replans=0, recovered=0, drawn={},
    )  # fmt: skip


def falls_at(limb: str | None, hold: int | None, unlucky: Callable[[int], bool]) -> Climbs:
    """Climbs that fail as a limb takes a hold, with some seeds."""

    def climbs(plan: Plan, seeds: Sequence[int]) -> list[ClimbTrial]:
        step = next((s for s, a in enumerate(plan.actions, 1) if (a.kind, a.limb, a.hold) == ("grab", limb, hold)), 0)
        return [trial(seed, step or len(plan.actions), done=not (step and unlucky(seed))) for seed in seeds]

    return climbs


@pytest.mark.slow
def test_what_fails_is_done_without_and_what_came_before_stays(climb: tuple[LimbedTask, Plan]) -> None:
    task, plan = climb
    grabs = [step for step, action in enumerate(plan.actions, 1) if action.kind == "grab"]
    step = grabs[6]
    grab = plan.actions[step - 1]
    told: list[tuple[ValidatedPlan, Lesson | None]] = []
    best = learn(
        task, plan, falls_at(grab.limb, grab.hold, lambda seed: seed % 2 == 0), SEEDS, lessons=12, seconds=60.0,
        told=lambda best, lesson: told.append((best, lesson)),
    )  # fmt: skip
    assert told[0][1] is None and told[0][0].climbed == 4
    assert list(told[0][0].faults) == [step] and told[0][0].faults[step] == [40, 42, 44, 46]
    assert best.climbed == len(SEEDS) and not best.faults
    assert [lesson.taken for _, lesson in told if lesson is not None].count(True) == 1
    assert told[-1][1] is not None and told[-1][1].taken
    assert all((one.limb, one.hold) != (grab.limb, grab.hold) for one in best.plan.actions)
    first = grabs[2]
    assert np.array_equal(best.plan.codes(task)[:first], plan.codes(task)[:first])
    assert lay_course(task, best.plan).objections == ()


@pytest.mark.slow
def test_a_change_that_climbs_no_more_often_is_not_kept(climb: tuple[LimbedTask, Plan]) -> None:
    task, plan = climb

    def unlucky(plan: Plan, seeds: Sequence[int]) -> list[ClimbTrial]:
        return [trial(seed, len(plan.actions), done=seed % 2 == 1) for seed in seeds]

    lessons: list[Lesson] = []
    best = learn(
        task, plan, unlucky, SEEDS, lessons=2, seconds=60.0,
        told=lambda best, lesson: None if lesson is None else lessons.append(lesson),
    )  # fmt: skip
    assert best.plan is plan and best.climbed == 4
    assert len(lessons) == 2 and not any(lesson.taken for lesson in lessons)
    assert all(lesson.climbed == 0 and lesson.tried == 4 for lesson in lessons)  # seeds that failed come first


def test_a_plan_that_never_fails_is_left_as_it_is(climb: tuple[LimbedTask, Plan]) -> None:
    task, plan = climb
    asked: list[int] = []

    def sure(plan: Plan, seeds: Sequence[int]) -> list[ClimbTrial]:
        asked.extend(seeds)
        return [trial(seed, len(plan.actions), done=True) for seed in seeds]

    best = learn(task, plan, sure, SEEDS, lessons=5, seconds=60.0)
    assert best.plan is plan and asked == list(SEEDS)
