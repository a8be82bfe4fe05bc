"""`clamber reach`: everything that a robot can ever reach."""

import math
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.table import Table

from ..shown_units import ShownUnits, units_of
from ..terminal.live_line import LiveLine
from ..terminal.options import Overrides, TaskName, Told, takes_options
from ..terminal.output import check_output, print_json, stderr, stdout, tell_written
from ..viewing.text_table import plain_table

if TYPE_CHECKING:
    from ..planning.reach.reach import Reach


@takes_options
def reach(
    task: TaskName,
    layer: Annotated[
        str | None,
        typer.Option(help="What to show of every place: force, payload, power, margin or steps.", show_default=False),
    ] = None,
    hangs: Annotated[
        bool, typer.Option("--hangs", help="Let hangs count as the task's rules have them; the space may have no end.")
    ] = False,
    overrides: Overrides = None,
    stances: Annotated[int, typer.Option(min=1, help="Memory: most stances to keep.")] = 8_000_000,
    seconds: Annotated[float | None, typer.Option(min=0.0, help="Most time to take.")] = None,
    threads: Annotated[int | None, typer.Option(min=1, help="Threads; one a core unless given.")] = None,
    *,
    told: Told,
) -> None:
    """Map every pose and hold that the robot can get to, and what it costs to be there (picture, or .csv of the poses)."""
    output = told.output
    check_output(output, ".csv")
    from ..tasks import load_task

    loaded = load_task(task, overrides or ())
    from ..planning.reach.reach import choose_layer, find_reach

    shown = choose_layer(loaded, layer)
    with FloodLine(stderr(), quiet=told.quiet, doing="seeing every stance") as line:
        result = find_reach(
            loaded, hangs=hangs, max_stances=stances, seconds=seconds, threads=threads, progress=line.update
        )
    if output is not None and output.suffix.lower() == ".csv":
        result.save_table(output)
    elif output is not None:
        from ..viewing.reach_plot import draw_reach

        draw_reach(result, shown, output)
    if told.as_json:
        print_json(result)
    else:
        _print_reach(stdout(), result, shown, output)
    raise typer.Exit(0 if result.status == "complete" else 1)


class FloodLine(LiveLine):
    """Follows an exploration."""

    def update(self, stances: int, poses: int, depth: int) -> None:
        """Show one moment of the exploration."""
        self.show(f"{stances} stances, {poses} poses tried, {depth} actions from the start")


def _print_reach(console: Console, reach: "Reach", layer: str, output: Path | None) -> None:
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
        by_limb = Counter(limb for hold in reach.holds for limb in hold.limbs)
        console.print(f"of each limb: {', '.join(f'{limb} {by_limb[limb]}' for limb in reach.task.robot.limb_names)}")
    console.print(_layer_table(reach, layer))
    if reach.closed_by:
        closed = ", ".join(f"{name} {n}" for name, n in reach.closed_by.items())
        console.print(f"what closes the edge, in body moves that each check forbids: {closed}")
    note = " (the task allows hangs; they were left out)" if reach.without_hangs else ""
    console.print(f"holds for: {reach.model}{note}")
    console.print(f"{reach.checks} actions judged, {reach.steps} actions to the farthest stance, {reach.seconds:.1f} s")
    tell_written(console, output)


def _layer_table(reach: "Reach", layer: str) -> Table:
    """Where the layer is best and worst, and what it is in the middle."""
    import numpy as np

    from ..planning.reach.reach import LAYERS

    shown, units = LAYERS[layer], units_of(reach.task.document)
    axes = reach.lattice.axes[:2]
    heads = tuple(f"{axis.name} [{units.place[0]}]" for axis in axes)
    values = reach.places.floats(shown.column)
    order = np.argsort(values if shown.good else -values, kind="stable")
    order = order[~np.isnan(values[order])]
    table = plain_table(shown.title, "", *heads, right=("", *heads))
    rows = (("hardest place", 0), ("middle", len(order) // 2), ("easiest place", -1)) if len(order) else ()
    for words, rank in rows:
        at = order[rank]
        place = [f"{reach.places.floats(axis.column)[at] / units.place[1] + 0.0:.1f}" for axis in axes]
        table.add_row(
            words, _value(float(values[at]), shown.column, units), *(place if words != "middle" else ("", ""))
        )
    return table


def _value(value: float, column: str, units: ShownUnits) -> str:
    """A value of a column, in its unit."""
    if column == "margin":
        return f"{100 * value + 0.0:.0f} %"
    if column == "first_step":
        return f"{value:.0f} actions"
    if not math.isfinite(value):
        return "no limit" if value > 0 else "-"
    if column.endswith("_Nm"):
        unit, size, digits = units.torque
        return f"{value / size:.{digits}f} {unit}"
    return f"{value:.4g} {column.rpartition('_')[2]}"
