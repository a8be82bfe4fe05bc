"""Options of the functions that work through many items, checked as the command line checks its own."""

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, TypedDict

from pydantic import TypeAdapter, ValidationError

from ..errors import OptionError, describe_choices
from ..jobs import Executor, LocalProcesses, RayCluster


class Crew(TypedDict, total=False):
    """Who works, and where what ends is kept."""

    workers: int | None
    """Processes; None: one a core."""
    ray: str | None
    """HOST:PORT of a Ray cluster that works in their place."""
    store: str | Path | None
    """SQLite file that keeps each item as it ends."""
    resume: bool
    """Whether to go on with it."""


class Runs(Crew, total=False):
    """How something is carried out many times."""

    planner: str
    """Of a task without a plan; "auto" unless given."""
    seconds: float
    """Most time of the search for that plan [s]; 600 unless given."""
    law: str | None
    """Of the whole body of a robot in space; "whole-body" unless given."""
    replan: bool
    """Whether a robot plans again where a hold cannot be had; True unless given."""
    force: bool
    """Whether to carry out a plan that its checks refuse."""
    task: str | None
    """A task in place of the one that a plan names."""


def check_options(given: Mapping[str, Any], kinds: Mapping[str, Any], *, signed: bool = False) -> None:
    """Make sure that options are known ones, each of its kind, and no number below 0 unless they are `signed`.

    Raises:
        OptionError: Otherwise.
    """
    for name, value in given.items():
        if name not in kinds:
            raise OptionError(name, "is no option here", f"there are {describe_choices(name, kinds)}")
        check_kind(name, value, kinds[name], signed=signed)


def check_kind(name: str, value: Any, kind: Any, *, signed: bool = False) -> None:
    """Make sure that a value is of the kind that an option takes, and no number below 0 unless it is `signed`.

    Raises:
        OptionError: Otherwise.
    """
    try:
        TypeAdapter(kind, config={"arbitrary_types_allowed": True}).validate_python(value, strict=True)
    except ValidationError:
        words = kind.__name__ if isinstance(kind, type) else str(kind).replace("pathlib.", "").replace("typing.", "")
        raise OptionError.of_value(name, value, "is not what it takes", f"it takes {words}") from None
    if isinstance(value, int | float) and not signed and not value >= 0:
        raise OptionError(name, f"{value} is below 0, or no number", "it must be 0 or more")


def texts(name: str, given: str | Sequence[str]) -> tuple[str, ...]:
    """One text or several.

    Raises:
        OptionError: If it is neither.
    """
    found = (given,) if isinstance(given, str) else given
    if not isinstance(found, Sequence) or not all(isinstance(text, str) for text in found):
        raise OptionError.of_value(name, given, "is no text, nor several", "write it as on the command line")
    return tuple(found)


def executor_for(crew: Crew) -> Executor:
    """Who works.

    Raises:
        OptionError: If there is to be gone on with no store, or no process is asked for.
        ClusterError: If there is no such cluster.
    """
    workers, address = crew.get("workers"), crew.get("ray")
    if crew.get("resume") and crew.get("store") is None:
        raise OptionError("resume", "there is nothing to go on with", "name the `store`")
    if workers == 0:
        raise OptionError("workers", "0 processes do nothing", "it must be 1 or more")
    made: Executor = (
        RayCluster(address, workers) if address is not None else LocalProcesses(workers or os.cpu_count() or 1)
    )
    made.check()
    return made


def store_of(crew: Crew) -> Path | None:
    """Where what ends is kept."""
    store = crew.get("store")
    return None if store is None else Path(store)
