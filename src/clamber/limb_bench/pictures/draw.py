"""The picture of any result of the limb bench."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

from ...families.climber.execution.log_identify import Identification
from ..force import ForceResult
from ..open_loop import OpenLoopResult
from ..portrait import Portrait
from ..result import LimbResult
from ..sweep import LimbSweep
from ..tune import Tuning
from .comparison import draw_comparison
from .force import draw_force
from .identification import draw_identification
from .open_loop import draw_open_loop_result
from .portrait import draw_portrait
from .sweep import draw_sweep
from .tuning import draw_tuning

PICTURES: Final[dict[type[Any], Callable[[Any, str | Path], None]]] = {
    LimbResult: draw_comparison,
    ForceResult: draw_force,
    OpenLoopResult: draw_open_loop_result,
    LimbSweep: draw_sweep,
    Tuning: draw_tuning,
    Portrait: draw_portrait,
    Identification: draw_identification,
}
"""Kind of result -> what draws it."""


def draw_result(result: Any, path: str | Path) -> None:
    """Draw a result of one of the kinds in `PICTURES` into a file (.png, .svg, .pdf).

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    PICTURES[type(result)](result, path)
