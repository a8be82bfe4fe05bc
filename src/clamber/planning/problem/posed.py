"""A task posed as a problem."""

import math
from dataclasses import dataclass

from ...json_form import Count, Jsonable, in_json
from .problem import CompiledProblem


@dataclass(frozen=True, slots=True)
class Dropped:
    """Modules that a filter left out."""

    filter: str
    reason: str
    names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Posed:
    """A task as a problem, and what its inventory's filters did."""

    problem: CompiledProblem
    full_size: int
    """Modules of the unfiltered inventory."""
    dropped: tuple[Dropped, ...] = ()

    def sized(self, length: int) -> "SizedInventory":
        """The inventory with the size of the search for plans of `length` actions."""
        names = tuple(self.problem.actions.names)
        return SizedInventory(len(names), self.full_size, names, self.dropped, length)


@dataclass(frozen=True, slots=True)
class SizedInventory(Jsonable):
    """The modules that a plan can be made of, and the search sizes D = N^m (thesis 2.2.1)."""

    modules: Count
    full_size: Count
    """Before the filters."""
    names: tuple[str, ...]
    dropped: tuple[Dropped, ...]
    length: Count
    """Actions of a plan, for the size of the search."""

    @property
    @in_json()
    def log10_before(self) -> float:
        """Logarithm of how many plans of that length there are before the filters."""
        return self.length * math.log10(self.full_size)

    @property
    @in_json()
    def log10_after(self) -> float:
        """The same after them."""
        return self.length * math.log10(self.modules)
