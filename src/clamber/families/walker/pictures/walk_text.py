"""Walks as a terminal shows them: what became of the steps of one, and what many say together."""

from collections.abc import Sequence

import numpy as np
from rich.console import Console

from ....shown_units import ShownUnits, units_of
from ....trials.fault_trials import fault_rows
from ....trials.trial_runs import wilson_interval
from ....units import DEGREE
from ....viewing.text_table import plain_table
from ....viewing.trials_text import (
    between,
    print_causes,
    print_computing,
    print_ended,
    print_faults,
    print_spreads,
    some,
)
from ..execution.walk_report import WalkReport
from ..trials.held_point import HeldPoint
from ..trials.run_walk import WalkRun
from ..trials.trials import LEVEL, WalkTrials


def print_walk(console: Console, run: WalkRun) -> None:
    """Print how a walk ended, a row for each step, and where it was close."""
    report = run.report
    if run.done:
        console.print(f"walked: {len(report.steps)} steps of '{run.walk.name}'", style="bold green")
    else:
        console.print(f"not walked: '{run.walk.name}'", style="bold red")
        console.print(run.reason)
    units = units_of(run.walk.document)
    console.print(_steps(report, units))
    speed = report.seconds / run.wall_seconds if run.wall_seconds > 0.0 else 0.0
    console.print(f"{report.seconds:.0f} s in {run.wall_seconds:.1f} s ({speed:.0f} times as fast as it happens)")
    x, y, z, alpha = (report.true_pose or report.pose)[:4]
    console.print(
        f"plate at x {units.length(x)}, y {units.length(y)}, z {units.length(z)}, heading {alpha / DEGREE:.1f} deg"
    )
    if report.missed is not None:
        off, turned = report.missed
        console.print(f"{units.small(off, 1)} and {turned / DEGREE:.2f} deg from where the way ends")
    console.print(f"largest tilt while walking {run.tilt / DEGREE:.3f} deg, least margin {_margin(run.margin, units)}")
    if run.held is not None:
        for line in held_lines(run.held):
            console.print(line)
    if report.kicks:
        console.print(f"kicked {report.kicks} times: the plate tilted without its legs telling")


def held_lines(held: HeldPoint) -> list[str]:
    """Where the tool was to be held, and what came of it."""
    part = held.part
    reach = ", ".join(f"{first:.3f} to {last:.3f} m" for first, last in part.reach)
    lines = [f"the arm reaches the point from the way's {reach}; held from {part.first:.3f} to {part.last:.3f} m"]
    if not len(held.errors):
        return [*lines, "the robot did not come so far"]
    where = "the point" if len(part.points) == 1 else "its place on the line"
    largest, mean = 1e3 * float(held.errors.max()), 1e3 * float(held.errors.mean())
    seconds = float(held.time[-1] - held.time[0])
    lines.append(f"held for {seconds:.0f} s: the tool at most {largest:.2f} mm from {where}, {mean:.2f} mm on average")
    lines.append(
        f"joints {part.room / DEGREE:.1f} deg and more inside their ranges, at most {100.0 * part.speed:.0f} % of their speed; "
        f"manipulability of the arm {part.measures[0]:.3f} and more, {part.measures[1]:.3f} on average"
    )
    if part.raised != (0.0, 0.0):
        least, most = (1e3 * raised for raised in part.raised)
        lines.append(f"the plate {least:.0f} to {most:.0f} mm higher for the tool than walking would have it")
    return lines


def _steps(report: WalkReport, units: ShownUnits) -> object:
    way, off_by = (f"{word} [{shown[0]}]" for word, shown in (("way", units.place), ("off", units.gap)))
    table = plain_table("step", "frame", way, "outcome", "from [s]", off_by, "reckoned margin",
                        right=("step", way, "from [s]", off_by, "reckoned margin"))  # fmt: skip
    for step in report.steps:
        off = f"{step.off / units.gap[1]:.{units.gap[2] or 1}f}" if np.isfinite(step.off) else ""
        come = f"{step.way / units.place[1]:.1f}"
        margin = _margin(step.balance, units)
        table.add_row(str(step.number), step.frame, come, step.outcome, f"{step.start:.0f}", off, margin)
    return table


def _margin(margin: float, units: ShownUnits) -> str:
    return units.small(margin) if np.isfinite(margin) else "none: fewer than three feet on the ground"


def _likely(interval: tuple[float, float]) -> str:
    low, high = interval
    return f"95 % between {100 * low:.1f} and {100 * high:.1f} %"


def print_walk_trials(console: Console, trials: WalkTrials, seeds: Sequence[int]) -> None:
    """Print how often walks came to their end, and the spread of what is measured of them."""
    n = len(trials.ended)
    print_ended(console, trials, f"walks '{trials.setup.name}'", seeds)
    balanced = between(trials.balanced_interval())
    console.print(f"{trials.balanced} of {n} kept their balance throughout: {balanced}")
    causes = trials.causes()
    if causes:
        print_causes(console, causes)
    if trials.setup.faults:
        print_faults(console, fault_rows(trials.ended))
    lost = [trial.seed for trial in trials.ended if trial.done and not (trial.margin or 0.0) > 0.0]
    if lost:
        console.print(f"came to their end without a margin of balance at some tick: seeds {some(lost)}")
    rows = (
        ("tilt [deg]", "tilt", DEGREE, 3), ("margin [mm]", "margin", 1e-3, 1), ("off [mm]", "off", 1e-3, 1),
        ("heading off [deg]", "turned", DEGREE, 2), ("time [s]", "seconds", 1.0, 0), ("kicks", "kicks", 1.0, 0),
        ("held over [m]", "held_way", 1.0, 3), ("held, farthest [mm]", "held_error", 1e-3, 2),
    )  # fmt: skip
    spreads = []
    for title, name, unit, digits in rows:
        values = trials.of(name) / unit
        some_only = name == "margin" and len(values) < n
        spreads.append((f"{title}, of {len(values)}" if some_only else title, values, digits))
    print_spreads(console, spreads)
    if trials.setup.levels:
        console.print(
            f"{trials.level} of {n} came to their end with the plate never more than {LEVEL / DEGREE:g} deg from level: "
            f"{between(wilson_interval(trials.level, n))}"
        )
    print_computing(console, trials, 0)
