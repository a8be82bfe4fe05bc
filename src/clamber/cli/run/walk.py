"""`clamber run` of a walk: what the command says about two-frame walkers, and nothing of climbers."""

from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np
import typer
from rich.console import Console

from ...families.walker.execution.walk_report import WalkReport
from ...families.walker.execution.walking import Lay
from ...families.walker.planning import Walk
from ...families.walker.trials.held_point import HeldPoint
from ...families.walker.trials.run_walk import WalkRun, run_walk, walk_flaws
from ...planning.problem.plan import Plan
from ...trials.plant_settings import split_settings
from ...units import DEGREE
from ..for_climbs import refuse_for_walk
from ..live_line import LiveLine
from ..output import announce_compilation, plain_table, print_json, stderr, stdout
from .options import RunOptions
from .report import RunReport


class WalkLine(LiveLine):
    """Follows a walk."""

    def update(self, step: int, way: float, whole: float) -> None:
        """Show the step that begins."""
        self.show(f"step {step}: {way:.2f} of {whole:.2f} m")


CLIMBS_ONLY: Final = ("task", "planner", "seconds", "save_plan", "peg_error", "replan", "plant", "force")
"""Options of `run` that a walk has no use for."""


def run_walk_file(what: str, words: RunOptions, telling: RunReport) -> None:
    """Carry a walk out and say how it went; leaves with 1 where it did not come to its end.

    Args:
        what: The walk's name or file.
        words: How.
        telling: Its report, if one is asked for.
    """
    from ...families.walker.planning import load_walk

    refuse_for_walk(what, words, CLIMBS_ONLY)
    announce_compilation(quiet=words.quiet)
    walk_and_tell(load_walk(what, split_settings(words.overrides or ())[0]), words, telling)


def walk_and_tell(
    walk: Walk, words: RunOptions, telling: RunReport, lay: Lay | None = None, plan: Plan | None = None
) -> None:
    """Carry a walk out, along its own way or another course, write files and say how it went; leaves with 1 where it did not end well."""
    from ...families.walker.trials.noise import named_walk_noise, read_walk_noise
    from ...viewing.pictures import check_run_suffix, draw_run

    for file in words.outputs:
        check_run_suffix(file)
    telling.open("walk")
    deviations = read_walk_noise(named_walk_noise("none"), words.noise or ())
    flaws = walk_flaws(walk, split_settings(words.overrides or ())[1])
    with WalkLine(stderr(), quiet=words.quiet) as line:
        log = words.log(line.say)
        run = run_walk(walk, flaws, noise=deviations, seed=words.seed, lay=lay, progress=line.update, log=log)
    for file in words.outputs:
        if file != words.growing:
            draw_run(run, file)
    page = telling.of(run, plan)
    if words.as_json:
        print_json(run)
    else:
        print_walk(stdout(), run, (*words.written(run.log_gap), *page))
    raise typer.Exit(130 if run.report.reason == "interrupted" else 0 if run.done else 1)


def print_walk(console: Console, run: WalkRun, written: Sequence[Path] = ()) -> None:
    """Print how a walk ended, a row for each step, and where it was close."""
    report = run.report
    if run.done:
        console.print(f"walked: {len(report.steps)} steps of '{run.walk.name}'", style="bold green")
    else:
        console.print(f"not walked: '{run.walk.name}'", style="bold red")
        console.print(run.reason)
    console.print(_steps(report))
    speed = report.seconds / run.wall_seconds if run.wall_seconds > 0.0 else 0.0
    console.print(f"{report.seconds:.0f} s in {run.wall_seconds:.1f} s ({speed:.0f} times as fast as it happens)")
    x, y, z, alpha = (report.true_pose or report.pose)[:4]
    console.print(f"plate at x {x:.3f} m, y {y:.3f} m, z {z:.3f} m, heading {alpha / DEGREE:.1f} deg")
    if report.missed is not None:
        off, turned = report.missed
        console.print(f"{1e3 * off:.1f} mm and {turned / DEGREE:.2f} deg from where the way ends")
    console.print(f"largest tilt while walking {run.tilt / DEGREE:.3f} deg, least margin {_millimetres(run.margin)}")
    if run.held is not None:
        for line in held_lines(run.held):
            console.print(line)
    if report.kicks:
        console.print(f"kicked {report.kicks} times: the plate tilted without its legs telling")
    if run.log_gap is not None:
        console.print(str(run.log_gap), soft_wrap=True)
    for path in written:
        console.print(f"written: {path}", soft_wrap=True)


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


def _steps(report: WalkReport) -> object:
    table = plain_table("step", "frame", "way [m]", "outcome", "from [s]", "off [mm]", "reckoned margin",
                        right=("step", "way [m]", "from [s]", "off [mm]", "reckoned margin"))  # fmt: skip
    for step in report.steps:
        off = f"{1e3 * step.off:.1f}" if np.isfinite(step.off) else ""
        table.add_row(
            str(step.number), step.frame, f"{step.way:.3f}", step.outcome, f"{step.start:.0f}", off, _millimetres(step.balance)
        )  # fmt: skip
    return table


def _millimetres(margin: float) -> str:
    return f"{1e3 * margin:.0f} mm" if np.isfinite(margin) else "none: fewer than three feet on the ground"
