"""What kind of thing a file or a name means, and the inspection of it."""

import math
from collections.abc import Iterator, Sequence
from typing import Any, Final

import numpy as np

from ..errors import SpecError, StartError, describe_choices
from ..family import Family, NotOfFamilyError, families, family_of, named_family
from ..files import Document, is_path, read_toml, unknown_name
from ..planning.problem.body_pose import describe_body_pose
from ..planning.problem.check import UNLIMITED
from ..planning.problem.codes import pack
from ..planning.problem.plan_source import is_plan, plan_names
from ..planning.problem.problem import CompiledProblem
from ..planning.problem.problems import plan_family
from ..regular_files import user_path
from ..shown_units import SI, units_of
from ..tasks import Task, load_task, task_names
from ..tasks.library import change_task
from ..tasks.robots import family_in, read_robot, robot_names
from ..types import Json
from .finding import FileKind, Finding, Kind, Margin

LENIENT: Final = ("rules.hard=[]",)
"""With hard checks, a start that violates one is an error."""


def _started(task: Task) -> CompiledProblem:
    """The task's problem; where its start breaks a hard check, that of the task without them."""
    family = plan_family(task)
    try:
        return family.problem(task)
    except (SpecError, StartError):
        return family.problem(change_task(task, LENIENT))


def start_margins(task: Task, problem: CompiledProblem | None = None) -> tuple[Margin, ...]:
    """Every check of the start stance, those that it violates too, in the order of the family's checks; None: the problem is posed anew."""
    family = plan_family(task)
    replay = (problem or _started(task)).replay(np.array([pack(0)], np.int32), go_on=True)
    hard = family.hard(task)
    return tuple(
        Margin(
            check=check.name,
            unit=check.unit,
            margin=None if math.isnan(margin) or abs(margin) >= UNLIMITED else float(margin),
            hard=check.name in hard,
            meaning=check.meaning,
        )
        for check, margin in zip(family.checks, replay.margins[0], strict=True)
    )


def inspect_task(task: Task) -> Finding:
    """Facts of a task, whether its start holds and by how much, and what is odd about it."""
    problem = _started(task)  # once: a start in space is looked for among many sets of holds
    margins = start_margins(task, problem)
    family, units = plan_family(task), units_of(task.document)
    start = describe_body_pose(family.pose_axes, family.pose(task, problem.start[0]), units)
    facts = {
        "robot": task.robot.name,
        "world": task.world.name,
        "start": start,
        "goals": ", ".join(goal.name or "unnamed" for goal in task.goals),
        "hard checks": ", ".join(margin.check for margin in margins if margin.hard) or "none",
    }
    return Finding(
        kind="task", name=task.name, title=task.title, facts=facts, odd=tuple(_odd(task, problem, margins)), margins=margins, units=units
    )  # fmt: skip


def _odd(task: Task, problem: CompiledProblem, margins: tuple[Margin, ...]) -> Iterator[str]:
    hard = {margin.check for margin in margins if margin.hard}
    if not hard:
        yield "no check is hard: any action is allowed"
    starts_done = all(margin.holds for margin in margins if margin.hard) and problem.is_done(problem.start)
    if starts_done:
        yield "the start meets the goal: the shortest plan has no actions"
    inspection = family_of(task).inspection
    if inspection is not None:
        yield from inspection.odd_task(task, hard)


SCHEMAS: Final[dict[str, Kind]] = {"clamber-robot-1": "robot", "clamber-task-1": "task", "clamber-plan-1": "plan"}
"""What a file says that it is -> its kind; families have others."""


def file_kinds() -> dict[Kind, FileKind]:
    """The kinds of files that only one family has."""
    inspections = (family.inspection for family in families())
    return {name: kind for one in inspections if one is not None for name, kind in one.kinds.items()}


def _names() -> dict[Kind, tuple[str, ...]]:
    """Kind -> names that come with Clamber; where two kinds have one, the first counts."""
    theirs = {name: kind.names() for name, kind in file_kinds().items()}
    return {"plan": plan_names(), "task": task_names(), "walk": theirs.pop("walk"), "robot": robot_names(), **theirs}


def _inspect_robot(document: Document) -> Finding:
    family = family_in(document)
    if family.inspection is None:
        raise NotOfFamilyError(family.title, "facts to tell of a robot")
    return family.inspection.robot(family.files.build_robot(document), units_of(document.data))


def kind_of(name_or_path: str) -> Kind:
    """What a file, or a name of something that comes with Clamber, is.

    Raises:
        FileError: If the file cannot be read.
        SpecError: If the file does not say what it is.
        UnknownNameError: If nothing has that name.
    """
    if is_plan(name_or_path):
        return "plan"
    if not is_path(name_or_path):
        shipped = _names()
        for kind, names in shipped.items():
            if name_or_path in names:
                return kind
        known = dict.fromkeys(name for names in shipped.values() for name in names)
        raise unknown_name(f"{', '.join(list(shipped)[:-1])} or {list(shipped)[-1]}", name_or_path, tuple(known))
    path = user_path(name_or_path)
    kinds = file_kinds()
    for kind, files in kinds.items():
        if path.suffix in files.suffixes:
            return kind
    document = read_toml(path)
    schema = document.data.get("schema")
    schemas = SCHEMAS | {files.schema: kind for kind, files in kinds.items()}
    if not isinstance(schema, str) or schema not in schemas:
        raise document.problem("schema", f"must be one of {describe_choices(str(schema), schemas)}")
    return schemas[schema]


def _document(name_or_path: str, kind: Kind) -> Json:
    """What the file of a family's world says; empty for other kinds, whose quantities are shown in SI."""
    reads = (family.files.read_world for family in families() if family.files.world_key == kind)
    return next((read(name_or_path, None).data for read in reads), {})


def family_of_thing(thing: Any) -> Family | None:
    """The family of a robot, or of what only one family has, such as a board; None: it is neither."""
    return named_family(getattr(thing, "family", None)) or next(
        (
            one
            for one in families()
            if one.inspection is not None and getattr(thing, "kind", None) in one.inspection.kinds
        ),
        None,
    )


def inspect_thing(thing: Any) -> Finding | None:
    """What is to be said of a task, a robot, a world or a walk as Python has it, in SI units; None: it is none of them."""
    if isinstance(thing, Task):
        return inspect_task(thing)
    family = family_of_thing(thing)
    if family is None or family.inspection is None:
        return None
    if hasattr(thing, "family"):
        return family.inspection.robot(thing, SI)
    return family.inspection.kinds[thing.kind].inspect(thing, SI)


def inspect_file(name_or_path: str, kind: Kind | None = None, overrides: Sequence[str] = ()) -> Finding:
    """Load a robot, board, ground, task or walk with all its checks, and say what is odd about it.

    Args:
        name_or_path: Its name or file.
        kind: What it must be; None: what it is.
        overrides: Texts "key=value" that change a task.

    Raises:
        ClamberError: If it breaks a rule of its format; the error names file and key.
    """
    found, kinds = kind or kind_of(name_or_path), file_kinds()
    if found == "task":
        return inspect_task(load_task(name_or_path, overrides))
    if found == "robot":
        return _inspect_robot(read_robot(name_or_path))
    if found in kinds:
        return kinds[found].inspect(kinds[found].load(name_or_path), units_of(_document(name_or_path, found)))
    raise SpecError(
        name_or_path, "schema", found, f"must be one of {', '.join(('robot', 'task', *kinds))}; a plan is replayed"
    )
