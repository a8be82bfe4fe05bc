"""Families of robots: all that depends on a kind of robot stands behind one object, found by its name.

The folders of `families/` hold those that come with Clamber; other packages add theirs by the entry point `clamber.families`.
No other folder imports a family: whoever needs one asks here.
"""

from __future__ import annotations

from contextlib import suppress
from functools import cache
from importlib import import_module
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, Final

from .errors import ClamberError, describe_choices
from .extensions import ExtensionError, blamed, load_outside, outside

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from .exports.joint_trajectory import Trajectories
    from .files import Document
    from .inspection.finding import Inspection
    from .planning.openings.relaxations import Relaxation
    from .planning.problem.check import Check
    from .planning.problem.plan_source import OpenedPlan
    from .planning.problem.problems import PlanFamily
    from .sim.bench_limb import BenchLimb
    from .sim.lone_robot import JointBounds
    from .tasks.imported import ImportedRobot
    from .tasks.task_format import TaskFormat
    from .trials.dynamics import Dynamics
    from .viewing.browser.exhibit import Scenes
    from .viewing.pictures import Pictures

    Import = Callable[[Path, Path, str], ImportedRobot]
    """Of a model file, the robot file that is to be written, and the robot's name."""

BUILT_IN: Final = {
    "limbed": "clamber.families.climber.family:CLIMBER",
    "walker": "clamber.families.walker.family:WALKER",
}
"""Name in robot files -> module and name of the object, imported when the family is asked for."""


class NotOfFamilyError(ClamberError):
    """A family has not what is asked of it."""

    def __init__(self, title: str, thing: str) -> None:
        super().__init__(title, thing)
        self.title, self.thing = title, thing

    def __str__(self) -> str:
        return f"a {self.title} has no {self.thing}"


class Family:
    """One kind of robot. Each part is imported when it is asked for; None: the family has no such thing."""

    name: ClassVar[str]
    """As `family` in robot files calls it."""
    title: ClassVar[str]
    """Such as "two-frame walker"."""
    data: ClassVar[Path | None] = None
    """Folder with its robots, worlds, tasks and plans that come with it, in folders of those names."""
    commands: ClassVar[Mapping[str, str]] = MappingProxyType({})
    """Commands that only it has: name -> module and function in it, such as "package.module:function"."""
    groups: ClassVar[Mapping[str, str]] = MappingProxyType({})
    """The same for commands of commands: name -> module and Typer application in it."""

    @property
    def files(self) -> TaskFormat:
        """How its robots, worlds and tasks are read."""
        raise NotImplementedError

    @property
    def checks(self) -> tuple[Check, ...]:
        """The checks of its stances, in the order of a replay's margins."""
        return self.plans.checks

    @property
    def plans(self) -> PlanFamily:
        """How tasks become problems, and how plans are named, judged and reported."""
        raise NotImplementedError

    @property
    def relaxations(self) -> Callable[[Any], Iterator[Relaxation]] | None:
        """What can be relaxed in a task, to explain why there is no plan."""
        return None

    @property
    def one_hold_more(self) -> Callable[..., Any] | None:
        """Where one hold more would open a task."""
        return None

    @property
    def printed_plan(self) -> Callable[[Path, str | None, tuple[str, ...]], OpenedPlan] | None:
        """How plans in TOML are read, in place of the JSON that all families write."""
        return None

    @property
    def pictures(self) -> Pictures:
        """How stances, plans and runs are drawn; usually a body with lines to its holds."""
        from .viewing.plain import PICTURES

        return PICTURES

    @property
    def scenes(self) -> Scenes:
        """How its robots are shown in the viewer, and what is offered there; usually the same in space."""
        from .viewing.plain import SCENES

        return SCENES

    @property
    def trajectories(self) -> Trajectories:
        """Joint trajectories of plans and of runs; usually the body's of plans."""
        from .exports.joint_trajectory import BODY

        return BODY

    @property
    def inspection(self) -> Inspection | None:
        """What is told of its robots, worlds and tasks, and what is odd about them."""
        return None

    @property
    def printed(self) -> Mapping[str, Any]:
        """What commands print with `--json` about it: words of a command -> dataclasses."""
        return {}

    @property
    def dynamics(self) -> Dynamics | None:
        """How its tasks and plans, and what else it can do, are carried out in contact dynamics."""
        return None

    @property
    def imports(self) -> Mapping[str, Import]:
        """Suffix of another program's model file, such as ".urdf" -> what makes a robot of one."""
        return {}

    def whole_robot(self, document: Document) -> Document:
        """A robot's document with what it takes from other files, so that it can be built where those are not."""
        return document

    def other_work(self, name_or_path: str, overrides: Sequence[str] = ()) -> Any | None:
        """What can be carried out and is no task, by its name or file, such as a walk; None: it is no such thing."""
        return None

    def other_names(self) -> tuple[str, ...]:
        """Names of such things that come with the family."""
        return ()

    @property
    def bench_limb(self) -> Callable[..., BenchLimb] | None:
        """One limb of a robot for the limb bench, by name, by its place from 1 or None: the first; `upright` says whether weight acts."""
        return None

    @property
    def model(self) -> Callable[[Any], tuple[Any, Mapping[str, JointBounds]]] | None:
        """The robot alone as an `MjSpec`, and the bounds of its joints."""
        return None


def family_names() -> tuple[str, ...]:
    """Names of the families that there are."""
    return tuple(sorted({*BUILT_IN, *outside("families")}))


@cache
def family_named(name: str) -> Family:
    """The family of a name.

    Raises:
        KeyError: If there is none.
        ExtensionError: If another package's cannot be loaded.
    """
    if name in BUILT_IN:
        module, _, attribute = BUILT_IN[name].partition(":")
        made: Family = getattr(import_module(module), attribute)
        return made
    if name not in outside("families"):
        raise KeyError(name)
    theirs = load_outside("families", name)
    with blamed("families", name):
        if not isinstance(theirs, Family):
            raise TypeError(f"is a {type(theirs).__name__}, not a clamber.family.Family")
    return theirs


def families() -> tuple[Family, ...]:
    """All families, those that come with Clamber first.

    One of another package that cannot be loaded is left out, so that it takes no other family with it; who names it is told why.
    """
    found = [family_named(name) for name in BUILT_IN]
    for name in family_names():
        if name not in BUILT_IN:
            with suppress(ExtensionError):
                found.append(family_named(name))
    return tuple(found)


def family_of(task: Any) -> Family:
    """The family of a task's robot."""
    return family_named(task.document["robot"]["family"])


def named_family(name: object) -> Family | None:
    """The family of a name that a file states, or None: there is none of that name."""
    return family_named(name) if isinstance(name, str) and name in family_names() else None


def known_families(name: object) -> str:
    """What may stand for a family's name, for errors about `name`."""
    return f"must be one of {describe_choices(str(name), family_names())}"
