"""What the viewer shows and offers: each family's `Scenes`, and what names and files of tasks, plans, other work and logs mean."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Final, Protocol

from ...errors import SpecError
from ...execution.log import Log, LogError
from ...execution.log_files import SUFFIXES, read_log
from ...family import NotOfFamilyError, families, family_of
from ...inspection.open_file import kind_of
from ...planning.planners import plan_task
from ...planning.problem.plan import Plan
from ...planning.problem.plan_source import open_plan
from ...planning.problem.problem import Replay
from ...planning.progress import Listener
from ...tasks import load_task
from ...trials.dynamics import CarriedOut
from ..alone import Alone, ShownAlone, open_alone, shown_alone
from ..pictures import carried_out, pictures_of
from ..recording import Recording, StillFilm, View
from ..scene import Bounds
from .solids import LoneScenery, Scenery

if TYPE_CHECKING:
    import viser

    from .scene_view import SceneView
    from .work_panel import Tell

NAMED: Final = "name the task, plan or walk that it was made with beside it"


@dataclass(slots=True, eq=False)
class ViewerContent:
    """A world with a robot, a plan and a run of it, as far as there are any."""

    title: str
    scenery: Scenery
    plan_film: Recording[Any] | None
    """Of the start alone where there is no plan; None for the log of work that has no plan."""
    run_film: Recording[Any] | None = None
    task: Any = None
    """The task, or what else the family can carry out, that can be edited, planned and run; None: there is none."""
    plan: Plan | None = None
    planned: bool = True
    """Whether it is planned before it is run."""

    @property
    def main(self) -> Recording[Any]:
        """What is played first: the run, if there is one."""
        film = self.run_film or self.plan_film
        assert film is not None  # an exhibit has one of them at least
        return film


@dataclass(frozen=True, slots=True, eq=False)
class Planned:
    """What came of planning."""

    plan: Plan | None
    words: str
    """What was found, or why not."""


class Editor(Protocol):
    """The part of the panel that edits a world; what it makes goes to the `changed` that it was given."""

    def task(self) -> Any:
        """The task, or the other work, as it is now.

        Raises:
            ClamberError: If what was edited makes none.
        """
        ...


class Scenes(ABC):
    """How the viewer shows one family of robots, and what it offers to do with them; only `scenery` has no usual answer."""

    tab: ClassVar[str] = "Work"
    """Title of the panel's tab that edits, plans and runs."""
    kernel: ClassVar[str] = ""
    """Name of a kernel that is compiled once such a robot has moved on this machine; empty: none is."""
    keeps_reserves: ClassVar[bool] = False
    """Whether `plan_with_reserves` does more than `plan`."""

    @abstractmethod
    def scenery(self, task: Any, bounds: Bounds) -> Scenery:
        """World and robot of a task; `bounds` is the part of the world that a plan needs."""

    def film(self, view: View[Any]) -> Recording[Any]:
        """What is played of a plan."""
        return view

    def exhibit(self, task: Any, plan: Plan | Replay | None, label: str = "plan") -> ViewerContent:
        """A task, or other work, with a plan or its replay, violations and all; without one, its start.

        Raises:
            ClamberError: If the plan has actions that the task has not, or the start violates a hard check.
        """
        view = pictures_of(task).view(task, carried_out(task, plan, label))
        kept = plan if isinstance(plan, Plan) else None
        return ViewerContent(view.title, self.scenery(task, view.bounds), self.film(view), task=task, plan=kept)

    def run_film(self, exhibit: ViewerContent, run: Any) -> Recording[Any]:
        """What was just carried out."""
        raise NotOfFamilyError(family_of(exhibit.task).title, "film of its runs")

    def with_log(self, exhibit: ViewerContent, log: Log) -> ViewerContent:
        """The same with a log's run.

        Raises:
            ClamberError: If the log is no such robot's.
        """
        raise NotOfFamilyError(family_of(exhibit.task).title, "film of its logs")

    def made_with(self, log: Log) -> str | None:
        """Name of the task or other work that a log of this family says it was made with, empty if it says none; None: it is of another."""
        return None

    def editor(
        self, server: "viser.ViserServer", task: Any, stage: "SceneView", changed: Callable[[Any], None]
    ) -> Editor:
        """Make the controls that edit a task's world, start and goal; the usual ones edit nothing.

        Args:
            server: Whose panel they are in; they are made where its context is.
            task: As it was.
            stage: Shows it.
            changed: Takes a task as it was edited, and may refuse it by an error.
        """
        return _Fixed(task)

    def plan(self, task: Any, planner: str, seconds: float, progress: Listener) -> Planned:
        """Plan a task; `seconds` is the most time for each search [s].

        Raises:
            ClamberError: If the planner cannot work on the task, or the start violates a hard check.
        """
        result = plan_task(task, planner, seed=0, seconds=seconds, progress=progress)
        if not result.has_plan:
            return Planned(None, f"{result.status}: no plan. {result.reason}")
        words = f"{result.status}: {result.length} actions, {result.seconds:.1f} s. {result.reason}"
        return Planned(result.plan, words)

    def plan_with_reserves(self, task: Any, planner: str, seconds: float, progress: Listener, tell: "Tell") -> Planned:
        """The same for a plan that keeps something back, so that it can be carried out; it takes longer."""
        return self.plan(task, planner, seconds, progress)

    def still(self, alone: Alone) -> Any:
        """The moment of a robot that is shown alone."""
        return alone.at

    def outcome(self, run: Any) -> str:
        """How a run went, in words."""
        return "done" if run.done else f"not done: {run.reason}"


@dataclass(frozen=True, slots=True)
class _Fixed:
    """What a family without an editor offers: the task as it is."""

    made: Any

    def task(self) -> Any:
        """See `Editor`."""
        return self.made


def open_exhibit(things: Sequence[str], task: str | None = None, overrides: Sequence[str] = ()) -> ViewerContent:
    """What some names and files mean together.

    Args:
        things: A task, a plan, a walk, a robot, a world or a log of a run, or a log and what it was made with, in any order.
        task: Name or path of a task in place of the one that the plan names.
        overrides: Texts "key=value" that change the task.

    Raises:
        SpecError: If two of them are of one kind, or do not belong together.
        ClamberError: As `open_plan`, `load_task`, `Family.other_work` and `read_log`.
    """
    logs = [thing for thing in things if Path(thing).suffix.lower() in SUFFIXES]
    others = [thing for thing in things if thing not in logs]
    for kind, found in (("logs", logs), ("tasks, plans or walks", others)):
        if len(found) > 1:
            raise SpecError(
                "clamber view", kind, ", ".join(found), "one can be shown at a time; a log may be beside it"
            )
    log = read_log(Path(logs[0])) if logs else None
    what = others[0] if others else _made_with(log) if log is not None else None
    if what is None:
        raise SpecError(
            "clamber view",
            "nothing to show",
            "",
            "name a task, a plan, a walk, a robot, a board, a ground or a log of a run",
        )
    exhibit = _opened(what, task, overrides)
    if log is None:
        return exhibit
    if exhibit.task is None:
        raise SpecError("clamber view", what, exhibit.title, f"was not made with a log: {NAMED}")
    return family_of(exhibit.task).scenes.with_log(exhibit, log)


def _opened(what: str, task: str | None, overrides: Sequence[str]) -> ViewerContent:
    other = next((made for family in families() if (made := family.other_work(what, overrides)) is not None), None)
    if other is not None:
        return exhibit_of(other)
    if shown_alone(kind := kind_of(what)):
        return alone_exhibit(open_alone(what, kind))
    if kind != "plan":
        return exhibit_of(load_task(what, overrides))
    opened = open_plan(what, task, overrides)
    return exhibit_of(opened.task, opened.plan, what)


def alone_exhibit(shown: ShownAlone) -> ViewerContent:
    """A robot or a world alone: nothing is edited, planned or run."""
    alone, finding = shown.alone, shown.finding
    scenes, name = family_of(alone.task).scenes, f"{finding.kind} '{finding.name}'"
    at = None if alone.at is None else scenes.still(alone)
    film = StillFilm(at, name, tuple(finding.facts.items()), finding.title or name)
    whole = scenes.scenery(alone.task, alone.bounds)
    return ViewerContent(film.title, LoneScenery(alone.bounds, whole, robot=alone.at is not None), film)


def exhibit_of(task: Any, plan: Plan | Replay | None = None, label: str = "plan") -> ViewerContent:
    """A task, or what else a family can carry out, with a plan if there is one; see `Scenes.exhibit`."""
    return family_of(task).scenes.exhibit(task, plan, label)


def run_exhibit(run: CarriedOut) -> ViewerContent:
    """What was just carried out, beside its plan where it has one."""
    scenes = family_of(run.work).scenes
    exhibit = scenes.exhibit(run.work, getattr(run, "plan", None))
    exhibit.run_film = scenes.run_film(exhibit, run)
    return exhibit


def _made_with(log: Log) -> str:
    """The name of the task or other work that a log was made with, if it comes with Clamber."""
    for family in families():
        found = family.scenes.made_with(log)
        if found:
            return found
    raise LogError(log.label, None, None, None, f"does not say what it was made with; {NAMED}")
