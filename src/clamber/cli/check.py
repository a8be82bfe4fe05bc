"""`clamber check`: what is wrong with a file: a robot, a board, a ground, a task, a walk; a plan is carried out again."""

from typing import TYPE_CHECKING, Annotated

import typer

from .name_completion import names_of
from .options import AsJson, Overrides
from .output import announce_compilation, print_json, stdout

if TYPE_CHECKING:
    from ..inspection.finding import Finding


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
    if kind == "task":
        announce_compilation()
    finding = inspect_file(what, kind, overrides or [])
    if as_json:
        print_json(finding)
    else:
        _print_finding(finding)
    raise typer.Exit(0 if finding.ok else 1)


def _check_plan(what: str, task: str | None, overrides: list[str], everything: bool, as_json: bool) -> None:
    announce_compilation()
    from ..actions.plan_source import open_plan
    from ..actions.verdict import CheckedPlan
    from .verdict_text import print_verdict

    verdict = open_plan(what, task, overrides).check(go_on=everything)
    if as_json:
        print_json(CheckedPlan(verdict=verdict))
    else:
        print_verdict(stdout(), verdict, every_step=everything)
    raise typer.Exit(0 if verdict.ok else 1)


def _print_finding(finding: "Finding") -> None:
    from .output import plain_table
    from .verdict_text import margin_text

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
            size = "unlimited" if margin.margin is None else margin_text(margin.unit, margin.margin)
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
        console.print(f"OK: it follows its format{start}; {nothing}", style="bold green")
