"""What kind of thing a file or a name means, and the inspection of it."""

from collections.abc import Callable, Sequence
from typing import Any, Final

from ..actions.plan_source import is_plan, plan_names
from ..errors import SpecError, UnknownNameError, describe_choices
from ..files import is_path, read_toml
from ..regular_files import user_path
from ..robots import load_robot
from ..robots.library import robot_names
from ..tasks import load_task, task_names
from ..tasks.walks import load_walk
from ..tasks.walks.library import walk_names
from ..worlds import board_names, ground_names, load_board, load_ground
from .finding import Finding, Kind
from .robots import inspect_robot
from .tasks import inspect_task, inspect_walk
from .worlds import inspect_board, inspect_ground

SCHEMAS: Final[dict[str, Kind]] = {
    "clamber-robot-1": "robot",
    "clamber-board-1": "board",
    "clamber-ground-1": "ground",
    "clamber-task-1": "task",
    "clamber-walk-1": "walk",
    "clamber-plan-1": "plan",
}
NAMES: Final[dict[Kind, Callable[[], tuple[str, ...]]]] = {
    "plan": plan_names,
    "task": task_names,
    "walk": walk_names,
    "robot": robot_names,
    "board": board_names,
    "ground": ground_names,
}
"""Kind -> names that come with Clamber; where two kinds have one, the first counts."""
LOADERS: Final[dict[Kind, tuple[Callable[[str], Any], Callable[[Any], Finding]]]] = {
    "robot": (load_robot, inspect_robot),
    "board": (load_board, inspect_board),
    "ground": (load_ground, inspect_ground),
    "task": (load_task, inspect_task),
    "walk": (load_walk, inspect_walk),
}


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
        for kind, names in NAMES.items():
            if name_or_path in names():
                return kind
        known = dict.fromkeys(name for names in NAMES.values() for name in names())
        raise UnknownNameError("thing", name_or_path, tuple(known))
    path = user_path(name_or_path)
    if path.suffix == ".csv":
        return "board"
    document = read_toml(path)
    schema = document.data.get("schema")
    if not isinstance(schema, str) or schema not in SCHEMAS:
        raise document.problem("schema", f"must be one of {describe_choices(str(schema), SCHEMAS)}")
    return SCHEMAS[schema]


def inspect_file(name_or_path: str, kind: Kind | None = None, overrides: Sequence[str] = ()) -> Finding:
    """Load a robot, board, ground, task or walk with all its checks, and say what is odd about it.

    Args:
        name_or_path: Its name or file.
        kind: What it must be; None: what it is.
        overrides: Texts "key=value" that change a task.

    Raises:
        ClamberError: If it breaks a rule of its format; the error names file and key.
    """
    found = kind or kind_of(name_or_path)
    if found not in LOADERS:
        raise SpecError(name_or_path, "schema", found, f"must be one of {', '.join(LOADERS)}; a plan is replayed")
    if found == "task":
        return inspect_task(load_task(name_or_path, overrides))
    load, inspect = LOADERS[found]
    return inspect(load(name_or_path))
