"""`clamber inventory`: the action modules of a task, and what the filters dropped and why."""

from typing import Annotated

import typer

from ..terminal.options import AsJson, Overrides, TaskName
from ..terminal.output import print_indented, print_json, stdout
from ..viewing.text_table import plain_table


def inventory(
    task: TaskName,
    overrides: Overrides = None,
    length: Annotated[int, typer.Option(min=1, help="Actions of a plan, for the size of the search.")] = 60,
    as_json: AsJson = False,
) -> None:
    """List the modules that a plan can be made of, and by how much the filters shrink the search, D = N^m."""
    from ..planning.problem.problems import pose_problem
    from ..tasks import load_task

    posed = pose_problem(load_task(task, overrides or ()))
    report = posed.sized(length)
    if as_json:
        print_json(report)
        return
    console = stdout()
    console.print(f"{task}: {report.modules} modules of {report.full_size}")
    print_indented(console, ", ".join(report.names))
    table = plain_table("filter", "dropped", "why")
    for dropped in posed.dropped:
        table.add_row(dropped.filter, str(len(dropped.names)), dropped.reason)
    console.print(table)
    console.print(
        f"plans of {length} actions: 10^{report.log10_before:.1f} before, 10^{report.log10_after:.1f} after the filters"
    )
