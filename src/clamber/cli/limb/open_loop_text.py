"""An open-loop comparison as people read it: a table, and files by suffix."""

import math
from pathlib import Path

from rich.console import Console

from ...limb_bench.open_loop import FIRST
from ...limb_bench.open_loop_result import FAR, OpenLoopResult
from ..output import plain_table


def print_open_loop(console: Console, result: OpenLoopResult) -> None:
    """Print how each transform's torques start the tip, and where it strays."""
    limb, run = result.limb, result.runs[0]
    start = ", ".join(f"{round(1e3 * value, 3) + 0.0:g}" for value in limb.start)
    console.print(
        f"open loop, {run.force:g} N along {math.degrees(result.direction):g} deg, {limb.robot.name}'s {limb.name} limb "
        f"from ({start}) mm",
        style="bold",
    )
    kind = "follow the pose" if result.renewed else "stand still"
    console.print(f"plant: {result.plant_words()}; torques {kind}")
    console.print()
    titles = ("torques\nN m", "first off\ndeg", "told*\ndeg", *(f"at {1e3 * far:g} mm\nmm" for far in FAR), "moved\nmm")
    table = plain_table("law", *titles, right=titles)
    for run in result.runs:
        table.add_row(
            run.transform,
            " ".join(f"{round(float(torque), 2) + 0.0:.2f}" for torque in run.torques),
            _shown(run.turned(), math.degrees(1.0)),
            _shown(result.predicted(run), math.degrees(1.0)),
            *(_shown(run.stray(far), 1e3) for far in FAR),
            _shown(run.moved, 1e3),
        )
    console.print(table)
    console.print()
    console.print(
        f"first off: the tip's first {1e3 * FIRST:g} mm from the wanted direction, anticlockwise positive; "
        "then how far left of it the tip is after so much of the way; * by the dynamics without friction"
    )
    if not result.moved:
        console.print(f"no transform moves the tip by {1e3 * FIRST:g} mm: friction holds it")


def _shown(value: float | None, scale: float) -> str:
    return "-" if value is None else f"{round(value * scale, 2) + 0.0:.2f}"


def write_open_loop(result: OpenLoopResult, path: Path) -> None:
    """Write a result as its file's suffix says: JSON or a picture."""
    if path.suffix.lower() == ".json":
        result.save(path)
        return
    from ...limb_bench.pictures.open_loop_plot import draw_open_loop_result

    draw_open_loop_result(result, path)
