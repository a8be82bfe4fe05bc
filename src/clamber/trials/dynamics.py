"""Contact dynamics of a family: how what it can do is carried out, once or many times under model error."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Protocol, runtime_checkable

from ..errors import PlannerError
from ..execution.log_scene import LoggedScene
from ..execution.log_stream import LogGap, WantedLog
from ..execution.run_report import RunReport
from ..family import NotOfFamilyError
from ..interrupts import passed_on
from ..kernel_cache import Use
from ..planning.planners import plan_task
from ..planning.problem.plan import Plan
from ..planning.problem.verdict import check_plan
from ..planning.progress import Listener

if TYPE_CHECKING:  # loads what only commands need
    from rich.console import Console

    from ..planning.result import PlanResult
    from ..tasks.imported import PlaneClimb
    from .trial_runs import Setup


class NoPlanError(PlannerError):
    """The planner found no plan that can be carried out."""

    says = "no plan for '{task}' {problem}; nothing has moved"


@dataclass(frozen=True, slots=True, kw_only=True)
class Conditions:
    """Under what a task, a plan or a walk is carried out."""

    noise_set: ClassVar[str] = "none"
    """Widths of the noise that are not named: a set of `noise.SETS`."""
    planner: str = "auto"
    """Of a task without a plan."""
    plan_seconds: float = 600.0
    """Most time of each search for a plan [s]."""
    noise: tuple[str, ...] = ()
    """Texts "key=width": how far properties may be off what is believed."""
    plant: tuple[str, ...] = ()
    """Texts "key=value" that change the simulated robot."""
    law: str | None = None
    """Of the whole body of a robot in space, by name; None: the usual one."""
    replan: bool = True
    """Whether a new plan is searched for where a hold cannot be had."""
    force: bool = False
    """Whether to carry out a plan that its checks refuse."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RunRequest(Conditions):
    """How something is carried out once."""

    seed: int = 0
    """Of planner and noise."""
    motors: str = "torques"
    """What moves: `torques`, `volts`, or the address of a plant server."""
    log: Path | WantedLog | None = None
    """File that grows during the run."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TrialsRequest(Conditions):
    """How something is carried out many times. Widths of the noise are the usual ones, but for those that are named."""

    noise_set = "usual"
    faults: tuple[str, ...] = ()
    """Kinds of faults, one of which each trial has; none without."""


def _ignore(*_: object) -> None:
    pass


@dataclass(frozen=True, slots=True, kw_only=True)
class RunEvents:
    """What is called on the way to a run and during it."""

    search: Listener | None = None
    """Progress of each search for a plan."""
    cut: Callable[[], None] = _ignore
    """A search was ended by its seconds, so that another machine may find another plan."""
    planned: Callable[[Plan], None] = _ignore
    """A plan was found, before anything moves."""
    note: Callable[[str], None] = _ignore
    """What takes long and was not asked for begins, such as another plan on the way; in words."""
    step: Callable[[str, float | None], None] = _ignore
    """The action or step that begins, in words, and the share that is done where it is known [-]; may end the run by an error."""


def search_to_run(
    task: Any, planner: str, asked: Conditions, events: RunEvents, seed: int, **options: Any
) -> PlanResult:
    """Search for a plan to carry out; Ctrl-C ends the command, as planners answer with what they have, which would be carried out."""
    with passed_on():
        return plan_task(task, planner, seed=seed, seconds=asked.plan_seconds, progress=events.search, **options)


def plan_to_run(task: Any, asked: Conditions, events: RunEvents, seed: int, what: str) -> Plan:
    """The plan of such a search; `what` it was to be, in the error's words.

    Raises:
        NoPlanError: If there is none.
    """
    result = search_to_run(task, asked.planner, asked, events, seed)
    if not result.has_plan:
        raise NoPlanError(asked.planner, task.name, f"{what}: {result.reason}")
    return result.plan


@runtime_checkable
class CarriedOut(Protocol):
    """What happened in a run; it has a JSON form, too."""

    @property
    def work(self) -> Any:
        """The task, or what else of the family was carried out."""

    @property
    def plan(self) -> Plan | None:
        """That it followed; None: work that needs none."""

    @property
    def trace(self) -> Any:
        """Samples of it, with `to_log()`; None where the family keeps none."""

    @property
    def report(self) -> RunReport:
        """What became of it."""

    @property
    def done(self) -> bool:
        """Whether it came to its end."""

    @property
    def reason(self) -> str:
        """Why it did not; empty where it did."""

    @property
    def scene(self) -> LoggedScene | None:
        """The trace in three dimensions, for logs; None where there is none."""

    @property
    def log_gap(self) -> LogGap | None:
        """What its log lacks; None: nothing, or there is no log."""


class TaskRun:
    """Base of runs of a task that end as their report says; they have no fields here."""

    __slots__ = ()
    task: Any
    report: RunReport

    @property
    def work(self) -> Any:
        """What was carried out."""
        return self.task

    @property
    def done(self) -> bool:
        """Whether it came to its end."""
        return self.report.done

    @property
    def reason(self) -> str:
        """Why not; empty where it did."""
        return self.report.reason

    def told(self) -> str:
        """Of what, and how it ended."""
        return f"of {self.work.name!r}: {self.reason or 'done'}, {self.report.seconds:.0f} s"


class Dynamics(ABC):
    """How a family's tasks and plans, and what else it can do, are carried out in contact dynamics."""

    kind: ClassVar[str]
    """What a run is called, such as "climb"."""
    past: ClassVar[str]
    """What a run has done that came to its end, such as "climbed"."""
    replayed: ClassVar[type[Any]]
    """A run of trials once more, with what trials keep of it, as JSON."""
    compiled: ClassVar[tuple[Use, ...]] = ()
    """Uses of kernels that take long to compile, begun while the plan is searched for."""

    def unused(self, work: Any) -> frozenset[str]:
        """Options of `clamber run` and `clamber trials` that have no meaning for a task or for what else is carried out."""
        return frozenset()

    @abstractmethod
    def check(self, work: Any, asked: Conditions) -> None:
        """Refuse what cannot be, before a plan is searched for.

        Raises:
            ClamberError: If the plant, the noise or a fault cannot be as asked for.
        """

    @abstractmethod
    def plan(self, task: Any, asked: RunRequest, events: RunEvents) -> Plan:
        """The plan by which `run` carries a task out that has none, with room for what the dynamics do.

        Raises:
            NoPlanError: If there is none.
        """

    def unfit(self, task: Any) -> str | None:
        """What speaks against carrying out any plan of a task, whatever it is; None where nothing is known."""
        return None

    def untried(self, task: Any) -> str | None:
        """What is said before a task is planned whose robot nobody has tried; None where nothing is."""
        return None

    def in_plane(self, task: Any) -> PlaneClimb | None:
        """A task as a family in space takes it that carries it out in place of this one; None: none can."""
        return None

    def of_plane(self, climb: PlaneClimb) -> Any:
        """The task that states a climb of another family; None: this one has no such tasks."""
        return None

    def objection(self, task: Any, plan: Plan, label: str = "plan") -> str | None:
        """Why `run` refuses a plan, unless it is forced: the step and the limit; None where nothing speaks against it.

        Here: the first violation of a hard check.

        Raises:
            ClamberError: If an action is none that the task's robot and world have.
        """
        verdict = check_plan(task, plan, label=label)
        violated = verdict.first_violation
        return None if violated is None else f"step {violated.step}: {verdict.why(violated)}"

    @abstractmethod
    def run(
        self, work: Any, plan: Plan | None, asked: RunRequest, events: RunEvents, label: str = "plan"
    ) -> CarriedOut:
        """Carry a plan, or the one that is found for the task, out once; returns a `CarriedOut`.

        Args:
            work: A task, or what else the family can carry out.
            plan: Its plan; None: that of `self.plan`.
            asked: How.
            events: Called on the way.
            label: What errors call the plan.

        Raises:
            NoPlanError: If there is no plan that can be carried out.
            ClamberError: If something speaks against the plan, or the request names what there is not.
        """

    @abstractmethod
    def print_run(self, console: Console, run: Any) -> None:
        """Print how a run ended, what became of its actions, and where it was close."""

    @abstractmethod
    def trials(
        self,
        work: Any,
        plan: Plan | None,
        asked: TrialsRequest,
        events: RunEvents,
        store: Path | None = None,
        label: str = "plan",
    ) -> Setup[Any, Any]:
        """What all trials have in common: a work with its plan, that of the store, or the one that is found for the task.

        Raises:
            NoPlanError: If there is no plan that can be carried out.
            StoreError: If the file can't be the store of these trials.
            ClamberError: As `run`.
        """

    @abstractmethod
    def trials_json(self, trials: Any, held_out: bool) -> Any:
        """What `clamber trials --json` prints; `held_out`: whether all seeds are held out from tuning."""

    def replay_json(self, run: Any, trial: Any) -> Any:
        """What `clamber trials --replay SEED --json` prints."""
        return self.replayed(run, trial)

    @abstractmethod
    def print_trials(self, console: Console, trials: Any, seeds: Sequence[int]) -> None:
        """Print how often runs came to their end, why others did not, and the spread of what was measured."""

    def check_picture(self, file: Path) -> None:
        """Make sure that `draw_trials` can write such a file; usually there is no picture of trials.

        Raises:
            NotOfFamilyError: If there is none.
            SuffixError: If it cannot.
        """
        raise NotOfFamilyError(self.kind, "picture of trials; --json and --store keep what they say")

    def draw_trials(self, trials: Any, file: Path) -> None:
        """Draw what trials say together."""
        self.check_picture(file)
