"""What commands print with `--json` about robots in space."""

from typing import Any, Final

from .cli.new_world import PRINTED as NEW_WORLD
from .dynamics import ReplayedRun, TrialedRuns
from .trials.run_plan import SpatialRun

PRINTED: Final[dict[str, Any]] = {**NEW_WORLD, "run": SpatialRun, "trials": TrialedRuns | ReplayedRun}
"""Words of a command after `clamber` -> what it prints."""
