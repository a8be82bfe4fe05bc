"""What a run of the body's bench comes to, in SI units: NaN in a run that left the finite numbers."""

from dataclasses import dataclass, fields

import numpy as np

from ...types import Json
from .body_bench import BodyRun
from .body_scenario import BodyScenario


@dataclass(frozen=True, slots=True, kw_only=True)
class BodyMeasures:
    """Of the measured part, by the truth."""

    radial_rms: float | None
    """Of a circle: how far from it [m]."""
    behind_rms: float
    """Distance from the aim [m]."""
    x_max: float
    """Largest way along x from the aim, less that at the beginning [m]."""
    y_max: float
    """[m]."""
    turn_max: float
    """[rad]."""
    rest: float
    """Distance from the aim at the end [m]."""
    off_max: float
    """Largest distance of a holding tip from its peg [m]."""
    unhooked_at: float | None
    """When a hook came off [s]; None: never."""

    def to_json(self) -> Json:
        """Plain data."""
        return {
            field.name: None if (value := getattr(self, field.name)) is None or not np.isfinite(value) else value
            for field in fields(self)
        }


def measure_body(run: BodyRun, scenario: BodyScenario) -> BodyMeasures:
    """The measures of one run."""
    trace, begin = run.trace, scenario.begin
    error = trace.pose[begin:] - trace.aim[begin:]
    # a body pushed or lifted counts from where it stood; one on a circle has left its start long since
    moved = error - (0.0 if scenario.kind == "circle" else error[0])
    largest = np.abs(moved).max(axis=0)
    radial = None
    if scenario.centre is not None:
        radii = np.linalg.norm(trace.pose[begin:, :2] - scenario.centre, axis=1) - scenario.radius
        radial = float(np.sqrt(np.mean(radii**2)))
    return BodyMeasures(
        radial_rms=radial,
        behind_rms=float(np.sqrt(np.mean(np.sum(error[:, :2] ** 2, axis=1)))),
        x_max=float(largest[0]),
        y_max=float(largest[1]),
        turn_max=float(largest[2]),
        rest=float(np.linalg.norm(error[-1, :2])),
        off_max=float(trace.off.max()),
        unhooked_at=trace.unhooked_at,
    )
