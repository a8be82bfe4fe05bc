"""Runs and trials of a family that says no more than how one plan is carried out."""

from abc import abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from ..errors import SpecError
from ..execution.log_stream import LogGap
from ..execution.run_report import RunReport
from ..family import NotOfFamilyError, family_of
from ..json_form import HIDDEN, INLINE, Count, Jsonable, Key
from ..planning.problem.plan import Plan
from ..planning.problem.verdict import check_plan
from ..tasks import Task, task_from_document
from ..types import Json
from .dynamics import Conditions, Dynamics, RunEvents, RunRequest, TaskRun, TrialsRequest, plan_to_run
from .held_out import seeds_in_words
from .noise import NoiseKind, named_widths, read_widths, stream_of
from .trial_runs import Setup, Trials, wilson_interval

if TYPE_CHECKING:
    from rich.console import Console


@dataclass(frozen=True, slots=True, kw_only=True)
class PlainRun(Jsonable, TaskRun):
    """A plan that was carried out."""

    task: Annotated[Task, Key(get=lambda task: task.name, kind=str)]
    plan: Annotated[Plan, HIDDEN]
    report: Annotated[RunReport, INLINE]
    drawn: dict[str, float]
    """How far each property truly was from what was believed, SI units."""
    log_gap: Annotated[LogGap | None, HIDDEN] = None

    @property
    def trace(self) -> None:
        """None is kept."""
        return None

    @property
    def scene(self) -> None:
        """None is kept, either."""
        return None


@dataclass(frozen=True, slots=True, kw_only=True)
class PlainTrial(Jsonable):
    """How one run ended."""

    seed: Count
    done: bool
    reason: str
    """Why not; empty where it is done."""
    seconds: float
    """Simulated."""
    drawn: dict[str, float]
    """Deviation of each key of the noise, SI units."""

    @property
    def fault(self) -> None:
        """There are none."""
        return None


@dataclass(frozen=True, slots=True)
class TrialedPlan:
    """Many runs of one plan."""

    task: str
    n: Count
    """Runs that ended."""
    done: Count
    interval: tuple[float, float]
    """Of the share that came to its end, 95 %, Wilson's."""
    held_out: bool
    """Whether all seeds are held out: none that any tuning may use."""
    trials: list[PlainTrial]


@dataclass(frozen=True, slots=True)
class ReplayedPlan:
    """`--replay SEED`: one run of the trials again."""

    run: Annotated[PlainRun, INLINE]
    trial: PlainTrial


@dataclass(frozen=True, slots=True, kw_only=True)
class PlainSetup(Setup[PlainRun, PlainTrial]):
    """What all trials have in common."""

    kind = PlainTrial
    unknown = MappingProxyType({"seconds": 0.0, "drawn": {}})
    task: Task
    widths: dict[str, float]
    plan: Plan | None
    planned: bool
    """Whether a planner made the plan, so that it is no part of what was asked for."""
    faults: tuple[str, ...] = ()

    @property
    def worker(self) -> Callable[[Json], Json]:
        """One trial."""
        return run_plain_trial

    @property
    def title(self) -> str:
        """In words."""
        return f"trials of '{self.task.name}'"

    def about(self) -> Json:
        """Task, noise, and the plan if it was asked for."""
        plan = None if self.plan is None or self.planned else self.plan.to_json()
        return {"task": self.task.document, "noise": self.widths, "plan": plan}

    def item(self, seed: int) -> Json:
        """Task, noise, plan and seed."""
        assert self.plan is not None, "plan first"
        plan = self.plan.to_json() | {"document": {}}
        return {"document": self.task.document, "noise": self.widths, "plan": plan, "seed": seed}

    def again(
        self, seed: int, kept: Json | None, step: Callable[[str, float | None], None]
    ) -> tuple[PlainRun, PlainTrial]:
        """One run again."""
        return _one(self.item(seed), step)


def run_plain_trial(item: Json) -> Json:
    """One trial, as `PlainTrial.to_json`; runs in a worker."""
    return _one(item, lambda words, share: None)[1].to_json()


def _one(item: Json, step: Callable[[str, float | None], None]) -> tuple[PlainRun, PlainTrial]:
    task = task_from_document(item["document"])
    dynamics = family_of(task).dynamics
    assert isinstance(dynamics, PlainDynamics)
    plan = Plan.from_json(item["plan"] | {"document": item["document"]})
    run = dynamics.carried_out(task, plan, item["noise"], item["seed"], step)
    trial = PlainTrial(seed=item["seed"], done=run.done, reason=run.reason, seconds=run.report.seconds, drawn=run.drawn)
    return run, trial


class PlainDynamics(Dynamics):
    """A family's `simulate`, with all that commands ask around it."""

    replayed = ReplayedPlan
    noise: ClassVar[Mapping[str, NoiseKind]] = {}
    """Key -> what may deviate; each is drawn evenly to either side."""

    @abstractmethod
    def simulate(
        self, task: Any, plan: Plan, drawn: Mapping[str, float], step: Callable[[str, float | None], None]
    ) -> RunReport:
        """Carry a plan out.

        Args:
            task: The task.
            plan: Its plan.
            drawn: Deviation of each key of `noise`, SI units.
            step: Told each action that begins, in words.
        """

    def check(self, work: Any, asked: Conditions) -> None:
        """The noise; plants have no settings, and there are no faults."""
        self._widths(asked)
        if asked.plant:
            raise SpecError(
                "--set", f"plant.{asked.plant[0].partition('=')[0]}", asked.plant[0], "its plant has no settings"
            )
        if isinstance(asked, TrialsRequest) and asked.faults:
            raise NotOfFamilyError(family_of(work).title, "faults")

    def _widths(self, asked: Conditions) -> dict[str, float]:
        return read_widths(self.noise, named_widths(self.noise, asked.noise_set), asked.noise)

    def run(self, work: Any, plan: Plan | None, asked: RunRequest, events: RunEvents, label: str = "plan") -> PlainRun:
        """One run of a plan."""
        widths = self._widths(asked)
        plan = self._planned(work, plan, asked, events, asked.seed, label)
        return self.carried_out(work, plan, widths, asked.seed, events.step)

    def carried_out(
        self, task: Task, plan: Plan, widths: Mapping[str, float], seed: int, step: Callable[[str, float | None], None]
    ) -> PlainRun:
        """A plan carried out with what a seed draws of each width, from a stream for each key."""
        drawn = {key: width * float(stream_of(key, seed).uniform(-1.0, 1.0)) for key, width in widths.items()}
        return PlainRun(task=task, plan=plan, report=self.simulate(task, plan, drawn, step), drawn=drawn)

    def _planned(
        self, task: Any, plan: Plan | None, asked: Conditions, events: RunEvents, seed: int, label: str
    ) -> Plan:
        """The plan if nothing speaks against it, or the one that is found, and told."""
        if plan is None:
            plan = self._found(task, asked, events, seed)
            events.planned(plan)
            return plan
        violated = None if asked.force else check_plan(task, plan, label=label).first_violation
        if violated is not None:
            raise SpecError(
                label, f"actions.{violated.step}", str(violated.asked), f"{violated.reason}; nothing has moved"
            )
        return plan

    def _found(self, task: Any, asked: Conditions, events: RunEvents, seed: int) -> Plan:
        return plan_to_run(task, asked, events, seed, "was found")

    def plan(self, task: Any, asked: RunRequest, events: RunEvents) -> Plan:
        """As any plan of the task: what is simulated keeps to its checks."""
        return self._found(task, asked, events, asked.seed)

    def print_run(self, console: "Console", run: PlainRun) -> None:
        """How it ended, and when."""
        words = self.past if run.done else f"not {self.past}"
        console.print(f"{words}: '{run.task.name}'", style="bold green" if run.done else "bold red")
        if run.reason:
            console.print(run.reason)
        console.print(f"{len(run.plan.actions)} actions, {run.report.seconds:.1f} s")

    def trials(
        self,
        work: Any,
        plan: Plan | None,
        asked: TrialsRequest,
        events: RunEvents,
        store: Path | None = None,
        label: str = "plan",
    ) -> PlainSetup:
        """What all runs have in common."""
        setup = PlainSetup(task=work, widths=self._widths(asked), plan=plan, planned=plan is None)
        stored = setup.stored_plan(store)
        return replace(setup, plan=self._planned(work, plan or stored, asked, events, 0, label))

    def trials_json(self, trials: Any, held_out: bool) -> TrialedPlan:
        """Counts and trials."""
        n, done = len(trials.ended), trials.done
        return TrialedPlan(trials.setup.task.name, n, done, wilson_interval(done, n), held_out, trials.ended)

    def print_trials(self, console: "Console", trials: Trials[PlainSetup, PlainTrial], seeds: Sequence[int]) -> None:
        """Success with its interval, and the reasons of failures."""
        n, done = len(trials.ended), trials.done
        low, high = (100.0 * share for share in wilson_interval(done, n))
        console.print(
            f"{done} of {n} runs of '{trials.setup.task.name}' succeeded: {low:.1f} to {high:.1f} %, 95 %", style="bold"
        )
        console.print(seeds_in_words(seeds))
        for trial in trials.ended:
            if not trial.done:
                console.print(f"seed {trial.seed}: {trial.reason}")
