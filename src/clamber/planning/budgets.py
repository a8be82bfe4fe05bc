"""Who takes part in a comparison of planners, and one allowance for all of them."""

import inspect
from dataclasses import dataclass, field
from typing import Final

from ..types import Json
from .genetic.profile import profile_names
from .planners import PLANNERS, find_planner

UNBOUNDED: Final = 1_000_000_000
SEEDLESS: Final = ("exact", "greedy", "route")
"""Planners that draw nothing at random: one seed tells all."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Allowance:
    """What one search may spend."""

    checks: int
    """Single actions judged: the same on any machine."""
    seconds: float
    """In their place, for a planner that can't stop at a number of checks [s]."""
    patience: float
    """No search takes longer than this [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Contender:
    """A planner with its settings, as a comparison names it."""

    name: str
    """Such as "exact" or "genetic/thesis"."""
    planner: str
    options: Json = field(default_factory=dict)

    @property
    def draws(self) -> bool:
        """Whether another seed may give another answer."""
        return self.planner not in SEEDLESS

    @property
    def counts(self) -> bool:
        """Whether its searches end, or can be cut in hindsight, at a number of checks.

        An exact search does the same whatever its limits, so what it judged tells whether an allowance would have sufficed.
        """
        return accepts(self.planner, "max_checks") or self.planner == "exact"

    def limits(self, allowance: Allowance) -> Json:
        """An allowance in the planner's own options; limits of its own in other units are lifted."""
        counted = accepts(self.planner, "max_checks")
        options: Json = {"seconds": allowance.patience if self.counts else allowance.seconds}
        if counted:
            options["max_checks"] = allowance.checks
        if counted and accepts(self.planner, "max_evaluations"):
            options["max_evaluations"] = UNBOUNDED
        return options


def contenders() -> tuple[Contender, ...]:
    """Every planner, the genetic one with each of its profiles."""
    found: list[Contender] = []
    for planner in PLANNERS:
        if planner == "genetic":
            profiles = profile_names()
            found += [Contender(name=f"{planner}/{p}", planner=planner, options={"profile": p}) for p in profiles]
        else:
            found.append(Contender(name=planner, planner=planner))
    return tuple(found)


def accepts(planner: str, option: str) -> bool:
    """Whether a planner, ours or another package's, has such an option."""
    return option in inspect.signature(find_planner(planner)).parameters
