"""Walks in contact dynamics: one, and many under model error; of a walk's own way, or of a task's plan."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final, TypeAlias

from ...execution.fault import check_faults
from ...json_form import INLINE
from ...planning.problem.plan import Plan
from ...trials.dynamics import Conditions, Dynamics, RunEvents, RunRequest, TrialsRequest, plan_to_run
from .planning import Walk
from .planning.task import WalkerTask
from .trials.noise import WalkNoise
from .trials.planned import careful, lay_plan, walk_of
from .trials.run_walk import WalkRun, run_walk, step_told, walk_flaws
from .trials.trials import WalkSetup, WalkTrial, WalkTrials, failing_of

if TYPE_CHECKING:
    from rich.console import Console

Work: TypeAlias = Walk | WalkerTask
CLIMBS_ONLY: Final = frozenset({"peg_error", "replan", "plant", "force", "law", "against_law"})
"""Options that neither walks nor plans of walkers have a use for."""
PLANS_ONLY: Final = frozenset({"task", "planner", "seconds", "save_plan"})
"""Options that a walk has no use for, as it needs no plan."""


@dataclass(frozen=True, slots=True)
class TrialedWalk:
    """Many walks, of a walk or of a walker's plan."""

    trials: Annotated[WalkTrials, INLINE]
    held_out: bool
    """Whether all seeds are held out: none that any tuning may use."""


@dataclass(frozen=True, slots=True)
class ReplayedWalk:
    """`--replay SEED`: one walk of the trials again."""

    run: Annotated[WalkRun, INLINE]
    trial: WalkTrial


class WalkerDynamics(Dynamics):
    """Walks on a plant with flaws."""

    kind = "walk"
    past = "walked"
    replayed = ReplayedWalk

    def unused(self, work: Work) -> frozenset[str]:
        """What only climbs have; of a walk, also what only plans have."""
        return CLIMBS_ONLY | PLANS_ONLY if isinstance(work, Walk) else CLIMBS_ONLY

    def check(self, work: Work, asked: Conditions) -> None:
        """Plant, noise and faults."""
        walk_flaws(_walk_of(work), asked.plant)
        WalkNoise.of(asked.noise_set, asked.noise)
        if isinstance(asked, TrialsRequest):
            check_faults(asked.faults, failing_of(work.robot).kinds)

    def plan(self, task: WalkerTask, asked: RunRequest, events: RunEvents) -> Plan:
        """Found with more room than the checks ask for."""
        return _found(careful(task), asked, events, asked.seed)

    def run(self, work: Work, plan: Plan | None, asked: RunRequest, events: RunEvents, label: str = "plan") -> WalkRun:
        """One walk."""
        lay = None
        if not isinstance(work, Walk):
            work, plan = _planned(work, plan, asked, events, asked.seed)
            lay = lay_plan(work, plan, label)
        walk = _walk_of(work)
        run = run_walk(
            walk,
            walk_flaws(walk, asked.plant),
            noise=WalkNoise.of(asked.noise_set, asked.noise),
            seed=asked.seed,
            lay=lay,
            log=asked.log,
            progress=lambda *step: events.step(*step_told(*step)),
        )
        return replace(run, plan=plan)

    def print_run(self, console: "Console", run: WalkRun) -> None:
        """How it ended, a row for each step."""
        from .pictures.walk_text import print_walk

        print_walk(console, run)

    def trials(
        self,
        work: Work,
        plan: Plan | None,
        asked: TrialsRequest,
        events: RunEvents,
        store: Path | None = None,
        label: str = "plan",
    ) -> WalkSetup:
        """What all walks have in common."""
        noise = WalkNoise.of(asked.noise_set, asked.noise)
        if isinstance(work, Walk):
            return WalkSetup(work, noise, asked.plant, faults=asked.faults)
        task = work if plan is not None else careful(work)
        setup = WalkSetup(task, noise, asked.plant, plan, plan is None, asked.faults)
        task, plan = _planned(task, plan or setup.stored_plan(store), asked, events, seed=0)
        lay_plan(task, plan, label)  # what it violates is told before workers start
        return replace(setup, plan=plan)

    def trials_json(self, trials: WalkTrials, held_out: bool) -> TrialedWalk:
        """The trials and what they say together."""
        return TrialedWalk(trials, held_out)

    def print_trials(self, console: "Console", trials: WalkTrials, seeds: Sequence[int]) -> None:
        """How often walks came to their end, and the spread of what is measured of them."""
        from .pictures.walk_text import print_walk_trials

        print_walk_trials(console, trials, seeds)


def _walk_of(work: Work) -> Walk:
    return work if isinstance(work, Walk) else walk_of(work)


def _planned(
    task: WalkerTask, plan: Plan | None, asked: Conditions, events: RunEvents, seed: int
) -> tuple[WalkerTask, Plan]:
    """A plan and the task in which it holds: with more room than the checks ask for, where it is planned here."""
    if plan is not None:
        return task, plan
    task = careful(task)
    plan = _found(task, asked, events, seed)
    events.planned(plan)
    return task, plan


def _found(task: WalkerTask, asked: Conditions, events: RunEvents, seed: int) -> Plan:
    return plan_to_run(task, asked, events, seed, "that can bear to be walked")


DYNAMICS: Final = WalkerDynamics()
