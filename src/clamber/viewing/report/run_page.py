"""The report of a run: what was planned, what became of every action, where it was close; any robot's, in the same words."""

import json
from collections.abc import Iterable
from dataclasses import dataclass
from importlib.util import find_spec
from operator import attrgetter
from pathlib import Path
from typing import Any, Final, TypeVar

from ...family import NotOfFamilyError, family_of
from ...files import write_atomically
from ...planning.problem.plan import Plan
from ..pictures import draw_route, draw_run, pictures_of
from .pages import write_page, write_style

INDEX: Final = "index.html"
PLAN_PICTURE: Final = "plan.png"
DATA: Final = "run.json"
"""What `clamber run --json` prints."""
MILLI: Final = 1e3
MOST_TOLD: Final = 3
"""Actions told as the longest, or as those that took most tries."""

Told = TypeVar("Told")
"""What became of an action."""


@dataclass(frozen=True, slots=True)
class Rows:
    """A table."""

    columns: tuple[str, ...]
    rows: tuple[tuple[int | float | str | None, ...], ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class RunPage:
    """What a family says of a run."""

    kind: str
    facts: tuple[tuple[str, str], ...]
    """Name, value with unit."""
    planned: tuple[str, ...]
    """Sentences."""
    plan: Rows | None
    """The plan's actions."""
    close: tuple[tuple[str, str, str], ...]
    """Where it was close: what, how close, where."""
    happened: Rows
    """What became of every action."""
    picture: str
    """Caption of the whole run in one picture."""
    motion: str
    """Suffix of what moves: a page with the viewer, or a picture."""
    keeps_plan: bool = False
    """Whether the plan and a picture of it are beside the page."""


def most(actions: Iterable[Told], name: str) -> list[Told]:
    """The few actions of which a number, such as "tries", is largest; the first of equals first."""
    return sorted(actions, key=attrgetter(name), reverse=True)[:MOST_TOLD]


def plan_words(plan: Plan, task: str) -> str:
    """How long a plan for a task is, and what made it."""
    seed = "" if plan.seed is None else f", seed {plan.seed}"
    return f"{len(plan.actions)} actions for the task '{task}', made by {plan.planner or 'hand'}{seed}."


def write_run_report(run: Any, command: str, folder: Path) -> Path:
    """Write the report of a run into a folder that `open_report` made, the page last; returns the page.

    Args:
        run: What was carried out.
        command: What repeats it.
        folder: The folder.

    Raises:
        NotOfFamilyError: If the family has no such reports.
        FileError: If a file cannot be written.
    """
    write = pictures_of(run.work).report
    if write is None:
        raise NotOfFamilyError(family_of(run.work).title, "reports of runs")
    page, plan = write(run), run.plan
    motion = page.motion if page.motion != ".html" or find_spec("viser") else ".gif"
    picture, moving = f"{page.kind}.png", f"{page.kind}{motion}"
    for file in (picture, moving):
        draw_run(run, folder / file)
    if page.keeps_plan and plan is not None:
        draw_route(run.work, plan, folder / PLAN_PICTURE)
        plan.save(folder / "plan.json")
    write_atomically(folder / DATA, json.dumps(run.to_json(), indent=1, allow_nan=False) + "\n")
    write_style(folder)
    write_page(
        folder / INDEX,
        "run",
        run=run,
        title=run.work.title or run.work.name,
        page=page,
        close=Rows(("What", "How close", "Where"), page.close),
        command=command,
        still=picture,
        moving=moving,
        plan_picture=PLAN_PICTURE,
        data=DATA,
    )
    return folder / INDEX
