"""What commands print with `--json` about two-frame walkers."""

from typing import Any, Final

from .cli.ditch import WidestDitch
from .dynamics import ReplayedWalk, TrialedWalk
from .robot.calibration import Rivals
from .robot.ditch_plan import Crossing
from .trials.cooperative.follow import FollowRun
from .trials.max_setting import MaxSetting
from .trials.run_walk import WalkRun

PRINTED: Final[dict[str, Any]] = {
    "run": WalkRun,
    "follow": FollowRun,
    "trials": TrialedWalk | ReplayedWalk,
    "max-setting": MaxSetting,
    "calibrate": list[Rivals],
    "ditch": list[WidestDitch] | Crossing,
}
"""Words of a command after `clamber` -> what it prints."""
