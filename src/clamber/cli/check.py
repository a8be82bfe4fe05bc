"""`clamber check`: what is wrong with a file: a robot, a board, a ground, a task, a walk; a plan is carried out again."""

from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console

from ..terminal.name_completion import names_of
from ..terminal.options import AsJson, Overrides
from ..terminal.output import print_json, stdout
from ..viewing.text_table import plain_table

if TYPE_CHECKING:
    from ..inspection.finding import Finding
    from ..planning.problem.verdict import StepVerdict, Verdict


def check(
    what: Annotated[
        str,
        typer.Argument(
            metavar="FILE|NAME",
            help="A robot, board, ground, task, walk or plan: its file, or a name. Plans are JSON of `clamber plan -o`, "
            "TOML in the thesis's numbers, or names (`clamber list plans`).",
            autocompletion=names_of("robots", "boards", "grounds", "tasks", "walks", "plans"),
        ),
    ],
    task: Annotated[
        str | None,
        typer.Option(help="Check a plan in this task, in place of its own.", autocompletion=names_of("tasks")),
    ] = None,
    overrides: Overrides = None,
    everything: Annotated[
        bool, typer.Option("--all", help="Of a plan: go on past a violation, and print every step.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Say what is wrong with a file; of a task whether its start holds, of a plan every step, every margin, the first violation."""
    from ..inspection.open_file import inspect_file, kind_of

    kind = kind_of(what)
    if kind == "plan":
        _check_plan(what, task, overrides or [], everything, as_json)
    if task is not None or everything:
        raise typer.BadParameter(f"is for plans; '{what}' is a {kind}", param_hint="--task" if task else "--all")
    if overrides and kind != "task":
        raise typer.BadParameter(f"is for plans and tasks; '{what}' is a {kind}", param_hint="--set")
    finding = inspect_file(what, kind, overrides or [])
    if as_json:
        print_json(finding)
    else:
        _print_finding(finding)
    raise typer.Exit(0 if finding.ok else 1)


def _check_plan(what: str, task: str | None, overrides: list[str], everything: bool, as_json: bool) -> None:
    from ..planning.problem.plan_source import open_plan
    from ..planning.problem.verdict import CheckedPlan
    from ..trials.work import to_run
    from .plan.text import print_to_run

    opened = open_plan(what, task, overrides)
    verdict, judged = opened.check(go_on=everything), to_run(opened.task, opened.plan, opened.label)
    if as_json:
        print_json(CheckedPlan(verdict=verdict, to_run=judged))
    else:
        _print_verdict(stdout(), verdict, every_step=everything)
        print_to_run(stdout(), judged)
    raise typer.Exit(0 if verdict.ok else 1)


def _print_finding(finding: "Finding") -> None:
    console = stdout()
    console.print(f"{finding.kind} '{finding.name}'" + (f": {finding.title}" if finding.title else ""), style="bold")
    facts = plain_table("", "")
    facts.show_header = False
    for word, value in finding.facts.items():
        facts.add_row(f"  {word}", value)
    console.print(facts)
    if finding.margins:
        console.print()
        table = plain_table("check of the start", "", "margin", "", right=("margin",))
        for margin in finding.margins:
            size = "unlimited" if margin.margin is None else finding.units.signed(margin.margin, margin.unit)
            kind, state = "hard" if margin.hard else "reports", "" if margin.holds else "VIOLATED"
            bad = margin.hard and not margin.holds
            table.add_row(margin.check, kind, size, state, style="bold red" if bad else None)
        console.print(table)
        for margin in finding.margins:
            if not margin.holds:
                console.print(f"{margin.check}: {margin.meaning}")
    for line in finding.odd:
        console.print(f"odd: {line}", style="yellow")
    if not finding.ok:
        console.print("VIOLATED: the start breaks a hard check", style="bold red")
    else:
        nothing = "nothing is odd" if not finding.odd else f"{len(finding.odd)} odd"
        start = "; the start holds" if finding.margins else ""
        reported = [margin.check for margin in finding.margins if not margin.holds]
        start += f", but violates {', '.join(reported)} (only reported)" if reported else ""
        console.print(f"OK: it follows its format{start}; {nothing}", style="bold green")


def _print_verdict(console: Console, verdict: "Verdict", *, every_step: bool) -> None:
    """Print it; `every_step` adds a line for each step."""
    first = verdict.first_violation
    if first is None:
        console.print(f"OK: all {verdict.length} actions hold", style="bold green")
    else:
        action = first.action.title
        console.print(
            f"VIOLATED at step {first.step} of {verdict.length} ({action}): {verdict.why(first)}", style="bold red"
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


def _differs(row: "StepVerdict") -> bool:
    return row.nearest is not None and row.nearest != row.hold


def _summary(verdict: "Verdict") -> str:
    from ..planning.problem.body_pose import describe_body_pose

    units = verdict.units
    unit, size, digits = units.torque
    held = ", ".join(f"{limb} {hold or 'free'}" for limb, hold in verdict.holds.items())
    loaded = any(check.name == "torque" for check in verdict.checks)
    held = f"; holds: {held}" if held else ""
    reached = "goal reached" if verdict.reached else "goal not reached"
    loads = f"largest torque {verdict.max_torque / size:.{digits}f} {unit}" if loaded else ""
    if loaded and verdict.max_power is not None:
        loads += f", power {verdict.max_power:.1f} W, energy {verdict.energy:.0f} J"
    return (
        f"{verdict.steps} of {verdict.length} actions of '{verdict.task}' hold; "
        f"{reached} ({verdict.goals_met} of {verdict.goals})\n"
        f"{loads + chr(10) if loads else ''}"
        f"end: {describe_body_pose(verdict.pose_axes, verdict.pose, units)}{held}"
    )


def _print_tightest(console: Console, verdict: "Verdict") -> None:
    table = plain_table("check", "", "smallest margin", "step", "action", right=("smallest margin", "step"))
    tightest = verdict.tightest()
    for check in verdict.checks:
        if check.name in tightest:
            margin, step = tightest[check.name]
            kind = "hard" if check.name in verdict.hard else "reports"
            table.add_row(
                check.name,
                kind,
                verdict.units.signed(margin, check.unit),
                str(step),
                verdict.per_step[step - 1].action.title,
            )
    console.print(table)


def _print_steps(console: Console, verdict: "Verdict") -> None:
    unit, size, digits = verdict.units.torque
    names = [name for name in ("reach", "joint", "torque", "clearance") if name in verdict.tightest()]
    checks = {check.name: check for check in verdict.checks}
    table = plain_table("step", "action", unit, *names, "violated", right=("step", unit, *names))
    for row in verdict.per_step:
        margins = (row.margins[name] for name in names)
        violated = (*((row.check.upper(),) if row.check else ()), *row.reported)
        table.add_row(
            str(row.step),
            _action(row),
            "-" if row.max_torque is None else f"{row.max_torque / size:.{digits}f}",
            *(
                "-" if m is None else verdict.units.signed(m, checks[n].unit)
                for n, m in zip(names, margins, strict=True)
            ),
            " ".join(violated),
            style="bold red" if not row.ok else None,
        )
    console.print(table)


def _action(row: "StepVerdict") -> str:
    text = str(row.asked)
    return text if row.hold is None or text.endswith(f"{row.hold:02d}") else f"{text} -> {row.hold}"
