"""Which check is the nearest to failing: margins of different units, compared as shares of what is limited."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from ..planning.problem.check import Check
from ..planning.problem.problem import Replay
from ..planning.problem.problems import NOTHING_LIMITS, Normalisation
from ..shown_units import SI, ShownUnits
from ..types import Floats


@dataclass(frozen=True, slots=True)
class Limiting:
    """The check that is nearest to failing in one step."""

    check: Check
    margin: float
    """In the check's own unit."""
    share: float
    """Margin over the size of what is limited [-]; negative: violated."""
    units: ShownUnits = SI

    @property
    def value(self) -> str:
        """The margin for people, with its sign and unit."""
        return self.units.signed(self.margin, self.check.unit, 3)

    def __str__(self) -> str:
        name = self.check.name.replace("_", "-")
        share = "violated" if self.share < 0.0 else f"{100 * self.share:.0f} %"
        return f"{name} {self.value} ({share})"


def limiting(normalisation: Normalisation, margins: Floats, reason: int) -> Limiting | None:
    """The hard check with the smallest relative margin, or the violated one; None where nothing is known.

    Args:
        yardsticks: Those of the task.
        margins: Margins of one step, each in its own unit, shape (n_checks,).
        reason: Number of the violated check, -1 for none.
    """
    sizes = normalisation.sizes
    if reason >= 0:
        check, margin = normalisation.checks[reason], float(margins[reason])
        return Limiting(check, margin, min(margin / sizes.get(check.name, 1.0), 0.0), normalisation.units)
    found: Limiting | None = None
    for check, margin in zip(normalisation.checks, margins.tolist(), strict=True):
        if check.name not in sizes or check.name not in normalisation.hard or not abs(margin) < NOTHING_LIMITS:
            continue
        share = min(margin / sizes[check.name], 1.0) if sizes[check.name] > 0.0 else 1.0
        if found is None or share < found.share:
            found = Limiting(check, margin, share, normalisation.units)
    return found


def named_limits(normalisation: Normalisation, margins: Mapping[str, float | None]) -> list[Limiting]:
    """Each hard check that has a size to be measured against and a margin, the one nearest to failing first.

    Args:
        yardsticks: Those of the task.
        margins: Check -> margin in its own unit; None where nothing limits it.
    """
    sizes = {name: size for name, size in normalisation.sizes.items() if 0.0 < size < math.inf}
    found = [
        Limiting(check, margin, min(margin / sizes[check.name], 1.0), normalisation.units)
        for check in normalisation.checks
        if check.name in sizes and check.name in normalisation.hard and (margin := margins.get(check.name)) is not None
    ]
    return sorted(found, key=lambda limit: limit.share)


def all_limiting(normalisation: Normalisation, replay: Replay) -> list[Limiting | None]:
    """`limiting` of every step of a replay."""
    return [
        limiting(normalisation, row, int(reason)) for row, reason in zip(replay.margins, replay.reasons, strict=True)
    ]


def grade(step: Limiting | None) -> int:
    """Colour of a step in `style.STRIP`: 0 violated, 1 tight, 2 fair, 3 ample."""
    if step is None:
        return 3
    return 0 if step.share < -1e-9 else 1 if step.share < 0.05 else 2 if step.share < 0.15 else 3
