"""What each command prints: its words, and the kinds of values that come out with `--json`."""

from functools import cache
from typing import Any, Final

from pydantic import TypeAdapter

from ...actions.problems import SizedInventory
from ...actions.verdict import CheckedPlan
from ...errors import UnknownNameError
from ...experiments.climb.body_measures import BodyContest
from ...experiments.climb.body_trials import PushTrial
from ...experiments.climb.lessons import LearnedPlan
from ...experiments.climb.press import Pressed
from ...experiments.climb.run_plan import ClimbRun
from ...experiments.rows import Row
from ...experiments.walk.most import MostOfWalk
from ...experiments.walk.run_walk import WalkRun
from ...inspection.finding import Finding
from ...planning.exact.front import Front
from ...planning.learning import Lesson
from ...planning.reach.reach import Reach
from ...planning.result import PlanResult
from ...planning.sweep import Sweep
from ...studies.result import StudyResult
from ...types import Json
from ..plan.openings import NoStart, Planned
from ..trials.climb import ClimbTrials, ReplayedTrial
from ..trials.walk import PrintedWalkTrials
from .limb_logs import Identified, Recorded
from .limbs import Contest, Forces, LimbSweep, OpenLoop, Portraits, Tuned
from .schemas import modelled
from .things import (
    Drawn,
    Exported,
    Health,
    Listed,
    NewBoard,
    NewRobot,
    NewTask,
    Opened,
    PlantTold,
    Saved,
    Served,
)
from .walkers import Crossing, Family, Followed, WidestDitch

PRINTED: Final[dict[str, Any]] = {
    "list": Listed,
    "plan": Planned | Front | NoStart,
    "polish": PlanResult,
    "rehearse": LearnedPlan,
    "learn": Lesson,
    "inventory": SizedInventory,
    "check": CheckedPlan | Finding,
    "run": ClimbRun | WalkRun,
    "press": Pressed,
    "follow": Followed,
    "trials": ClimbTrials | PrintedWalkTrials | ReplayedTrial,
    "most": MostOfWalk,
    "show": Drawn,
    "view": Opened | Saved,
    "export": Exported,
    "bench": list[Row],
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
    "body circle": BodyContest,
    "body push-up": BodyContest,
    "body push": BodyContest | dict[str, list[PushTrial]],
}
"""Words of a command after `clamber` -> what it prints."""
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
