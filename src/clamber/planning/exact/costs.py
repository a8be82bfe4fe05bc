"""What a plan may be asked to have little of, and orders of such wishes."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from ...errors import OptionError, describe_choices
from ...tasks import Task
from ..problem.problems import plan_family

COSTS: Final = {"length": "length", "energy": "effort", "time": "effort", "torque": "peak", "strain": "peak"}
"""Cost -> the feature that counts it. Every family has the length, one cost that adds up, one that is a largest value."""


class CostError(OptionError):
    """Costs are asked for that can't be minimized together."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Aim:
    """What one exact search minimizes: a cost, a second one among its equals, and a limit on the cost that is a largest value."""

    first: str = "length"
    second: str | None = None
    most_peak: float | None = None
    """No action may have more, in the unit of the feature "peak"."""
    at_most: float | None = None
    """No plan with more of the first cost is of interest."""
    front: bool = False
    """Keep every plan that no other beats in both costs; the first cost must be the length."""


def read_costs(option: str, text: str, *, least: int = 1, most: int = 3) -> tuple[str, ...]:
    """Costs from "length,torque".

    Raises:
        CostError: If one is unknown or named twice, or their number doesn't fit.
    """
    names = tuple(name.strip() for name in text.split(","))
    for name in names:
        if name not in COSTS:
            raise CostError(option, f"'{name}' is no cost", describe_choices(name, tuple(COSTS)))
    if len(set(names)) < len(names):
        raise CostError(option, f"'{text}' names a cost twice", "name each once")
    if not least <= len(names) <= most:
        wanted = f"{least}" if least == most else f"{least} to {most}"
        raise CostError(option, f"{len(names)} costs are named", f"name {wanted} of {', '.join(COSTS)}")
    return names


def check_costs(option: str, names: Sequence[str], task: Task) -> None:
    """Raises `CostError` where the family of the task's robot lacks one of the costs."""
    known = ("length", *plan_family(task).costs(task))
    for name in names:
        if name not in known:
            raise CostError(option, f"'{name}' is no cost of task '{task.name}'", describe_choices(name, known))


def describe_order(order: Sequence[str]) -> str:
    """An order in words: least length, then least torque."""
    return ", then ".join(f"least {name}" for name in order)
