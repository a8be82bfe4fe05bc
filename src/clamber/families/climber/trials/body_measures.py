"""What a run of the body's bench comes to, in SI units: NaN in a run that left the finite numbers."""

from collections.abc import Sequence
from dataclasses import dataclass
from operator import attrgetter
from typing import Annotated, Final

import numpy as np

from ....json_form import INLINE, Jsonable, Key, OrNull
from .body_bench import BodyRun
from .body_scenario import BodyScenario

ALPHA: Final = "Least acceleration of a hook along its grab direction, for the limits that know one [m/s^2]."


@dataclass(frozen=True, slots=True, kw_only=True)
class BodyMeasures(Jsonable):
    """Of the measured part, by the truth."""

    radial_rms: float | None
    """Of a circle: how far from it [m]; None for others."""
    behind_rms: OrNull
    """Distance from the aim [m]."""
    x_max: OrNull
    """Largest way along x from the aim, less that at the beginning [m]."""
    y_max: OrNull
    """[m]."""
    turn_max: OrNull
    """[rad]."""
    rest: OrNull
    """Distance from the aim at the end [m]."""
    off_max: OrNull
    """Largest distance of a holding tip from its peg [m]."""
    unhooked_at: float | None
    """When a hook came off [s]; None: never."""


@dataclass(frozen=True, slots=True)
class BodyControl:
    """One control of the body."""

    run: Annotated[
        BodyRun,
        Key("control", get=attrgetter("entry.label"), kind=str),
        Key(
            "kp", get=attrgetter("entry.gains.kp"), kind=list[float], meaning="Along x, y [N/m] and turning [N m/rad]."
        ),
        Key("kd", get=attrgetter("entry.gains.kd"), kind=list[float]),
        Key("limit", get=attrgetter("entry.gains.limit"), kind=str, meaning="Of the hooks' pulls."),
        Key("alpha", get=attrgetter("entry.gains.alpha"), kind=float, meaning=ALPHA),
    ]
    measures: Annotated[BodyMeasures, INLINE]


@dataclass(frozen=True, slots=True)
class BodyContest:
    """Controls compared on a body that limbs hold; exit code 1 where a hook came off."""

    kind: str
    controls: tuple[BodyControl, ...]

    @classmethod
    def of(cls, kind: str, runs: Sequence[BodyRun], measured: Sequence[BodyMeasures]) -> "BodyContest":
        """Runs of a kind of scenario, with what was measured of each."""
        return cls(kind, tuple(map(BodyControl, runs, measured)))


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
