"""What one run in contact dynamics is asked for, whatever the family."""

from dataclasses import dataclass
from pathlib import Path


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
