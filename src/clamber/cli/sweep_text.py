"""A sweep as people read it."""

from pathlib import Path

from rich.console import Console

from ..planning.sweep import Sweep
from ..units import OZ_IN, split_quantity
from .output import plain_table


def announced_loop(planner: str) -> str:
    """The compiled loop that a planner's first run needs."""
    return "expand" if planner == "exact" else "rollout"


def print_sweep(console: Console, sweep: Sweep, output: Path | None) -> None:
    """Print the points as a table, and the reasons of those without a plan, once each."""
    numbers = ("actions", "least", "largest", "s")
    keys = [axis.key for axis in sweep.axes]
    table = plain_table(*keys, "status", *numbers, right=numbers)
    for point in sweep.points:
        torques = (point.least_torque, point.largest_torque)
        table.add_row(
            *(_short(value) for value in point.values),
            point.status,
            "-" if point.length is None else str(point.length),
            *("-" if torque is None else f"{torque / OZ_IN:.0f}" for torque in torques),
            f"{point.seconds:.1f}",
        )
    console.print(table)
    console.print("least, largest: joint torque of the plan's easiest and hardest step [oz-in]")
    console.print(f"{sweep.found} of {len(sweep.points)} points of '{sweep.task}' have a plan ({sweep.planner})")
    reasons: dict[tuple[str, str], str] = {}
    for point in sweep.points:
        if point.status in ("no start", "failed"):
            at = ", ".join(f"{key} = {value}" for key, value in zip(keys, point.values, strict=True))
            reasons.setdefault((point.status, point.reason), at)
    for (status, reason), at in reasons.items():
        console.print(f"{status} at {at}: {reason}")
    if output is not None:
        console.print(f"written to {output}", soft_wrap=True)


def _short(value: str) -> str:
    """A value with at most six digits of its number."""
    parts = split_quantity(value)
    return value if parts is None else f"{parts[0]:.6g} {parts[1]}".rstrip()
