"""Plans by name or from files of either kind, each with the task that it is for: what `clamber plan` wrote, and printed plans."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...family import families
from ...files import Document, data_names, find_data, is_path, read_toml, unknown_name
from ...regular_files import is_file
from ...tasks import Task, load_task, task_names
from ...tasks.overrides import apply_overrides
from ...tasks.robots import family_in, shipped
from ...types import Ints
from .plan import Plan, load_plan
from .problem import Replay
from .problems import plan_family
from .verdict import Verdict, check_plan


@dataclass(frozen=True, slots=True, kw_only=True)
class OpenedPlan:
    """A plan that was read, and what it takes to carry it out."""

    task: Task
    plan: Plan
    label: str
    """What errors call the plan: the path of its file."""
    asked: Ints | None = None
    """Packed codes with "nearest" as it stands in the file, where the file also prints the pegs taken."""
    notes: tuple[str, ...] = ()
    """What was read in a way that the reader should know of."""

    def check(self, *, go_on: bool = False) -> Verdict:
        """The verdict on it."""
        return check_plan(self.task, self.plan, go_on=go_on, asked=self.asked, notes=self.notes, label=self.label)


def plan_names() -> tuple[str, ...]:
    """Names of the printed plans that come with Clamber."""
    return tuple(sorted(name for folder in shipped("plans") for name in data_names(folder)))


def is_plan(name_or_path: str) -> bool:
    """Whether a text means a plan rather than a task: a shipped plan's name, a JSON file, or a TOML file with a list of actions."""
    path = Path(name_or_path)
    if path.suffix == ".json" or name_or_path in plan_names():
        return True
    return path.suffix == ".toml" and is_file(path) and "actions" in read_toml(path).data


def check_name(what: str, walks: tuple[str, ...] = ()) -> None:
    """Make sure that what looks like a name is that of a task or a plan, or of a walk where those are taken.

    Args:
        what: A name or a path.
        walks: Names of walks that are taken, too.

    Raises:
        UnknownNameError: If it is no such name; it lists them all.
    """
    known = (*task_names(), *plan_names(), *walks)
    if not is_path(what) and not is_plan(what) and what not in known:
        raise unknown_name("task, plan or walk" if walks else "task or plan", what, known)


def open_plan(name_or_path: str | Path, task: str | None = None, overrides: Sequence[str] = ()) -> OpenedPlan:
    """A plan by its shipped name or from its file, with its task.

    Args:
        name_or_path: A name such as "ladder-hand", JSON as `Plan.save` writes it, or TOML with the thesis's numbers.
        task: Name or path of a task in place of the one that the plan names.
        overrides: Texts "key=value" that change the task.

    Raises:
        FileError: If the file cannot be read.
        SpecError: If the file, the task or an override says something that cannot be used.
        UnknownNameError: If there is no such task.
    """
    path = Path(name_or_path)
    if str(name_or_path) in plan_names():
        path, _ = find_data("plan", str(name_or_path), shipped("plans"))
    if path.suffix == ".toml":
        return _open_printed(path, task, tuple(overrides))
    label = str(path)
    plan = load_plan(path)
    if task is not None:
        return OpenedPlan(task=load_task(task, overrides), plan=plan, label=label)
    own = plan.rebuild_task(label)
    return OpenedPlan(task=_changed(own, overrides, label) if overrides else own, plan=plan, label=label)


def open_replay(name_or_path: str, task: str | None = None, overrides: Sequence[str] = ()) -> tuple[Task, Replay]:
    """A task and a plan carried out in it, violations and all; of a task alone, its start.

    Args:
        name_or_path: A plan's or a task's name or file.
        task: Name or path of a task in place of the one that the plan names.
        overrides: Texts "key=value" that change the task.

    Raises:
        ClamberError: As `open_plan` and `load_task`.
    """
    if not is_plan(name_or_path):
        shown = load_task(name_or_path, overrides)
        return shown, plan_family(shown).problem(shown).replay(np.zeros(0, np.int32))
    opened = open_plan(name_or_path, task, overrides)
    codes = opened.plan.codes(opened.task, opened.label)
    return opened.task, plan_family(opened.task).problem(opened.task).replay(codes, go_on=True)


def _open_printed(path: Path, name: str | None, overrides: tuple[str, ...]) -> OpenedPlan:
    read = next(family.printed_plan for family in families() if family.printed_plan is not None)
    return read(path, name, overrides)


def _changed(task: Task, overrides: Sequence[str], label: str) -> Task:
    """A task with overrides on its stored document."""
    document = Document(f"{label}: document", task.document)
    files = family_in(document.section("robot", f"{label}: document.robot")).files
    keys = (*files.task_keys, "robot", files.world_key)
    changed: Task = files.build(apply_overrides(document, overrides, keys, files.robot_keys, files.short_keys))
    return changed
