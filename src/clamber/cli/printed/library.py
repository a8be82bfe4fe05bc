"""What each command prints: its words, and the kinds of values that come out with `--json`."""

from functools import cache
from typing import Any, Final

from pydantic import TypeAdapter

from ...errors import UnknownNameError
from ...types import Json
from .bodies import Bodies, PushTrial
from .limb_logs import Identified, Recorded
from .limbs import Contest, Forces, LimbSweep, OpenLoop, Portraits, Tuned
from .plans import Front, Inventory, Learned, NoStart, Planned, Polished, Verdict
from .runs import Climbed, Pressed, Rehearsed, Walked
from .searches import BenchRow, Reach, Sweep
from .things import (
    Drawn,
    Exported,
    Finding,
    Health,
    Listed,
    NewBoard,
    NewRobot,
    NewTask,
    Opened,
    PlantTold,
    Saved,
    Served,
    StudyResult,
)
from .trials import ClimbTrials, Most, ReplayedTrial, WalkTrials
from .walkers import Crossing, Family, Followed, WidestDitch

PRINTED: Final[dict[str, Any]] = {
    "list": Listed,
    "plan": Planned | Front | NoStart,
    "polish": Polished,
    "rehearse": Rehearsed,
    "learn": Learned,
    "inventory": Inventory,
    "check": Verdict | Finding,
    "run": Climbed | Walked,
    "press": Pressed,
    "follow": Followed,
    "trials": ClimbTrials | WalkTrials | ReplayedTrial,
    "most": Most,
    "show": Drawn,
    "view": Opened | Saved,
    "export": Exported,
    "bench": list[BenchRow],
    "sweep": Sweep,
    "reach": Reach,
    "calibrate": list[Family],
    "ditch": list[WidestDitch] | Crossing,
    "study": StudyResult | list[StudyResult],
    "doctor": Health,
    "new board": NewBoard,
    "new robot": NewRobot,
    "new task": NewTask,
    "plant serve": Served,
    "plant stop": PlantTold,
    "plant release": PlantTold,
    "limb step": Contest,
    "limb circle": Contest,
    "limb push": Contest,
    "limb open-loop": OpenLoop,
    "limb record": Recorded,
    "limb identify": Identified,
    "limb force": Forces,
    "limb portrait": Portraits,
    "limb sweep": LimbSweep,
    "limb tune": Tuned,
    "body circle": Bodies,
    "body push-up": Bodies,
    "body push": Bodies | dict[str, list[PushTrial]],
}
"""Words of a command after `clamber` -> what it prints."""
DRAFT: Final = "https://json-schema.org/draft/2020-12/schema"


@cache
def _schema(command: str) -> Json:
    made = TypeAdapter(PRINTED[command]).json_schema(mode="validation", by_alias=True)
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
