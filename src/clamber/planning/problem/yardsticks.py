"""What margins of different units are measured against, so that they can be compared: each as a share of what is limited."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from ...family import family_of
from ...tasks import Task
from .check import Check

NOTHING_LIMITS: Final = 1e8
"""Larger margins mean that nothing limits."""


@dataclass(frozen=True, slots=True)
class Yardsticks:
    """What a task's margins are measured against."""

    checks: tuple[Check, ...]
    """In the order of a replay's margins."""
    hard: tuple[str, ...]
    """Names of the checks that forbid an action."""
    sizes: Mapping[str, float]
    """Check -> the size that its margin is a share of, in its own unit; counts have none, for they are never tight."""


def yardsticks_of(task: Task) -> Yardsticks:
    """The yardsticks of a task."""
    plans = family_of(task).plans
    return Yardsticks(plans.checks, plans.hard(task), plans.sizes(task))
