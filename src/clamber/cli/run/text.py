"""A climb that was carried out as people read it: a live line on the way, and a table of what became of the actions."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from rich.console import Console

from ...families.climber.execution.climb_report import ActionReport
from ...families.climber.trials.run_plan import ClimbRun
from ..live_line import LiveLine
from ..output import plain_table


class ClimbLine(LiveLine):
    """Follows a climb."""

    def update(self, step: int, steps: int, title: str, time: float) -> None:
        """Show the action that begins."""
        self.show(f"action {step} of {steps}: {title}, at {time:.0f} s")


def print_run(console: Console, run: ClimbRun, written: Sequence[Path] = ()) -> None:
    """Print how a climb ended, a row for each kind of action, where it was close, and which hooks came off and were brought back."""
    report = run.report
    if report.done:
        console.print(f"climbed: {_count(report.actions)} actions of '{run.task.name}'", style="bold green")
    else:
        console.print(f"not climbed: '{run.task.name}'", style="bold red")
        console.print(report.reason)
    numbers = ("times", "ok", "recovered", "time [s]", "pushes", "worst tip [mm]")
    table = plain_table(
        "action", "times", "ok", "recovered", "other", "time [s]", "pushes", "worst tip [mm]", right=numbers
    )
    for kind in dict.fromkeys(action.kind for action in report.actions):
        rows = [action for action in report.actions if action.kind == kind]
        table.add_row(*_row(kind, rows))
    console.print(table)
    speed = report.seconds / run.wall_seconds if run.wall_seconds > 0.0 else 0.0
    console.print(f"{report.seconds:.1f} s in {run.wall_seconds:.1f} s ({speed:.0f} times as fast as it happens)")
    x, y, theta = report.pose if report.true_pose is None else report.true_pose
    turn = round(float(np.degrees(theta)), 1) + 0.0  # never "-0.0"
    console.print(f"body at x {x:.3f} m, y {y:.3f} m, {turn:.1f} deg; {1e3 * report.short:.0f} mm from the goal")
    _print_close(console, report.actions)
    for note in report.replans:
        console.print(f"planned again after action {note.after}: {note.length} actions, without {note.without}")
    for objection in report.forced:
        console.print(f"forced in spite of {objection}")
    if run.log_gap is not None:
        console.print(str(run.log_gap), soft_wrap=True)
    for path in written:
        console.print(f"written: {path}", soft_wrap=True)


def _row(kind: str, rows: list[ActionReport]) -> tuple[str, ...]:
    ok = sum(_steps(row) for row in rows if row.outcome == "ok")
    others = [row.outcome for row in rows if row.outcome != "ok"]
    words = ", ".join(f"{others.count(name)} {name}" for name in dict.fromkeys(others))
    errors = [row.tip_error for row in rows if row.tip_error is not None]
    worst = f"{1e3 * max(errors):.1f}" if errors else ""
    pushes = str(sum(row.tries for row in rows)) if kind == "grab" else ""
    seconds = sum(row.seconds for row in rows)
    recovered = sum(row.recovered for row in rows)
    return kind, str(_count(rows)), str(ok), str(recovered), words, f"{seconds:.1f}", pushes, worst


def _print_close(console: Console, actions: list[ActionReport]) -> None:
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
        console.print(f"farthest from its aim: step {farthest.steps}, {farthest.title}: {1e3 * farthest.off:.0f} mm")


def _steps(action: ActionReport) -> int:
    return action.last - action.first + 1


def _count(actions: list[ActionReport]) -> int:
    return sum(map(_steps, actions))
