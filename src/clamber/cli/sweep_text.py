"""A sweep as people read it."""

import re
from pathlib import Path

from rich.console import Console

from ..planning.sweep import Sweep
from ..units import OZ_IN, split_quantity
from .output import plain_table


def print_sweep(console: Console, sweep: Sweep, output: Path | None) -> None:
    """Print the points as a table, and the reasons of those without a plan, once each."""
    numbers = ("actions", "torque", "least", "s")
    keys = [axis.key for axis in sweep.axes]
    table = plain_table(*keys, *(("",) if sweep.marks else ()), "status", *numbers, right=(*keys, *numbers))
    for k, point in enumerate(sweep.points):
        torques = (point.largest_torque, point.least_torque)
        table.add_row(
            *(_short(value) for value in point.values),
            *(("*" if sweep.marked(k) else "",) if sweep.marks else ()),
            point.status,
            "-" if point.length is None else str(point.length),
            *("-" if torque is None else f"{torque / OZ_IN:.0f}" for torque in torques),
            f"{point.seconds:.1f}",
        )
    console.print(table)
    console.print("torque: largest of the plan's joints [oz-in]; least: the least that it can be in any plan, proved")
    if sweep.marks:
        console.print(f"* marked: {' and '.join(f'{mark.key} = {mark.text}' for mark in sweep.marks)}")
    console.print(f"{sweep.found} of {len(sweep.points)} points of '{sweep.task}' have a plan ({sweep.planner})")
    reasons: dict[tuple[str, str], list[str]] = {}
    for point in sweep.points:
        if point.status in ("no start", "failed"):
            at = ", ".join(f"{key} = {_short(value)}" for key, value in zip(keys, point.values, strict=True))
            alike = re.sub(r"\d[\d.e+-]*", "0", point.reason)  # the same, but for its numbers
            reasons.setdefault((point.status, alike), []).append(f"{at}: {point.reason}")
    for (status, _), told in reasons.items():
        more = f" (and {len(told) - 1} points like it)" if len(told) > 1 else ""
        console.print(f"{status} at {told[0]}{more}")
    if output is not None:
        console.print(f"written to {output}", soft_wrap=True)


def _short(value: str) -> str:
    """A value with at most six digits of its number."""
    parts = split_quantity(value)
    return value if parts is None else f"{parts[0]:.6g} {parts[1]}".rstrip()
