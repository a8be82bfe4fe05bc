"""The error that tells most of a run, over time or round the circle: for a plot on a terminal or on paper."""

from dataclasses import dataclass

import numpy as np

from ..types import Floats
from .contest import Run
from .measures import components, radial_error
from .scenario import Scenario


@dataclass(frozen=True, slots=True, eq=False)
class ErrorLine:
    """Sizes of one error over a run."""

    what: str
    over: str
    error: Floats
    """Shape (samples,) [m]; NaN after a run that broke off."""


def error_line(run: Run, scenario: Scenario, until: float, index: int = 0) -> ErrorLine:
    """Distance from the circle in the last lap, or until a time [s] from the line of a step or the aim under a push; in truth."""
    trace = run.trace
    tip = trace.true_places()[:, index, :2]
    if scenario.kind == "circle":
        last = trace.time >= scenario.settle
        return ErrorLine("distance from the circle", "round the last lap", np.abs(radial_error(tip, scenario)[last]))
    shown = trace.time < until
    error = (tip - trace.wanted_places()[:, 0, :2])[shown]
    if scenario.kind == "step":
        across = components(error, scenario.direction)[1]
        return ErrorLine("distance from the line of the step", f"over {until:.3g} s", np.abs(across))
    return ErrorLine("distance from the aim", f"over {until:.3g} s", np.hypot(error[:, 0], error[:, 1]))
