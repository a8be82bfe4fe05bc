"""What commands print with `--json` about runs of robots in space."""

from typing import Any, Final

from .dynamics import ReplayedRun, TrialedRuns
from .trials.run_plan import SpatialRun

PRINTED: Final[dict[str, Any]] = {"run": SpatialRun, "trials": TrialedRuns | ReplayedRun}
"""Words of a command after `clamber` -> what it prints."""
