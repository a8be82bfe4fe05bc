"""The page of a run: what was planned, what became of every action, where it was close; any robot's, in the same words."""

import json
from collections.abc import Iterable
from dataclasses import dataclass
from operator import attrgetter
from pathlib import Path
from typing import Final, TypeVar

from ...files import write_atomically
from ...types import Json
from .pages import write_page, write_style

INDEX: Final = "index.html"
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


@dataclass(frozen=True, slots=True)
class Shown:
    """A picture or a moving one beside the page."""

    file: str
    caption: str


@dataclass(frozen=True, slots=True, kw_only=True)
class RunPage:
    """What a run's page says."""

    kind: str
    title: str
    done: bool
    reason: str
    """Why it ended, where it is not done."""
    facts: tuple[tuple[str, str], ...]
    """Name, value with unit."""
    command: str
    """What repeats it."""
    planned: tuple[str, ...]
    """Sentences."""
    planned_picture: Shown | None
    plan: Rows | None
    """The plan's actions."""
    close: Rows
    """Where it was close: what, how close, where."""
    happened: Rows
    """What became of every action."""
    picture: Shown
    motion: Shown
    """A page with a player, or a picture that moves."""
    data: Json
    """The whole run as plain data."""


def most(actions: Iterable[Told], name: str) -> list[Told]:
    """The few actions of which a number, such as "tries", is largest; the first of equals first."""
    return sorted(actions, key=attrgetter(name), reverse=True)[:MOST_TOLD]


def write_run_page(page: RunPage, folder: Path) -> Path:
    """Write page, data and style beside the pictures, the page last.

    Raises:
        FileError: If a file cannot be written.
    """
    write_atomically(folder / DATA, json.dumps(page.data, indent=1, allow_nan=False) + "\n")
    write_style(folder)
    write_page(folder / INDEX, "run", run=page, moves_by_itself=page.motion.file.endswith(".gif"), data=DATA)
    return folder / INDEX
