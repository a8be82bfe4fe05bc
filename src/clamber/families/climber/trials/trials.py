"""Many climbs of one plan, each with its own seed: planned once, run over workers, stored as they end."""

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

from ....errors import ClamberError, SpecError
from ....jobs import Executor, Kept, Outcome, look_into, map_items
from ....planning.problem.plan import Plan
from ....types import Json
from ..execution.course import lay_course
from .noise import check_noise
from .planning import plan_to_climb
from .rehearsal import rehearse
from .run_plan import climbing_flaws
from .trial import PLAN_SEED, ClimbTrial, TrialSetup, error_trial, run_trial, trial_of
from .warm_up import warm_up


class NoPlanError(ClamberError):
    """There is nothing to try: the planner found no plan that can be carried out."""

    def __init__(self, task: str) -> None:
        super().__init__(task)
        self.task = task

    def __str__(self) -> str:
        return f"no plan for '{self.task}' that hooks can be trusted with; nothing has moved"


def with_plan(
    setup: TrialSetup, store: Path | None = None, label: str = "plan", cut: Callable[[], None] = lambda: None
) -> TrialSetup:
    """The setup with its plan: its own, that of the store, or a new one; errors call it `label`, `cut` is as in `plan_to_climb`.

    Raises:
        NoPlanError: If there is none.
        PlanRefusedError: If something speaks against it and it is not forced.
        NoiseError: If a width is more than what there is of it.
        StoreError: If the file can't be the store of these trials.
    """
    flaws = climbing_flaws(setup.task, setup.plant)
    check_noise(setup.noise, setup.task.robot, flaws)
    kept = _kept(setup, store)
    plan, planned = setup.plan, setup.plan is None
    if plan is None and kept is not None and kept.note is not None:
        plan = Plan.from_json(kept.note, "plan of the store")
    if plan is None:
        plan = plan_to_climb(
            setup.task, setup.planner, seconds=setup.seconds, seed=PLAN_SEED, cut=cut,
            rehearse=lambda task, plan: rehearse(task, plan, flaws),
        )  # fmt: skip
    if plan is None:
        raise NoPlanError(setup.task.name)
    course = lay_course(setup.task, plan, label)
    if course.objections and not setup.force:
        raise course.objections[0]
    return replace(setup, plan=plan, planned=planned)


def stored_trial(
    setup: TrialSetup, seed: int, store: Path | None
) -> tuple[ClimbTrial | None, list[Json | None] | None]:
    """A trial as the store has it, and the plans that it was given on its way; None where it is not there.

    Raises:
        StoreError: If the file can't be the store of these trials.
    """
    kept = _kept(setup, store)
    for one in () if kept is None else kept.results:
        if one.get("seed") == seed:
            plans = one.get("plans")
            if not isinstance(plans, list) or not all(plan is None or isinstance(plan, dict) for plan in plans):
                raise SpecError(f"{store}: a stored result", "plans", plans, "must be a list of plans")
            return trial_of(one, store), plans
    return None, None


def _kept(setup: TrialSetup, store: Path | None) -> Kept | None:
    return None if store is None else look_into(store, run_trial, about=setup.about(), title=setup.title)


@dataclass(slots=True)
class Trials:
    """Climbs that ended, and how long they took."""

    setup: TrialSetup
    """With its plan."""
    asked: int
    """How many there are to be."""
    ended: list[ClimbTrial]
    wall_seconds: float = 0.0
    """All workers together, for the climbs that ended."""

    @property
    def done(self) -> int:
        """Climbs that were carried out to their end."""
        return sum(trial.done for trial in self.ended)


def run_trials(
    setup: TrialSetup,
    seeds: Sequence[int],
    *,
    executor: Executor,
    store: Path | None = None,
    resume: bool = False,
    told: Callable[[Trials], None] | None = None,
) -> Trials:
    """Climb with every seed; each trial is stored, and told of, as it ends. Ctrl-C ends it early, with what there is.

    Args:
        setup: What all trials have in common, with its plan.
        seeds: One trial each.
        executor: Who runs them.
        store: SQLite file that keeps plan and trials.
        resume: Whether to go on with that file: trials in it are not run again.
        told: Given what there is so far at each end.

    Raises:
        StoreError: If the file can't be the store of these trials.
        ClusterError: If there is no cluster to run on, or it is lost.
    """
    assert setup.plan is not None, "plan first"
    kept = _kept(setup, store) if resume else None
    wanted = set(seeds)
    before = (
        [] if kept is None else [trial_of(result, store) for result in kept.results if result.get("seed") in wanted]
    )
    trials = Trials(setup, len(seeds), before)

    def take(ended: int, total: int, outcome: Outcome) -> None:
        trials.wall_seconds += outcome.seconds
        if outcome.result is not None:
            trials.ended.append(trial_of(outcome.result, store))
        if told is not None:
            told(trials)

    if executor.here and len(before) < len(seeds):
        warm_up()  # here, once, and not in every worker at the same time
    with suppress(KeyboardInterrupt):
        outcomes = map_items(
            run_trial,
            [setup.item(seed) for seed in seeds],
            executor=executor,
            store=store,
            about=setup.about(),
            title=setup.title,
            note=setup.plan.to_json(),
            resume=resume,
            progress=take,
        )
        trials.wall_seconds = sum(outcome.seconds for outcome in outcomes)
        trials.ended = [
            error_trial(seed, outcome.error or "") if outcome.result is None else trial_of(outcome.result, store)
            for seed, outcome in zip(seeds, outcomes, strict=True)
        ]
    return trials
