"""`clamber sweep`: plan a task at many values of one or two of its keys."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console

from ..terminal.options import Overrides, PlannerName, TaskName, takes_options
from ..terminal.output import check_output, print_json, stdout, tell_written
from ..terminal.worker_options import WorkerOptions
from ..viewing.text_table import plain_table

if TYPE_CHECKING:
    from ..planning.sweep import Sweep


@dataclass(frozen=True, slots=True)
class Varied:
    """What varies, and what is marked of it."""

    vary: Annotated[
        list[str] | None,
        typer.Option(metavar="KEY=LOW..HIGH:N", help="A key and its range, such as motor.torque_limit=10Nm..21Nm:12."),
    ] = None
    values: Annotated[
        list[str] | None, typer.Option(metavar="KEY=A,B,C", help="A key and its values, such as board=ladder,h.")
    ] = None
    mark: Annotated[
        list[str] | None,
        typer.Option(metavar="KEY=VALUE", help="Mark a value of a varied key, or low..high, in table and picture."),
    ] = None


@takes_options
def sweep(
    task: TaskName,
    varied: Varied,
    planner: PlannerName = "exact",
    overrides: Overrides = None,
    seed: Annotated[int, typer.Option(min=0, help="Of the genetic planner.")] = 0,
    evaluations: Annotated[int, typer.Option(min=1, help="Most plans that the genetic planner tries.")] = 50_000,
    stances: Annotated[int, typer.Option(min=1, help="Most stances that the exact planner keeps.")] = 2_000_000,
    *,
    words: WorkerOptions,
) -> None:
    """Plan at every point of a range: where a plan exists, how long the shortest is, how hard it loads the joints."""
    words.check()
    check_output(words.output, ".csv")
    from ..planning.axes import check_axes, range_axis, read_mark, values_axis

    axes = [*map(range_axis, varied.vary or ()), *map(values_axis, varied.values or ())]
    check_axes(axes)
    marks = [read_mark(text, axes) for text in varied.mark or ()]
    from ..planning.planners import accepts
    from ..planning.sweep import run_sweep

    stated = {"max_evaluations": evaluations, "max_stances": stances}
    limits = {"seed": seed} | {option: most for option, most in stated.items() if accepts(planner, option)}
    with words.keeping("points") as batch:
        result = run_sweep(
            task,
            axes,
            overrides=overrides or (),
            planner=planner,
            options=limits,
            executor=words.executor,
            marks=marks,
            store=batch.store,
            resume=words.resume,
            progress=batch.line.update,
        )
    if words.output is not None and words.output.suffix.lower() == ".csv":
        result.save_table(words.output)
    elif words.output is not None:
        from ..viewing.sweep_plot import draw_sweep

        draw_sweep(result, words.output)
    if words.as_json:
        print_json(result)
    else:
        _print_sweep(stdout(), result, words.output)
    raise typer.Exit(0 if result.found else 1)


def _print_sweep(console: Console, sweep: "Sweep", output: Path | None) -> None:
    """Print the points as a table, and the reasons of those without a plan, once each."""
    unit, size, digits = sweep.units.torque
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
            *("-" if torque is None else f"{torque / size:.{digits}f}" for torque in torques),
            f"{point.seconds:.1f}",
        )
    console.print(table)
    console.print(f"torque: largest of the plan's joints [{unit}]; least: the least that it can be in any plan, proved")
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
    tell_written(console, output)


def _short(value: str) -> str:
    """A value with at most six digits of its number."""
    from ..units import split_quantity

    parts = split_quantity(value)
    return value if parts is None else f"{parts[0]:.6g} {parts[1]}".rstrip()
