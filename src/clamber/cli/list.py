"""`clamber list`: names of what there is."""

from collections.abc import Callable
from enum import StrEnum
from typing import Annotated, Final

import typer

from ..studies.library import study_titles
from ..tasks.library import task_family
from ..terminal.catalogue import ENTRIES
from ..terminal.options import AsJson
from ..terminal.output import print_json, stdout
from ..types import Json
from ..viewing.text_table import plain_table


class Listed(StrEnum):
    """What can be listed."""

    families = "families"
    robots = "robots"
    boards = "boards"
    grounds = "grounds"
    worlds = "worlds"
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


def _entry(kind: Listed, name: str, title: str) -> Json:
    """A name with its title; of a task also the family of its robot."""
    entry = {"name": name, "title": title}
    return entry | {"family": task_family(name)} if kind is Listed.tasks else entry


def list_names(
    what: Annotated[Listed | None, typer.Argument(help="One kind; all kinds unless given.")] = None,
    as_json: AsJson = False,
) -> None:
    """List families, robots, boards, grounds, worlds, tasks, walks, plans, planners, checks, controllers, plants and studies by name."""
    if as_json:
        kinds = list(Listed) if what is None else [what]
        print_json({kind.value: [_entry(kind, *named) for named in LISTED[kind.value]()] for kind in kinds})
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
