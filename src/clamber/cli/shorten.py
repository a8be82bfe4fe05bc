"""`clamber shorten`: make any plan shorter."""

from pathlib import Path
from typing import Annotated

import typer

from ..terminal.name_completion import names_of
from ..terminal.options import Overrides, Told, takes_options
from ..terminal.output import check_writable, print_json, stderr, stdout


@takes_options
def shorten(
    plan: Annotated[Path, typer.Argument(help="A plan: JSON of `clamber plan -o`, or TOML in the thesis's numbers.")],
    task: Annotated[
        str | None,
        typer.Option(help="Polish it in this task, in place of its own.", autocompletion=names_of("tasks")),
    ] = None,
    overrides: Overrides = None,
    width: Annotated[int, typer.Option(min=0, help="Width of the beam about the plan; 0 for none.")] = 300,
    effort: Annotated[int, typer.Option(min=0, help="Most stances of the exact searches about it.")] = 300_000,
    steady: Annotated[
        int | None,
        typer.Option(metavar="STEP", help="Of a climber: then make this step's grab where limbs are least stretched."),
    ] = None,
    seconds: Annotated[float | None, typer.Option(min=0.0, help="Most time to take.")] = None,
    *,
    told: Told,
) -> None:
    """Make a plan that reaches its goal shorter, by search about it; every check of the task still holds."""
    check_writable(told.output)
    from ..planning.problem.plan_source import open_plan
    from ..planning.shorten import polish_plan
    from .plan.text import ProgressLine, print_result

    opened = open_plan(plan, task, overrides or ())
    with ProgressLine(stderr(), quiet=told.quiet) as line:
        result = polish_plan(
            opened.task, opened.plan, width=width, effort=effort, seconds=seconds, progress=line.update, label=str(plan)
        )
    if steady is not None:
        from ..families.climber.trials.stretch_repair import steadied_result

        result = steadied_result(result, steady, str(plan))
    if told.output is not None:
        result.plan.save(told.output)
    if told.as_json:
        print_json(result)
    else:
        print_result(stdout(), result, told.output)
