"""`clamber list`: names of what there is."""

from collections.abc import Callable
from enum import StrEnum
from typing import Annotated, Final

import typer

from ..studies.library import study_titles
from ..terminal.catalogue import ENTRIES
from ..terminal.options import AsJson
from ..terminal.output import print_json, stdout
from ..viewing.text_table import plain_table


class Listed(StrEnum):
    """What can be listed."""

    families = "families"
    robots = "robots"
    boards = "boards"
    grounds = "grounds"
    tasks = "tasks"
    walks = "walks"
    plans = "plans"
    planners = "planners"
    checks = "checks"
    controllers = "controllers"
    plants = "plants"
    studies = "studies"


LISTED: Final[dict[str, Callable[[], list[tuple[str, str]]]]] = ENTRIES | {
    "studies": lambda: list(study_titles().items())
}
"""Kind -> names and titles of everything of that kind."""


def list_names(
    what: Annotated[Listed | None, typer.Argument(help="One kind; all kinds unless given.")] = None,
    as_json: AsJson = False,
) -> None:
    """List families, robots, boards, grounds, tasks, walks, plans, planners, checks, controllers, plants and studies by name."""
    if as_json:
        kinds = list(Listed) if what is None else [what]
        print_json(
            {kind.value: [{"name": name, "title": title} for name, title in LISTED[kind.value]()] for kind in kinds}
        )
        return
    console = stdout()
    for number, kind in enumerate(Listed if what is None else [what]):
        if what is None:
            console.print(("\n" if number else "") + kind.value, style="bold")
        table = plain_table("name", "title")
        table.show_header = False
        for name, title in LISTED[kind.value]():
            table.add_row(("  " if what is None else "") + name, title)
        console.print(table)
