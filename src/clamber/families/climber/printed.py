"""What commands print with `--json` about climbers."""

from typing import Any, Final

from .cli.plant import PlantAnswer, ServedPlant
from .dynamics import ReplayedClimb, TrialedClimb
from .execution.log_identify import Identification
from .trials.body_bench import BodyContest, PushTrial
from .trials.hold_force import Pressed
from .trials.plan_repair import LearnedPlan
from .trials.run_plan import ClimbRun

PRINTED: Final[dict[str, Any]] = {
    "validate": LearnedPlan,
    "run": ClimbRun,
    "hold-force": Pressed,
    "trials": TrialedClimb | ReplayedClimb,
    "plant serve": ServedPlant,
    "plant stop": PlantAnswer,
    "plant release": PlantAnswer,
    "limb identify": Identification,
    "body circle": BodyContest,
    "body push-up": BodyContest,
    "body push": BodyContest | dict[str, list[PushTrial]],
}
"""Words of a command after `clamber` -> what it prints."""
