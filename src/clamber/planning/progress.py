"""What a planner tells while it works, and the time that it may take."""

import time
from collections.abc import Callable
from dataclasses import dataclass

from ..shown_units import SI, Unit


class Clock:
    """The time that a search has taken, and what is left of what it may take.

    Args:
        seconds: That it may take, from now on [s]; None: as long as it likes.
    """

    def __init__(self, seconds: float | None = None) -> None:
        self._seconds, self._began = seconds, time.monotonic()

    @property
    def spent(self) -> float:
        """Time since it began [s]."""
        return time.monotonic() - self._began

    @property
    def left(self) -> float | None:
        """What is left [s]; None: as long as it likes."""
        return None if self._seconds is None else max(0.0, self._seconds - self.spent)

    @property
    def is_over(self) -> bool:
        """Whether nothing is left."""
        return self.left == 0.0


@dataclass(frozen=True, slots=True)
class Progress:
    """One moment of a search."""

    generation: int
    evaluations: int
    """Whole plans evaluated."""
    best_fitness: float
    furthest: int
    """Actions of the best plan that hold."""
    stage: int
    """Goals that the best plan meets, in order."""
    stages: int
    best_length: int | None
    """Actions of the best plan that reaches the goal."""


@dataclass(frozen=True, slots=True)
class Exploring:
    """One moment of an exact search."""

    stances: int
    """Different stances seen."""
    lower_bound: float
    """No plan has less of what is minimized, in the unit of its feature: actions, N m, W summed over actions."""
    cost: str = "length"
    """What is minimized now."""
    torque: Unit = SI.torque
    """How torques are shown."""


@dataclass(frozen=True, slots=True)
class Routing:
    """One moment of a greedy search."""

    stances: int
    """Stances seen."""
    actions: int
    """Actions of the stance that has the least way left."""
    share: float
    """Of the way that it has behind it [-]."""


@dataclass(frozen=True, slots=True)
class Trying:
    """One moment of a search that tries actions one by one and proves nothing."""

    checks: int
    """Actions judged."""
    value: float
    """What the best stance is worth."""
    best_length: int | None
    """Actions of the best plan that reaches the goal."""


@dataclass(frozen=True, slots=True)
class Relaxing:
    """One moment of the search for changes that make an infeasible task feasible."""

    searches: int
    """Exact searches begun."""
    key: str
    """What is changed now."""


@dataclass(frozen=True, slots=True)
class Layers:
    """One moment of a beam search."""

    layer: int
    """Actions of every plan kept now."""
    stances: int
    """Stances kept in all layers."""
    best_score: float


@dataclass(frozen=True, slots=True)
class Shortening:
    """One moment of making a plan shorter."""

    length: int
    """Actions of the plan."""


ProgressEvent = Progress | Exploring | Routing | Trying | Layers | Shortening | Relaxing
Listener = Callable[[ProgressEvent], None]


def progress_text(progress: ProgressEvent) -> str:
    """One moment of a search in a line of at most 80 columns."""
    if isinstance(progress, Routing):
        return f"{progress.stances} stances, {progress.actions} actions, {100.0 * progress.share:.0f} % of the way"
    if isinstance(progress, Exploring):
        return f"{progress.stances} stances, {_bound_text(progress)}"
    if isinstance(progress, Layers):
        return f"layer {progress.layer}, {progress.stances} stances, best score {progress.best_score:.2f}"
    if isinstance(progress, Shortening):
        return f"a plan of {progress.length} actions"
    if isinstance(progress, Relaxing):
        return f"what would open it: {progress.searches} searches, now {progress.key}"
    best = "" if progress.best_length is None else f", found {progress.best_length} actions"
    if isinstance(progress, Trying):
        how = best or f", progress {progress.value:.2f}"
        return f"{progress.checks} actions judged{how}"
    return (
        f"generation {progress.generation}, {progress.evaluations} plans, fitness {progress.best_fitness:.2f}, "
        f"{progress.furthest} steps, goal {progress.stage}/{progress.stages}{best}"
    )


def _bound_text(progress: Exploring) -> str:
    if progress.cost == "length":
        return f"no plan has fewer than {progress.lower_bound:.0f} actions"
    if progress.cost == "torque":
        unit, size, decimals = progress.torque
        return f"no plan has less than {progress.lower_bound / size:.{decimals}f} {unit}"
    if progress.cost == "energy":
        return f"no plan's powers add up to less than {progress.lower_bound:.1f} W"
    return f"no plan has less {progress.cost} than {progress.lower_bound:.4g}"
