"""What is carried out, by name or file: a task, a plan with its task, or what else a family can do."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

from ..errors import OptionError, SpecError
from ..family import Family, NotOfFamilyError, families, family_of
from ..planning.planners import find_planner
from ..planning.problem.plan import Plan
from ..planning.problem.plan_source import check_name, is_plan, open_plan
from ..planning.problem.verdict import ToRun
from ..tasks import Task, load_task
from ..tasks.library import name_to_type
from .dynamics import Conditions, Dynamics

PLANT: Final = "plant."
"""First word of settings that change the plant."""


def split_settings(settings: Sequence[str]) -> tuple[list[str], list[str]]:
    """Settings of the task, and those of the plant without their "plant."."""
    plant = [text[len(PLANT) :] for text in settings if text.startswith(PLANT)]
    return [text for text in settings if not text.startswith(PLANT)], plant


@dataclass(frozen=True, slots=True, kw_only=True)
class Work:
    """What is carried out, and how its family does it."""

    family: Family
    item: Any
    """A task, or what else the family can carry out, such as a walk."""
    plan: Plan | None
    """Of the task."""
    label: str
    """What errors call it."""
    plant: tuple[str, ...]
    """Settings of the plant, such as "backlash=1deg"."""
    note: str | None = None
    """What is to be told before anything is done."""

    @property
    def dynamics(self) -> Dynamics:
        """How it is carried out.

        Raises:
            NotOfFamilyError: If its family has no contact dynamics.
        """
        return dynamics_of(self.family)

    def check(self, asked: Conditions) -> None:
        """Refuse what cannot be, before a plan is searched for.

        Raises:
            UnknownNameError: If there is no such planner.
            OptionError: If a law is asked for where there are none to choose from.
            ClamberError: As `Dynamics.check`.
        """
        find_planner(asked.planner)
        if asked.law is not None and "law" in self.dynamics.unused(self.item):
            problem = f"'{self.label}' is a {self.dynamics.kind}, whose law cannot be chosen"
            raise OptionError("law", problem, "leave it out; laws are for robots in space")
        self.dynamics.check(self.item, asked)


def dynamics_of(family: Family) -> Dynamics:
    """How a family carries out what it can.

    Raises:
        NotOfFamilyError: If it has no contact dynamics.
    """
    if family.dynamics is None:
        raise NotOfFamilyError(family.title, "contact dynamics")
    return family.dynamics


def to_run(task: Task, plan: Plan, label: str = "plan") -> ToRun | None:
    """Whether `clamber run` would carry a plan out; None where the task's family has no contact dynamics.

    Args:
        task: In which it is to be carried out.
        plan: The plan.
        label: What errors call it.

    Raises:
        ClamberError: If the task's start violates a hard check, or an action is none that its robot and world have.
    """
    dynamics = family_of(task).dynamics
    if dynamics is None:
        return None
    if (unfit := dynamics.unfit(task)) is not None:
        return ToRun(False, unfit, None)
    why = dynamics.objection(task, plan, label)
    return ToRun(why is None, why, None if why is None else f"clamber plan {name_to_type(task)} --to-run")


def open_work(what: str, task: str | None = None, settings: Sequence[str] = (), *, force: bool = False) -> Work:
    """What a name or a file means; a task that its family's control is not fit for is another's that is, where there is one.

    Args:
        what: A task's or a plan's name or file, or that of what else a family can carry out, such as a walk.
        task: A task in place of the one that the plan names.
        settings: Texts "key=value" for the task, and for the plant where they start with `plant.`.
        force: Whether it is carried out by its own family all the same.

    Raises:
        SpecError: If a plan's task is given beside a task.
        UnknownNameError: If there is no such name.
        ClamberError: As `open_plan` and `load_task`.
    """
    for_task, for_plant = split_settings(settings)
    check_name(what, tuple(name for family in families() for name in family.other_names()))
    plan = note = None
    for family in families():
        item = family.other_work(what, for_task)
        if item is not None:
            break
    else:
        if is_plan(what):
            opened = open_plan(what, task, for_task)
            item, plan = opened.task, opened.plan
        else:
            item = load_task(what, for_task)
            if task is not None:
                raise SpecError(what, "--task", task, "is for a plan; this is a task itself")
        family = family_of(item)
        if plan is None and not force:
            family, item, note = fit_family(family, item)
    return Work(family=family, item=item, plan=plan, label=what, plant=tuple(for_plant), note=note)


def fit_family(family: Family, task: Task) -> tuple[Family, Task, str | None]:
    """The family that carries a task out, the task as it has it, and why that is not its own, or that its robot is untried."""
    dynamics = family.dynamics
    unfit = None if dynamics is None else dynamics.unfit(task)
    climb = None if unfit is None or dynamics is None else dynamics.in_plane(task)
    for other in families():
        stated = None if climb is None or other.dynamics is None else other.dynamics.of_plane(climb)
        if stated is not None:
            return other, stated, f"{unfit}; it is planned and carried out as a {other.title}"
    return family, task, None if dynamics is None or unfit is not None else dynamics.untried(task)
