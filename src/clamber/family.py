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
from typing import TYPE_CHECKING, Any, ClassVar, Final, Generic, TypeVar, cast

from .errors import StatedError, describe_choices
from .extensions import ExtensionError, blamed, load_outside, outside

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from .exports.joint_trajectory import Trajectories
    from .files import Document
    from .inspection.finding import Inspection
    from .planning.infeasibility.relaxations import Relaxation
    from .planning.problem.check import Check
    from .planning.problem.plan_source import OpenedPlan
    from .planning.problem.problems import PlanFamily
    from .sim.bench_limb import BenchLimb
    from .sim.lone_robot import JointBounds
    from .tasks.imported import ImportedRobot
    from .tasks.task_format import TaskFormat
    from .trials.dynamics import Dynamics
    from .types import Json
    from .viewing.browser.viewer_content import Scenes
    from .viewing.pictures import Pictures

    Import = Callable[[Path, Path, str], ImportedRobot]
    """Of a model file, the robot file that is to be written, and the robot's name."""

BUILT_IN: Final = {
    "limbed": "clamber.families.climber.family:CLIMBER",
    "spatial": "clamber.families.spatial.family:SPATIAL",
    "walker": "clamber.families.walker.family:WALKER",
}
"""Name in robot files -> module and name of the object, imported when the family is asked for."""


class NotOfFamilyError(StatedError):
    """A family has not what is asked of it."""

    says = "a {title} has no {thing}"
    title: str
    thing: str


Thing = TypeVar("Thing")


class Part(Generic[Thing]):
    """A part of a family as an attribute, imported when it is asked for from where `Family.parts` says.

    Args:
        usual: Of families that do not say, like a value of `Family.parts`; None: they have no such thing.
        derived: What families have that do not say, from their other parts.
    """

    def __init__(self, usual: str | None = None, derived: Callable[[Family], Thing] | None = None) -> None:
        self._usual, self._derived = usual, derived

    def __set_name__(self, owner: type[Any], name: str) -> None:
        self._name = name

    def __get__(self, family: Family, owner: type[Any]) -> Thing:
        path = family.parts.get(self._name, self._usual)
        if path is None and self._derived is not None:
            return self._derived(family)
        return cast(Thing, None if path is None else _named(path))


def _named(path: str) -> Any:
    """What stands in a module under a name, by their path."""
    module, _, name = path.partition(":")
    return getattr(import_module(module), name)


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
    starters: ClassVar[Mapping[str, str]] = MappingProxyType({})
    """The same for commands under `clamber new`: kind of file -> module and function in it."""
    parts: ClassVar[Mapping[str, str]] = MappingProxyType({})
    """Which of the following it has, and where: name -> module and what it is called there, such as "package.module:FILES"."""
    files: Part[TaskFormat] = Part()
    """How its robots, worlds and tasks are read; every family says that."""
    plans: Part[PlanFamily] = Part()
    """How tasks become problems, and how plans are named, judged and reported; every family says that, too."""
    checks: Part[tuple[Check, ...]] = Part(derived=lambda family: family.plans.checks)
    """The checks of its stances, in the order of a replay's margins; stated where `plans` takes much longer to import."""
    relaxations: Part[Callable[[Any], Iterator[Relaxation]] | None] = Part()
    """What can be relaxed in a task, to explain why there is no plan."""
    one_hold_more: Part[Callable[..., Any] | None] = Part()
    """Where one hold more would open a task."""
    printed_plan: Part[Callable[[Path, str | None, tuple[str, ...]], OpenedPlan] | None] = Part()
    """How plans in TOML are read, in place of the JSON that all families write."""
    pictures: Part[Pictures] = Part("clamber.viewing.plain:PICTURES")
    """How stances, plans and runs are drawn; usually a body with lines to its holds."""
    scenes: Part[Scenes] = Part("clamber.viewing.plain:SCENES")
    """How its robots are shown in the viewer, and what is offered there; usually the same in space."""
    trajectories: Part[Trajectories] = Part("clamber.exports.joint_trajectory:BODY")
    """Joint trajectories of plans and of runs; usually the body's of plans."""
    inspection: Part[Inspection | None] = Part()
    """What is told of its robots, worlds and tasks, and what is odd about them."""
    printed: Part[Mapping[str, Any] | None] = Part()
    """What commands print with `--json` about it: words of a command -> dataclasses."""
    dynamics: Part[Dynamics | None] = Part()
    """How its tasks and plans, and what else it can do, are carried out in contact dynamics."""
    bench_limb: Part[Callable[..., BenchLimb] | None] = Part()
    """One limb of a robot for the limb bench, by name, by its place from 1 or None: the first; `upright` says whether weight acts."""
    model: Part[Callable[[Any], tuple[Any, Mapping[str, JointBounds]]] | None] = Part()
    """The robot alone as an `MjSpec`, and the bounds of its joints."""
    first_task: Part[Callable[[str, str, str, Sequence[str]], Json] | None] = Part()
    """What a task file says, of names or files of a robot and a world, the task's name, and overrides; climbers have another way."""
    imports: Part[Mapping[str, Import] | None] = Part()
    """Suffix of another program's model file, such as ".urdf" -> what makes a robot of one."""

    def whole_robot(self, document: Document) -> Document:
        """A robot's document with what it takes from other files, so that it can be built where those are not."""
        return document

    def other_work(self, name_or_path: str, overrides: Sequence[str] = ()) -> Any | None:
        """What can be carried out and is no task, by its name or file, such as a walk; None: it is no such thing."""
        return None

    def other_names(self) -> tuple[str, ...]:
        """Names of such things that come with the family."""
        return ()


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
        made: Family = _named(BUILT_IN[name])
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
