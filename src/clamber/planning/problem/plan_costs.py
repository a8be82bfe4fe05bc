"""What a plan may be asked to have little of, as a family of robots has it."""

from collections.abc import Mapping
from dataclasses import dataclass

from .problem import CompiledProblem, Records


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanCost:
    """A cost, and the feature that counts it."""

    feature: str
    """"effort" adds up over actions; "peak" is the largest of any stance, the start included."""
    title: str
    size: float = 1.0
    """The cost per unit of the feature, in the cost's SI unit."""
    unit: str
    """What people read it in."""
    per_unit: float = 1.0
    """One of that in the cost's SI unit."""
    digits: int = 1
    """Behind the point."""

    def words(self, value: float) -> str:
        """The cost of a plan, told: title, number, unit."""
        return f"{self.title} {value / self.per_unit:.{self.digits}f}{f' {self.unit}' if self.unit else ''}"


def spent(problem: CompiledProblem, costs: Mapping[str, PlanCost], stances: Records) -> dict[str, float]:
    """Each cost of a plan, in its SI unit.

    Args:
        problem: The plan's problem.
        costs: Name of the cost -> the cost.
        stances: The plan's stances, the start first.
    """
    features = problem.measured(stances)
    out = {}
    for name, cost in costs.items():
        column = features[:, problem.features.index(cost.feature)]
        out[name] = cost.size * float(column.max() if cost.feature == "peak" else column[1:].sum())
    return out
