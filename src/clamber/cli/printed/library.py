"""What each command prints: its words, and the kinds of values that come out with `--json`."""

from dataclasses import dataclass
from functools import cache
from typing import Any, Final

from pydantic import TypeAdapter, create_model

from ...errors import UnknownNameError
from ...exports.library import Exported
from ...family import families
from ...inspection.finding import Finding
from ...limb_bench.excitation import Recorded
from ...limb_bench.force import ForceResult
from ...limb_bench.open_loop import OpenLoopResult
from ...limb_bench.portrait import Portraits
from ...limb_bench.result import LimbResult
from ...limb_bench.sweep import LimbSweep
from ...limb_bench.tune import Tuning
from ...planning.exact.front import Front
from ...planning.learning import Lesson
from ...planning.problem.problems import SizedInventory
from ...planning.problem.verdict import CheckedPlan
from ...planning.reach.reach import Reach
from ...planning.result import PlanResult
from ...planning.sweep import Sweep
from ...studies.result import StudyResult
from ...trials.measured import Row
from ...types import Json
from ..doctor_facts import Health
from ..list import LISTED as KINDS_LISTED
from ..new import NewRobot, NewTask
from ..new_files import NewBoard
from ..plan.openings import NoStart, Planned
from ..show import Drawn
from ..trials.carried_out import Compared
from ..view import Opened, Saved
from .schemas import STRICT, modelled


@dataclass(frozen=True, slots=True)
class Entry:
    """A name, and what it stands for."""

    name: str
    title: str


@dataclass(frozen=True, slots=True)
class TaskEntry:
    """A task's name, what it stands for, and the family of its robot."""

    name: str
    title: str
    family: str


KINDS: Final[dict[str, Any]] = {
    kind: (modelled(list[TaskEntry] if kind == "tasks" else list[Entry]), []) for kind in KINDS_LISTED
}
LISTED: Final[Any] = create_model(
    "Listed", __config__=STRICT, __doc__="Names by kind; of one kind alone only that is there.", **KINDS
)
OURS: Final[dict[str, Any]] = {
    "list": LISTED,
    "plan": Planned | Front | NoStart,
    "shorten": PlanResult,
    "learn": Lesson,
    "inventory": SizedInventory,
    "check": CheckedPlan | Finding,
    "show": Drawn,
    "view": Opened | Saved,
    "export": Exported,
    "bench": list[Row],
    "sweep": Sweep,
    "reach": Reach,
    "study": StudyResult | list[StudyResult],
    "doctor": Health,
    "new board": NewBoard,
    "new robot": NewRobot,
    "new task": NewTask,
    "trials": Compared,
    "limb step": LimbResult,
    "limb circle": LimbResult,
    "limb push": LimbResult,
    "limb open-loop": OpenLoopResult,
    "limb record": Recorded,
    "limb force": ForceResult,
    "limb portrait": Portraits,
    "limb sweep": LimbSweep,
    "limb tune": Tuning,
}
"""Words of a command after `clamber` -> what it prints, whatever the robot."""


def _with_families() -> dict[str, Any]:
    found = dict(OURS)
    for family in families():
        for words, kind in (family.printed or {}).items():
            found[words] = found[words] | kind if words in found else kind
    return found


PRINTED: Final = _with_families()
"""The same with what families add."""
DRAFT: Final = "https://json-schema.org/draft/2020-12/schema"


@cache
def _schema(command: str) -> Json:
    made = TypeAdapter(modelled(PRINTED[command])).json_schema(mode="validation", by_alias=True)
    return {"$schema": DRAFT, "title": f"clamber {command} --json"} | {k: v for k, v in made.items() if k != "title"}


def schema_of(command: str) -> Json:
    """The JSON Schema of what a command prints.

    Args:
        command: Its words, such as "limb step".

    Raises:
        UnknownNameError: If there is no such command.
    """
    if command not in PRINTED:
        raise UnknownNameError("command with --json", command, tuple(PRINTED))
    return _schema(command)
