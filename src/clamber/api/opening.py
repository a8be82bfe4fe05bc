"""What an argument of the functions means: a name, a file, or what another function gave."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ..errors import OptionError, PlannerError
from ..family import family_of
from ..files import as_text
from ..inspection.open_file import file_kinds, kind_of
from ..planning.problem.plan import Plan
from ..planning.result import PlanResult
from ..trials.work import Work, fit_family, open_work


def load_world(name_or_path: str) -> Any:
    """A board, a ground or a world in space by its shipped name, such as "ladder", or from a file of its own.

    Args:
        name_or_path: Name or file; where several kinds have a name, `load_board` and `load_ground` choose.

    Raises:
        OptionError: If it is something else.
        ClamberError: If it cannot be had, or breaks a rule of its format.
    """
    name_or_path, worlds = as_text(name_or_path), file_kinds()
    # a task has the name of its world often, and is what the name means elsewhere
    named = [kind for kind, files in worlds.items() if name_or_path in files.names() and kind != "walk"]
    kind = named[0] if named else kind_of(name_or_path)
    if kind not in worlds or kind == "walk":
        raise OptionError("name_or_path", f"'{name_or_path}' is a {kind}", "give a board, a ground or a world in space")
    return worlds[kind].load(name_or_path)


def work_of(what: Any, task: str | None = None, plant: Sequence[str] = (), *, force: bool = False) -> Work:
    """What is carried out: a task, a plan with its task, or what else a family can do, such as a walk; see `open_work`.

    Args:
        what: Its name or file, or what `load_task`, `load_walk`, `load_plan` or `plan` gave.
        task: Of a plan's name or file: the task that it is for, in place of its own.
        plant: Settings of the simulated robot, such as "backlash=1deg".
        force: Whether a task is carried out by its own family even where that is not fit for it.

    Raises:
        OptionError: If it is none of these.
        PlannerError: If it is an answer without a plan.
        ClamberError: If it cannot be had.
    """
    if isinstance(what, str | Path):
        return open_work(str(what), task, [f"plant.{text}" for text in plant], force=force)
    item, plan = what, None
    if isinstance(what, PlanResult):
        if not what.has_plan:
            raise PlannerError(what.planner, what.task.name, f"there is no plan to carry out: {what.reason}")
        item, plan = what.task, what.plan
    elif isinstance(what, Plan):
        item, plan = what.rebuild_task(), what
    if not hasattr(item, "document"):
        raise OptionError.of_value("what", what, "is no task, plan or walk", "give one, or its name or file")
    family, label = family_of(item), item.name
    if plan is None and not force:
        family, item, _ = fit_family(family, item)
    return Work(family=family, item=item, plan=plan, label=label, plant=tuple(plant))
