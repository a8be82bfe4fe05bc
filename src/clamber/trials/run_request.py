"""One run in contact dynamics, whatever the family: what is asked for, and what all answers have."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol, runtime_checkable


@dataclass(frozen=True, slots=True, kw_only=True)
class RunRequest:
    """How a task, a plan or a walk is carried out."""

    planner: str = "auto"
    """Of a task without a plan."""
    plan_seconds: float = 600.0
    """Most time of each search for a plan [s]."""
    noise: tuple[str, ...] = ()
    """Texts "key=width": how far properties may be off what is believed."""
    plant: tuple[str, ...] = ()
    """Texts "key=value" that change the simulated robot."""
    seed: int = 0
    """Of planner and noise."""
    replan: bool = True
    """Whether a new plan is searched for where a hold cannot be had."""
    log: Path | None = None
    """File that grows during the run."""
    tell: Callable[[str, float | None], None] | None = None
    """Hears how far the run is, in words and as a share of the whole where that is known [-]; it may end the run by an error."""


@runtime_checkable
class CarriedOut(Protocol):
    """What happened in a run."""

    @property
    def work(self) -> Any:
        """The task, or what else of the family was carried out."""

    @property
    def trace(self) -> Any:
        """Samples of it, with `to_log()`."""

    @property
    def done(self) -> bool:
        """Whether it came to its end."""

    @property
    def reason(self) -> str:
        """Why it did not; empty where it did."""
