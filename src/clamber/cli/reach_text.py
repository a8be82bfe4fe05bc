"""A reachable space as people read it: a line on the way, and what was seen."""

from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from ..planning.reach.layers import LAYERS
from ..planning.reach.reach import Reach
from ..units import OZ_IN
from .live_line import LiveLine
from .output import plain_table


class FloodLine(LiveLine):
    """Follows a flood."""

    def update(self, stances: int, poses: int, depth: int) -> None:
        """Show one moment of the flood."""
        self.show(f"{stances} stances, {poses} poses tried, {depth} actions from the start")


def print_reach(console: Console, reach: Reach, layer: str, output: Path | None) -> None:
    """Print what was seen: goals, holds, the layer's range over the places, what closes the edge, the model."""
    complete = reach.status == "complete"
    console.print(f"{reach.status}: {reach.reason}", style="bold green" if complete else "bold red")
    for index, goal in enumerate(reach.goals):
        word = goal.name or ("goal" if index == len(reach.goals) - 1 else f"sub-goal {index + 1}")
        far = "no reachable stance is there" if complete else "not seen so far"
        where = far if goal.first_step is None else f"{goal.stances} stances, the first after {goal.first_step} actions"
        console.print(f"{word}: {where}")
    if reach.holds:
        used = sum(bool(hold.limbs) for hold in reach.holds)
        never = f"; never used: {', '.join(map(str, reach.never_used))}" if reach.never_used else ""
        console.print(f"holds: {used} of {len(reach.holds)} are used{never if complete else ' so far'}")
    console.print(_layer_table(reach, layer))
    if reach.closed_by:
        closed = ", ".join(f"{name} {n}" for name, n in reach.closed_by.items())
        console.print(f"what closes the edge, in body moves that each check forbids: {closed}")
    note = " (the task allows hangs; they were left out)" if reach.without_hangs else ""
    console.print(f"holds for: {reach.model}{note}")
    console.print(f"{reach.checks} actions judged, {reach.steps} actions to the farthest stance, {reach.seconds:.1f} s")
    if output is not None:
        console.print(f"written to {output}", soft_wrap=True)


def _layer_table(reach: Reach, layer: str) -> Table:
    """Where the layer is best and worst, and what it is in the middle."""
    shown = LAYERS[layer]
    values = reach.places.floats(shown.column)
    order = np.argsort(values if shown.good else -values, kind="stable")
    order = order[~np.isnan(values[order])]
    table = plain_table(shown.title, "", "x [m]", "y [m]", right=("", "x [m]", "y [m]"))
    rows = (("hardest place", 0), ("middle", len(order) // 2), ("easiest place", -1)) if len(order) else ()
    for words, rank in rows:
        at = order[rank]
        place = [f"{reach.places.floats(name)[at]:.3f}" for name in ("x_m", "y_m")]
        table.add_row(words, _value(float(values[at]), shown.column), *(place if words != "middle" else ("", "")))
    return table


def _value(value: float, column: str) -> str:
    """A value of a column, in its unit."""
    if column == "margin":
        return f"{100 * value + 0.0:.0f} %"
    if column == "first_step":
        return f"{value:.0f} actions"
    if not np.isfinite(value):
        return "no limit" if value > 0 else "-"
    if column.endswith("_Nm"):
        return f"{value:.2f} N m ({value / OZ_IN:.0f} oz-in)"
    return f"{value:.4g} {column.rpartition('_')[2]}"
