"""What each command prints: its words, and the kinds of values that come out with `--json`."""

from dataclasses import dataclass
from functools import cache
from typing import Any, Final

from pydantic import TypeAdapter, create_model

from ...benchmarks.rows import Row
from ...errors import UnknownNameError
from ...exports.library import Exported
from ...families.climber.execution.log_identify import Identification
from ...families.climber.trials.body_bench import BodyContest, PushTrial
from ...families.climber.trials.lessons import LearnedPlan
from ...families.climber.trials.press import Pressed
from ...families.climber.trials.run_plan import ClimbRun
from ...families.walker.robot.calibration import Rivals
from ...families.walker.robot.ditch_plan import Crossing
from ...families.walker.trials.cooperative.follow import FollowRun
from ...families.walker.trials.most import MostOfWalk
from ...families.walker.trials.run_walk import WalkRun
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
from ...planning.problem.posed import SizedInventory
from ...planning.problem.verdict import CheckedPlan
from ...planning.reach.reach import Reach
from ...planning.result import PlanResult
from ...planning.sweep import Sweep
from ...studies.result import StudyResult
from ...types import Json
from ..catalogue import ENTRIES
from ..ditch import WidestDitch
from ..doctor_facts import Health
from ..new import NewRobot, NewTask
from ..new_files import NewBoard
from ..plan.openings import NoStart, Planned
from ..plant import PlantAnswer, ServedPlant
from ..show import Drawn
from ..trials.climb import ClimbTrials, ReplayedTrial
from ..trials.walk import PrintedWalkTrials
from ..view import Opened, Saved
from .schemas import STRICT, modelled


@dataclass(frozen=True, slots=True)
class Entry:
    """A name, and what it stands for."""

    name: str
    title: str


KINDS: Final[dict[str, Any]] = {kind: (modelled(list[Entry]), []) for kind in ENTRIES}
LISTED: Final[Any] = create_model(
    "Listed", __config__=STRICT, __doc__="Names by kind; of one kind alone only that is there.", **KINDS
)
PRINTED: Final[dict[str, Any]] = {
    "list": LISTED,
    "plan": Planned | Front | NoStart,
    "polish": PlanResult,
    "rehearse": LearnedPlan,
    "learn": Lesson,
    "inventory": SizedInventory,
    "check": CheckedPlan | Finding,
    "run": ClimbRun | WalkRun,
    "press": Pressed,
    "follow": FollowRun,
    "trials": ClimbTrials | PrintedWalkTrials | ReplayedTrial,
    "most": MostOfWalk,
    "show": Drawn,
    "view": Opened | Saved,
    "export": Exported,
    "bench": list[Row],
    "sweep": Sweep,
    "reach": Reach,
    "calibrate": list[Rivals],
    "ditch": list[WidestDitch] | Crossing,
    "study": StudyResult | list[StudyResult],
    "doctor": Health,
    "new board": NewBoard,
    "new robot": NewRobot,
    "new task": NewTask,
    "plant serve": ServedPlant,
    "plant stop": PlantAnswer,
    "plant release": PlantAnswer,
    "limb step": LimbResult,
    "limb circle": LimbResult,
    "limb push": LimbResult,
    "limb open-loop": OpenLoopResult,
    "limb record": Recorded,
    "limb identify": Identification,
    "limb force": ForceResult,
    "limb portrait": Portraits,
    "limb sweep": LimbSweep,
    "limb tune": Tuning,
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
