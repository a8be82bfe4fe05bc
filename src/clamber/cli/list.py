"""`clamber list`: names of what there is."""

from enum import StrEnum
from typing import Annotated

import typer

from .output import plain_table, stdout


class Listed(StrEnum):
    """What can be listed."""

    robots = "robots"
    boards = "boards"
    tasks = "tasks"
    planners = "planners"
    studies = "studies"


def list_names(what: Annotated[Listed | None, typer.Argument(help="One kind; all kinds unless given.")] = None) -> None:
    """List robots, boards, tasks, planners and studies by name."""
    from .catalogue import entries

    console = stdout()
    for number, kind in enumerate(Listed if what is None else [what]):
        if what is None:
            console.print(("\n" if number else "") + kind.value, style="bold")
        table = plain_table("name", "title")
        table.show_header = False
        for name, title in entries(kind.value):
            table.add_row(("  " if what is None else "") + name, title)
        console.print(table)
