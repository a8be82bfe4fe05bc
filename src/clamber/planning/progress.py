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
    lower_bound: int
    """No plan has fewer actions."""


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


Moment = Progress | Exploring | Layers | Shortening
Listener = Callable[[Moment], None]
