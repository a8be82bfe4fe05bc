"""`clamber check`: carry a plan out again and judge every step."""

from pathlib import Path
from typing import Annotated

import typer

from .options import AsJson, Overrides
from .output import announce_compilation, print_json, stdout


def check(
    plan: Annotated[
        Path,
        typer.Argument(
            help="JSON of `clamber plan -o`, TOML in the thesis's numbers, or a name (`clamber list plans`)."
        ),
    ],
    task: Annotated[str | None, typer.Option(help="Check it in this task, in place of its own.")] = None,
    overrides: Overrides = None,
    everything: Annotated[bool, typer.Option("--all", help="Go on past a violation, and print every step.")] = False,
    as_json: AsJson = False,
) -> None:
    """Carry a plan out again: every step, every margin, the first violation and by how much."""
    announce_compilation()
    from ..actions.plan_source import open_plan
    from .verdict_text import print_verdict

    verdict = open_plan(plan, task, overrides or ()).check(go_on=everything)
    if as_json:
        print_json(verdict.to_json())
    else:
        print_verdict(stdout(), verdict, every_step=everything)
    raise typer.Exit(0 if verdict.ok else 1)
