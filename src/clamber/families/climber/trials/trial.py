"""One climb of many: what it has in common with the others, what its seed draws, how it ended, and the same climb again."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Final, TypeAlias

import numpy as np

from ....errors import MISSING, SpecError
from ....execution.fault import draw_fault
from ....jobs import read_result
from ....json_form import Count, Jsonable, Key
from ....planning.problem.plan import Plan
from ....tasks import task_from_document
from ....trials.dynamics import RunEvents
from ....trials.fault_trials import TriedFault, told_fault
from ....trials.trial_runs import ERROR, Setup, Trials, check_told
from ....types import Json
from ..execution.climbing import Progress, Replan
from ..execution.executable_plan import lay_course
from ..planning.task import LimbedTask
from .noise import NOISE, Noise, check_noise
from .planning import QUIET, no_plan, plan_to_climb, replanner, validations
from .run_plan import ClimbRun, action_told, climbing_flaws, failing_of, run_plan
from .warm_up import warm_up

PLAN_SEED: Final = 0
"""Of the plan that all trials share, and of plans made on the way."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ClimbTrial(Jsonable):
    """How one climb ended."""

    seed: Count
    done: bool
    """Whether every action was carried out."""
    outcome: str
    """Of the last action: "ok", or why the climb ended there, such as "fell" or "missed"; "error" where it raised."""
    step: Count
    """Number of the last action in its plan, from 1; 0: none began."""
    kind: str
    """Of that action, such as "grab"; empty if none began."""
    limb: str
    """That acted; empty for the body."""
    reason: str
    """Why it ended, where it is not done."""
    seconds: float
    """Simulated."""
    short: float
    """By how much the body truly misses the goal's box at the end [m]."""
    pushes: Count
    """Of all grabs."""
    grabs: Count
    stalled: Count
    """Moves of the body that did not arrive."""
    replans: Count
    """New plans that were taken."""
    recovered: Count
    """Hooks that came off and were brought back."""
    drawn: dict[str, float]
    """Deviation of each key of the noise; of pegs, of those that the plan takes."""
    fault: Annotated[Json | None, Key(kind=TriedFault)] = None
    """The fault that the robot had, when it was noticed, and how that ended; None in trials without."""


def trial_of(told: Json, store: Path | None = None) -> ClimbTrial:
    """The trial that a worker told, or a store has, or `ClimbTrial.to_json`.

    Raises:
        SpecError: If it is none.
    """
    trial = read_result(ClimbTrial, told, store)
    if trial.drawn and (missing := NOISE.keys() - trial.drawn.keys()):
        raise SpecError(f"{store}: a stored result", f"drawn.{min(missing)}", MISSING, "must be given")
    check_told(trial.fault, store)
    return trial


def error_trial(seed: int, error: str) -> ClimbTrial:
    """A trial without an answer; it counts as a climb that failed."""
    return ClimbTrial(
        seed=seed,
        done=False,
        outcome=ERROR,
        step=0,
        kind="",
        limb="",
        reason=error,
        seconds=0.0,
        short=0.0,
        pushes=0,
        grabs=0,
        stalled=0,
        replans=0,
        recovered=0,
        drawn={},
    )


def run_trial(item: Json) -> Json:
    """One trial; runs in a worker.

    Args:
        item: As `TrialSetup.item` writes it.

    Returns:
        The trial, and `plans` that were made on the way.
    """
    task = task_from_document(item["document"])
    assert isinstance(task, LimbedTask)
    planner, seconds, replan = item["planner"]
    setup = TrialSetup(
        task=task,
        noise=Noise.from_json(item["noise"]),
        plan=Plan.from_json(item["plan"] | {"document": item["document"]}),
        plant=tuple(item["plant"]),
        planner=planner,
        seconds=seconds,
        replan=replan,
        force=item["force"],
        faults=tuple(item["faults"]),
    )
    _, trial, plans = climb_once(setup, item["seed"])
    return trial.to_json() | {"plans": plans}


@dataclass(frozen=True, slots=True, kw_only=True)
class TrialSetup(Setup[ClimbRun, ClimbTrial]):
    """What all trials have in common, as plain as a worker needs it."""

    task: LimbedTask
    """Under the rules that can be carried out."""
    noise: Noise
    plan: Plan | None = None
    """None: not made yet, see `with_plan`."""
    planned: bool = False
    """Whether `planner` made the plan, so that it is no part of what was asked for."""
    plant: tuple[str, ...] = ()
    """Settings of the plant, such as "backlash=1deg"."""
    planner: str = "auto"
    seconds: float = 600.0
    """Most time for each search for a plan."""
    replan: bool = True
    """Whether to plan again where a hold cannot be had."""
    force: bool = False
    """Whether to carry out a plan that something speaks against."""
    faults: tuple[str, ...] = ()
    """Kinds of faults, one of which each trial has; none without."""

    def about(self) -> Json:
        """What tells these trials from others; not how many, nor from which seed on."""
        return {
            "task": self.task.document,
            "plan": None if self.plan is None or self.planned else self.plan.to_json(),
            "plant": list(self.plant),
            "noise": self.noise.to_json(),
            "planner": [self.planner, self.seconds, self.replan],
            "force": self.force,
        } | ({"faults": list(self.faults)} if self.faults else {})

    @property
    def worker(self) -> Callable[[Json], Json]:
        """One trial."""
        return run_trial

    @property
    def title(self) -> str:
        """The same in words."""
        return f"trials of '{self.task.name}' with noise {self.noise.words()}"

    def item(self, seed: int) -> Json:
        """One trial for a worker."""
        assert self.plan is not None, "plan first"
        return {
            "document": self.task.document,
            "plan": _without_document(self.plan),
            "plant": list(self.plant),
            "noise": self.noise.to_json(),
            "planner": [self.planner, self.seconds, self.replan],
            "force": self.force,
            "faults": list(self.faults),
            "seed": seed,
        }

    def trial(self, result: Json, store: Path | None = None) -> ClimbTrial:
        """The trial of a result; see `trial_of`."""
        return trial_of(result, store)

    def failed(self, seed: int, error: str) -> ClimbTrial:
        """A climb that raised; see `error_trial`."""
        return error_trial(seed, error)

    def warm_up(self) -> None:
        """Load the kernels of a climb."""
        warm_up()

    def again(
        self, seed: int, kept: Json | None, step: Callable[[str, float | None], None]
    ) -> tuple[ClimbRun, ClimbTrial]:
        """One climb again, with the plans that it was given on its way."""
        plans = None if kept is None else plans_on_the_way(kept)
        run, trial, _ = climb_once(self, seed, plans=plans, progress=lambda *action: step(*action_told(*action)))
        return run, trial


ClimbTrials: TypeAlias = Trials[TrialSetup, ClimbTrial]


def with_plan(
    setup: TrialSetup, store: Path | None = None, label: str = "plan", events: RunEvents = QUIET
) -> TrialSetup:
    """The setup with its plan: its own, that of the store, or a new one; errors call it `label`.

    Raises:
        NoPlanError: If there is none.
        PlanRefusedError: If something speaks against it and it is not forced.
        NoiseError: If a width is more than what there is of it.
        StoreError: If the file can't be the store of these trials.
    """
    flaws = climbing_flaws(setup.task, setup.plant)
    check_noise(setup.noise, setup.task.robot, flaws)
    stored, planned = setup.stored_plan(store), setup.plan is None
    plan = setup.plan or stored
    if plan is None:
        plan = plan_to_climb(
            setup.task,
            setup.planner,
            seconds=setup.seconds,
            seed=PLAN_SEED,
            events=events,
            validate_plan=validations(flaws, events),
        )
    if plan is None:
        raise no_plan(setup.planner, setup.task)
    course = lay_course(setup.task, plan, label)
    if course.objections and not setup.force:
        raise course.refusal()
    return replace(setup, plan=plan, planned=planned)


@dataclass(slots=True)
class PlansOnTheWay:
    """Plans that were asked for during a climb, kept, or given again as they were kept.

    A planner under a time limit may find another plan on another day; a trial that is run again takes those of the first run.
    """

    planner: Replan
    stored: list[Json | None] | None
    """Of the first run; None: this is the first run."""
    told: list[Json | None]

    def __call__(self, task: LimbedTask) -> Plan | None:
        """The next plan."""
        if self.stored is None:
            plan = self.planner(task)
        else:
            known = self.stored[len(self.told)] if len(self.told) < len(self.stored) else None
            plan = None if known is None else Plan.from_json(known | {"document": task.document}, "plan on the way")
        self.told.append(None if plan is None else _without_document(plan))
        return plan


def climb_once(
    setup: TrialSetup, seed: int, *, plans: list[Json | None] | None = None, progress: Progress | None = None
) -> tuple[ClimbRun, ClimbTrial, list[Json | None]]:
    """One trial, whole: the run with its trace, what is kept of it, and the plans that were asked for on the way.

    Args:
        setup: With a plan.
        seed: Of all that is drawn.
        plans: Those of its first run, to be taken again; None: plans are made.
        progress: Told before each action.
    """
    assert setup.plan is not None, "plan first"
    planner = replanner(setup.planner, seconds=setup.seconds, seed=PLAN_SEED, threads=1)  # others climb meanwhile
    way = PlansOnTheWay(planner, plans, [])
    fault = draw_fault(setup.faults, seed, failing_of(setup.task, setup.plan)) if setup.faults else None
    run = run_plan(
        setup.task,
        setup.plan,
        climbing_flaws(setup.task, setup.plant),
        noise=setup.noise,
        seed=seed,
        force=setup.force,
        replan=way if setup.replan else None,
        progress=progress,
        fault=fault,
    )
    return run, _judged(setup, seed, run, way.told), way.told


def _judged(setup: TrialSetup, seed: int, run: ClimbRun, told: list[Json | None]) -> ClimbTrial:
    report, last = run.report, run.report.actions[-1] if run.report.actions else None
    plans = [setup.plan, *(Plan.from_json(one | {"document": {}}) for one in told if one is not None)]
    plan = plans[len(report.replans)]  # one that is refused ends the climb, so those taken come first
    limb = None if last is None or plan is None else plan.actions[last.first - 1].limb
    grabs = [action for action in report.actions if action.kind == "grab"]
    grabbed = {action.hold for action in setup.plan.actions} if setup.plan is not None else set()
    taken = [k for k, hold in enumerate(setup.task.world.holds) if hold.number in grabbed]
    return ClimbTrial(
        seed=seed,
        done=report.done,
        outcome="ok" if report.done else _outcome(run),
        step=0 if last is None else last.first,
        kind="" if last is None else last.kind,
        limb=limb or "",
        reason=report.reason,
        seconds=report.seconds,
        short=report.short,
        pushes=sum(action.tries for action in grabs),
        grabs=len(grabs),
        stalled=sum(action.outcome == "stalled" for action in report.actions),
        replans=len(report.replans),
        recovered=sum(action.recovered for action in report.actions),
        drawn=run.drawn.to_json(np.array(taken, np.int32)),
        fault=told_fault(run.fault, report.done, report),
    )


def _outcome(run: ClimbRun) -> str:
    """Why a climb ended; it may fall before its first action."""
    actions = run.report.actions
    if actions and actions[-1].outcome not in ("ok", "stalled"):
        return actions[-1].outcome
    return run.report.reason.partition(":")[0]


def plans_on_the_way(result: Json) -> list[Json | None]:
    """The plans that a trial was given on its way, of its result in a store.

    Raises:
        SpecError: If they are no plans.
    """
    plans = result.get("plans")
    if not isinstance(plans, list) or not all(plan is None or isinstance(plan, dict) for plan in plans):
        raise SpecError("a stored result", "plans", plans, "must be a list of plans")
    return plans


def _without_document(plan: Plan) -> Json:
    return {key: value for key, value in plan.to_json().items() if key != "document"}
