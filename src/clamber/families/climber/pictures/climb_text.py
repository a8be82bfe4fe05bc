"""Climbs as a terminal shows them: what became of the actions of one, and what many say together."""

from collections.abc import Sequence

import numpy as np
from rich.console import Console

from ....shown_units import SI, ShownUnits, units_of
from ....trials.held_out import seeds_in_words
from ....viewing.text_table import plain_table
from ....viewing.trials_text import percent, print_causes, print_effects, print_faults
from ..execution.climb_report import ActionReport
from ..trials.noise import NOISE
from ..trials.run_plan import ClimbRun
from ..trials.trial_summary import Spread, TrialSummary


def print_run(console: Console, run: ClimbRun) -> None:
    """Print how a climb ended, a row for each kind of action, where it was close, and which hooks came off and were brought back."""
    report = run.report
    if report.done:
        console.print(f"climbed: {_count(report.actions)} actions of '{run.task.name}'", style="bold green")
    else:
        console.print(f"not climbed: '{run.task.name}'", style="bold red")
        console.print(report.reason)
    units = units_of(run.task.document)
    worst = f"worst tip [{units.gap[0]}]"
    numbers = ("times", "ok", "recovered", "time [s]", "pushes", worst)
    table = plain_table("action", "times", "ok", "recovered", "other", "time [s]", "pushes", worst, right=numbers)
    for kind in dict.fromkeys(action.kind for action in report.actions):
        rows = [action for action in report.actions if action.kind == kind]
        table.add_row(*_row(kind, rows, units))
    console.print(table)
    speed = report.seconds / run.wall_seconds if run.wall_seconds > 0.0 else 0.0
    console.print(f"{report.seconds:.1f} s in {run.wall_seconds:.1f} s ({speed:.0f} times as fast as it happens)")
    x, y, theta = report.pose if report.true_pose is None else report.true_pose
    turn = round(float(np.degrees(theta)), 1) + 0.0  # never "-0.0"
    place = f"x {units.length(x)}, y {units.length(y)}, {turn:.1f} deg"
    console.print(f"body at {place}; {units.small(report.short)} from the goal")
    _print_close(console, report.actions, units)
    for note in report.replans:
        console.print(f"planned again after action {note.after}: {note.length} actions, without {note.without}")
    for objection in report.forced:
        console.print(f"forced in spite of {objection}")


def _row(kind: str, rows: list[ActionReport], units: ShownUnits) -> tuple[str, ...]:
    ok = sum(_steps(row) for row in rows if row.outcome == "ok")
    others = [row.outcome for row in rows if row.outcome != "ok"]
    words = ", ".join(f"{others.count(name)} {name}" for name in dict.fromkeys(others))
    errors = [row.tip_error for row in rows if row.tip_error is not None]
    worst = f"{max(errors) / units.gap[1]:.{units.gap[2] or 1}f}" if errors else ""
    pushes = str(sum(row.tries for row in rows)) if kind == "grab" else ""
    seconds = sum(row.seconds for row in rows)
    recovered = sum(row.recovered for row in rows)
    return kind, str(_count(rows)), str(ok), str(recovered), words, f"{seconds:.1f}", pushes, worst


def _print_close(console: Console, actions: list[ActionReport], units: ShownUnits) -> None:
    """The actions in which hooks came off, the grab that took most pushes, and the move that ended farthest from its aim."""
    for action in actions:
        if action.recovered:
            times = "once" if action.recovered == 1 else f"{action.recovered} times"
            console.print(f"recovered {times}: step {action.steps}, {action.title}: a hook had come off")
    grabs = [action for action in actions if action.kind == "grab"]
    hardest = max(grabs, key=lambda action: action.tries, default=None)
    if hardest is not None and hardest.tries > 1:
        console.print(f"hardest grab: step {hardest.steps}, {hardest.title}: {hardest.tries} pushes")
    moves = [action for action in actions if action.kind == "move"]
    farthest = max(moves, key=lambda action: action.off, default=None)
    if farthest is not None:
        console.print(f"farthest from its aim: step {farthest.steps}, {farthest.title}: {units.small(farthest.off)}")


def _steps(action: ActionReport) -> int:
    return action.last - action.first + 1


def _count(actions: list[ActionReport]) -> int:
    return sum(map(_steps, actions))


def print_trials(console: Console, summary: TrialSummary, seeds: Sequence[int], units: ShownUnits = SI) -> None:
    """Print success with its interval, a row for each cause of failure, times, and a row for each key of the noise."""
    n, done = summary.n, summary.done
    early = f" (of {summary.asked} asked for)" if n < summary.asked else ""
    console.print(f"{done} of {n} climbs of '{summary.task}' succeeded{early}: {percent(done, n)}", style="bold")
    console.print(seeds_in_words(seeds))
    console.print(f"noise: {summary.noise}")
    for objection in summary.forced:
        console.print(f"forced in spite of {objection}")
    if summary.causes:
        print_causes(console, summary.causes)
    if summary.seconds is not None:
        console.print(f"time of a climb: {_times(summary.seconds)}")
    if summary.per_rung is not None:
        console.print(f"for each 6 in of way: {_times(summary.per_rung)}")
    if summary.short is not None:
        middle, high = map(units.small, (summary.short.median, summary.short.high))
        console.print(f"body from the goal at the end: {middle} (95 %: at most {high})")
    if summary.pushes is not None:
        console.print(
            f"pushes for each grab: {summary.pushes:.2f}; moves that did not arrive: {summary.stalled}; "
            f"climbs with a new plan: {summary.replanned}"
        )
    if summary.recovered:
        console.print(
            f"hooks that came off and were brought back: {summary.recovered}, in {summary.recovering} climbs, "
            f"{summary.saved} of which succeeded"
        )
    if summary.speed is not None:
        console.print(f"{summary.speed:.0f} times as fast as it happens, each worker")
    if summary.faults:
        print_faults(console, summary.faults)
    if summary.effects:
        print_effects(console, summary.effects, NOISE)


def _times(spread: Spread) -> str:
    return f"{spread.median:.1f} s (5 to 95 %: {spread.low:.1f} to {spread.high:.1f} s)"
