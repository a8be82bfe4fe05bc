"""A plan made surer by rehearsals: where its climbs fail most, it is changed from shortly before on, and what went well stays."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from operator import attrgetter
from typing import Annotated, Final, TypeAlias

import numpy as np

from ....errors import SpecError
from ....interrupts import answer, passed_on
from ....jobs import Executor
from ....json_form import HIDDEN, Count, Jsonable, Key, in_json
from ....notebook import Pictured
from ....planning.problem.plan import Plan
from ....planning.problem.problems import PlannedAction
from ....trials.held_out import check_training
from ....trials.trial_runs import run_trials
from ....trials.work import Work
from ..execution.executable_plan import lay_course
from ..planning.task import LimbedTask
from .noise import Noise
from .planning import grab_before
from .planning_margins import PLANNING_MARGINS, steady
from .rerouting import cut_before, grabs_of, other_end, repaired, without
from .run_plan import climbing_task
from .stretch_repair import with_stretch_repaired
from .trial import ClimbTrial, TrialSetup, with_plan

Climbs: TypeAlias = Callable[[Plan, Sequence[int]], list[ClimbTrial]]
"""Climbs by a plan once with each seed, without another plan on the way."""
BACKS: Final = (2, 4, 7)
"""How many grabs before the one that failed a plan is changed from, in turn."""
SCREEN: Final = 6
"""Seeds that failed with which a changed plan is tried first, at most; it has to climb with half of them."""
BATCH: Final = 12
"""Climbs that are asked for at a time after that: when it is clear that the change is no gain, there are no more."""


def climbs_with(
    setup: TrialSetup, executor: Executor, told: Callable[[int, int, int], None] = lambda ended, asked, climbed: None
) -> Climbs:
    """Climbs by plans under a setup's noise, without new plans on the way.

    Args:
        setup: Whose plan changes.
        executor: Who climbs.
        told: Given, at each end, how many climbs of a plan have ended, of how many, and how many of them were carried out whole.

    Raises, when called:
        KeyboardInterrupt: After Ctrl-C.
    """

    def climbs(plan: Plan, seeds: Sequence[int]) -> list[ClimbTrial]:
        with passed_on():
            return run_trials(
                replace(setup, plan=plan, replan=False),
                seeds,
                executor=executor,
                told=lambda trials: told(len(trials.ended), trials.asked, trials.done),
            ).ended

    return climbs


@dataclass(frozen=True, slots=True)
class ValidatedPlan:
    """A plan, and what came of its climbs."""

    plan: Plan
    trials: tuple[ClimbTrial, ...]

    @property
    def climbed(self) -> int:
        """Climbs that were carried out whole."""
        return sum(trial.done for trial in self.trials)

    @property
    def faults(self) -> dict[int, list[int]]:
        """Step of a grab -> seeds with which it was at fault, the most frequent first, then the earliest; 0 where none was."""
        seeds: dict[int, list[int]] = {}
        for trial in self.trials:
            if not trial.done:
                seeds.setdefault(grab_before(self.plan, trial.step) or 0, []).append(trial.seed)
        return dict(sorted(seeds.items(), key=lambda each: (-len(each[1]), each[0])))


@dataclass(frozen=True, slots=True)
class Lesson:
    """One change of a plan that was tried."""

    step: int
    """Of the grab that is to be made otherwise."""
    what: str
    """The change."""
    length: Count
    """Actions of the changed plan."""
    climbed: Count
    """Of its climbs, as many as it took to tell."""
    tried: Count
    """Climbs by it."""
    taken: bool
    """Whether the plan goes on from there."""


Went: TypeAlias = tuple[ValidatedPlan, Lesson | None]
"""The best plan after a change was tried, and the change; None: the first rehearsal."""


@dataclass(frozen=True, slots=True)
class GrabAtFault:
    """A grab with which climbs went wrong."""

    step: int
    """0 where no grab led to where they ended."""
    seeds: list[int]
    """Of those climbs."""


@dataclass(frozen=True, slots=True, repr=False)
class LearnedPlan(Jsonable, Pictured):
    """What a plan learned in rehearsals."""

    first: Annotated[
        ValidatedPlan,
        Key("climbs", get=lambda first: len(first.trials), kind=Count, meaning="Of each rehearsal."),
        Key(
            "climbed_before",
            get=attrgetter("climbed"),
            kind=Count,
            meaning="Of them, carried out whole by the plan as it was.",
        ),
    ]
    best: Annotated[
        ValidatedPlan,
        Key("climbed", get=attrgetter("climbed"), kind=Count, meaning="Likewise by the best plan found."),
        Key("actions", get=attrgetter("plan.actions"), kind=list[PlannedAction], meaning="Of that plan."),
    ]
    lessons: Annotated[Sequence[Lesson], Key(after="faults")]
    """Changes in the order in which they were tried."""
    interrupted: Annotated[bool, HIDDEN] = False
    """Whether Ctrl-C ended it."""

    @property
    def plan(self) -> Plan:
        """The best one."""
        return self.best.plan

    def told(self) -> str:
        """Climbs before and after."""
        return f"for {self.plan.task!r}: {self.first.climbed} of {len(self.first.trials)} climbs before, {self.best.climbed} after"

    @in_json(after="actions")
    def faults(self) -> tuple[GrabAtFault, ...]:
        """Where it still fails, the most frequent first."""
        return tuple(GrabAtFault(step, seeds) for step, seeds in self.best.faults.items())


def learn(
    task: LimbedTask,
    plan: Plan,
    climbs: Climbs,
    seeds: Sequence[int],
    *,
    lessons: int,
    seconds: float,
    told: Callable[[ValidatedPlan, Lesson | None], None] = lambda best, lesson: None,
) -> ValidatedPlan:
    """Make a plan surer: climb with every seed, change what failed most often, keep the change if more climbs are carried out, and again.

    A change makes the grab at fault where the limbs are least stretched, or does without it and looks for another way on from some grabs
    before: all that went well before stays as it was. It is tried first with seeds that failed, then with all, as long as it may be better.

    Args:
        task: Under the rules that can be carried out.
        plan: That nothing speaks against.
        climbs: Climbs by a plan.
        seeds: Of every rehearsal: the same for each plan, so that they differ by the plan alone.
        lessons: Most changes that are tried.
        seconds: Most time for each search for a plan.
        told: Of the best plan so far, and the change that was tried last; of the first rehearsal without one.

    Raises:
        HeldOutError: If a seed is held out for rates.
    """
    check_training(seeds)
    best = ValidatedPlan(plan, tuple(climbs(plan, seeds)))
    told(best, None)
    changes, seen = _changes(task, best, seconds), {plan.codes(task).tobytes()}
    for _ in range(lessons):
        if best.climbed == len(seeds):
            break
        made = next((made for made in changes if made[2].codes(task).tobytes() not in seen), None)
        if made is None:
            break
        step, what, changed = made
        seen.add(changed.codes(task).tobytes())
        trials = _tried(changed, best, climbs, seeds)
        better = len(trials) == len(seeds) and sum(trial.done for trial in trials) > best.climbed
        if better:
            best = ValidatedPlan(changed, tuple(trials))
            changes = _changes(task, best, seconds)
        done = sum(trial.done for trial in trials)
        told(best, Lesson(step, what, len(changed.actions), done, len(trials), better))
    return best


def validate_plan(
    work: Work,
    noise: Sequence[str],
    executor: Executor,
    seeds: Sequence[int],
    *,
    lessons: int,
    seconds: float,
    told: Callable[[Sequence[Went]], None] = lambda went: None,
    ended: Callable[[int, int, int], None] = lambda ended, asked, climbed: None,
) -> LearnedPlan:
    """Make the plan of a work surer, under the usual noise but for what is named; Ctrl-C ends it with what there is.

    Args:
        work: A climber's plan with its task.
        noise: Texts "key=width".
        executor: Who climbs.
        seeds: Of every rehearsal.
        lessons: Most changes that are tried.
        seconds: Most time for each search for another way [s].
        told: Of all that came of it so far: the best plan after each change, and the change; of the first rehearsal without one.
        ended: As `climbs_with` tells of climbs.

    Raises:
        SpecError: If the work has no plan.
        KeyboardInterrupt: If Ctrl-C comes before the first rehearsal has ended.
        HeldOutError: If a seed is held out for rates.
    """
    task = climbing_task(work.item)
    if work.plan is None:
        raise SpecError(work.label, "plan", "", "there is none; `clamber plan` makes one for a task")
    setup = TrialSetup(task=task, noise=Noise.of("usual", noise), plan=work.plan, plant=work.plant, replan=False)
    climbs, went = climbs_with(with_plan(setup, label=work.label), executor, ended), list[Went]()

    def tell(best: ValidatedPlan, lesson: Lesson | None) -> None:
        went.append((best, lesson))
        told(went)

    interrupted = False
    try:
        learn(task, work.plan, climbs, seeds, lessons=lessons, seconds=seconds, told=tell)
    except KeyboardInterrupt:
        answer()
        interrupted = True
        if not went:
            raise
    return LearnedPlan(went[0][0], went[-1][0], [lesson for _, lesson in went if lesson is not None], interrupted)


def _tried(plan: Plan, best: ValidatedPlan, climbs: Climbs, seeds: Sequence[int]) -> list[ClimbTrial]:
    """Climbs by a plan, first with seeds that failed before, until it is clear that it is no better."""
    failed = [trial.seed for trial in best.trials if not trial.done]
    first = failed[:SCREEN]
    trials = climbs(plan, first)
    if 2 * sum(trial.done for trial in trials) < len(first):
        return trials
    left = [seed for seed in seeds if seed not in first]
    for start in range(0, len(left), BATCH):
        trials += climbs(plan, left[start : start + BATCH])
        if sum(not trial.done for trial in trials) >= len(failed):
            break
    return trials


def _changes(task: LimbedTask, best: ValidatedPlan, seconds: float) -> Iterator[tuple[int, str, Plan]]:
    """Plans that make grabs at fault otherwise, those that fail most often first: step, what is changed, plan."""
    plan = best.plan
    codes = plan.codes(task)
    steps = [step for step in best.faults if step]
    for step in steps:
        made = with_stretch_repaired(task, codes, step)
        if not np.array_equal(made, codes):
            yield step, "made where it is steadier", replace(plan, actions=Plan.of_codes(task, made).actions)
    course = lay_course(task, plan)
    for back in BACKS:
        for margins in (*steady(task), *PLANNING_MARGINS):
            for step in steps:
                for grab in grabs_of(course, step):
                    avoiding = without(margins, plan, grab)
                    other = other_end(course, plan, grab, back, avoiding, seconds)
                    other = None if other is None else repaired(task, other, avoiding, seconds)
                    if other is not None:
                        cut = cut_before(plan, grab, back) + 1
                        yield step, f"without that of step {grab}, another way from step {cut} on", other
