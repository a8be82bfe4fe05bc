"""What kind of thing a file or a name means, and the inspection of it."""

from collections.abc import Sequence
from typing import Final

from ..errors import SpecError, UnknownNameError, describe_choices
from ..family import NotOfFamilyError, families
from ..files import Document, is_path, read_toml
from ..planning.problem.plan_source import is_plan, plan_names
from ..regular_files import user_path
from ..tasks import load_task, task_names
from ..tasks.robots import family_in, read_robot, robot_names
from .finding import FileKind, Finding, Kind
from .tasks import inspect_task

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
    return family.inspection.robot(family.files.build_robot(document))


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
        raise UnknownNameError("thing", name_or_path, tuple(known))
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
        return kinds[found].inspect(kinds[found].load(name_or_path))
    raise SpecError(
        name_or_path, "schema", found, f"must be one of {', '.join(('robot', 'task', *kinds))}; a plan is replayed"
    )
