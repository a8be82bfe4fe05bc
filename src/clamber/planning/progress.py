"""What a planner tells while it works."""

from collections.abc import Callable
from dataclasses import dataclass


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


Moment = Progress | Exploring | Routing | Trying | Layers | Shortening | Relaxing
Listener = Callable[[Moment], None]
