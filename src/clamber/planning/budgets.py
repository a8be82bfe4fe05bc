"""One budget for every planner: single actions judged where a planner counts them so, else seconds."""

import inspect
from dataclasses import dataclass
from typing import Any, Final

from .genetic.profile import profile_names
from .planners import PLANNERS

UNBOUNDED: Final = 1_000_000_000
SEEDLESS: Final = ("exact", "greedy")
"""Planners that draw nothing at random: one seed tells all."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Allowance:
    """What one search may spend."""

    checks: int
    """Single actions judged, for planners that can stop there: the same on any machine."""
    seconds: float
    """For the others, and for no search more than this [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Contender:
    """A planner with its settings, as a comparison names it."""

    name: str
    """Such as "exact" or "genetic/thesis"."""
    planner: str
    options: dict[str, Any]

    @property
    def draws(self) -> bool:
        """Whether another seed gives another answer."""
        return self.planner not in SEEDLESS


def contenders() -> tuple[Contender, ...]:
    """Every planner, the genetic one with each of its profiles."""
    found = []
    for planner in PLANNERS:
        if planner == "genetic":
            found += [
                Contender(name=f"genetic/{profile}", planner=planner, options={"profile": profile})
                for profile in profile_names()
            ]
        else:
            found.append(Contender(name=planner, planner=planner, options={}))
    return tuple(found)


def accepts(planner: str, option: str) -> bool:
    """Whether a planner has an option."""
    return option in inspect.signature(PLANNERS[planner]).parameters


def limits(planner: str, allowance: Allowance) -> dict[str, Any]:
    """An allowance in a planner's own options: its other limits are lifted, so that none is stopped by what others don't have.

    Exact search is limited by its memory and the seconds; what it judged is counted, so its answers within the allowance can be told.
    """
    options: dict[str, Any] = {"seconds": allowance.seconds}
    if accepts(planner, "max_checks"):
        options["max_checks"] = allowance.checks
        if accepts(planner, "max_evaluations"):
            options["max_evaluations"] = UNBOUNDED
    return options
