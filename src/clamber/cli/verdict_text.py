"""A verdict as people read it: one line, the tightest step of every check, warnings, the final pose."""

from rich.console import Console

from ..actions.step_verdict import StepVerdict
from ..actions.verdict import Verdict
from ..units import DEGREE, INCH, OZ_IN
from .output import plain_table

SHOWN = {"m": (1000.0, "mm"), "rad": (1.0 / DEGREE, "deg"), "1": (1.0, "")}
"""SI unit of a margin -> factor and unit that people read."""


def print_verdict(console: Console, verdict: Verdict, *, every_step: bool) -> None:
    """Print it; `every_step` adds a line for each step."""
    first = verdict.first_violation
    if first is None:
        console.print(f"OK: all {verdict.length} actions hold", style="bold green")
    else:
        console.print(
            f"VIOLATED at step {first.step} of {verdict.length} ({_action(first)}): {first.reason}", style="bold red"
        )
    for note in verdict.notes:
        console.print(f"note: {note}")
    console.print(_summary(verdict))
    if every_step:
        console.print()
        _print_steps(console, verdict)
    elif first is not None:
        console.print("the replay stopped there; --all goes on")
    console.print()
    _print_tightest(console, verdict)
    if warnings := verdict.warnings():
        console.print()
        console.print("warnings, of checks that only report:")
        for name, steps in warnings.items():
            listed = ", ".join(map(str, steps[:8])) + (", ..." if len(steps) > 8 else "")
            console.print(f"  {name}: {len(steps)} step{'s' if len(steps) > 1 else ''} ({listed})")
    if agree := verdict.nearest_agree():
        differs = [f"{row.step} ({row.hold}, not {row.nearest})" for row in verdict.per_step if _differs(row)]
        where = f"; it differs at step {', '.join(differs)}" if differs else ""
        console.print()
        console.print(f"the rule 'nearest' takes the printed peg in {agree[0]} of {agree[1]} grabs{where}")


def _differs(row: StepVerdict) -> bool:
    return row.nearest is not None and row.nearest != row.hold


def _summary(verdict: Verdict) -> str:
    x, y, theta = verdict.pose
    held = ", ".join(f"{limb} {hold or 'free'}" for limb, hold in verdict.holds.items())
    loaded = any(check.name == "torque" for check in verdict.checks)
    held = f"; holds: {held}" if held else ""
    reached = "goal reached" if verdict.reached else "goal not reached"
    torque = f"largest torque {verdict.max_torque / OZ_IN:.0f} oz-in, power {verdict.max_power:.1f} W, "
    return (
        f"{verdict.steps} of {verdict.length} actions of '{verdict.task}' hold; "
        f"{reached} ({verdict.goals_met} of {verdict.goals})\n"
        f"{f'{torque}energy {verdict.energy:.0f} J' + chr(10) if loaded else ''}"
        f"end: x {x / INCH:.2f} in, y {y / INCH:.2f} in, theta {theta / DEGREE:.1f} deg{held}"
    )


def _print_tightest(console: Console, verdict: Verdict) -> None:
    table = plain_table("check", "", "smallest margin", "step", "action", right=("smallest margin", "step"))
    tightest = verdict.tightest()
    for check in verdict.checks:
        if check.name in tightest:
            margin, step = tightest[check.name]
            kind = "hard" if check.name in verdict.hard else "reports"
            table.add_row(
                check.name, kind, margin_text(check.unit, margin), str(step), _action(verdict.per_step[step - 1])
            )
    console.print(table)


def _print_steps(console: Console, verdict: Verdict) -> None:
    names = [name for name in ("reach", "joint", "torque", "clearance") if name in verdict.tightest()]
    checks = {check.name: check for check in verdict.checks}
    table = plain_table("step", "action", "oz-in", *names, "violated", right=("step", "oz-in", *names))
    for row in verdict.per_step:
        margins = (row.margins[name] for name in names)
        violated = (*((row.check.upper(),) if row.check else ()), *row.reported)
        table.add_row(
            str(row.step),
            _action(row),
            "-" if row.max_torque is None else f"{row.max_torque / OZ_IN:.0f}",
            *("-" if m is None else margin_text(checks[n].unit, m) for n, m in zip(names, margins, strict=True)),
            " ".join(violated),
            style="bold red" if not row.ok else None,
        )
    console.print(table)


def _action(row: StepVerdict) -> str:
    text = str(row.asked)
    return text if row.hold is None or text.endswith(f"{row.hold:02d}") else f"{text} -> {row.hold}"


def margin_text(unit: str, margin: float) -> str:
    """A margin, given in an SI unit, with a unit that people read."""
    factor, unit = SHOWN.get(unit, (1.0, unit))
    return f"{margin * factor:+.4g} {unit}".rstrip()
