"""What other packages add to Clamber, by name: found by their entry points, loaded only when it is asked for.

An error inside such a package is an `ExtensionError`, which names the thing, its package and the line that failed.
"""

import importlib.metadata
import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Any, Final

from .errors import ClamberError, UnknownNameError

GROUPS: Final[dict[str, str]] = {
    "families": "clamber.families",
    "robots": "clamber.robots",
    "checks": "clamber.checks",
    "planners": "clamber.planners",
    "controllers": "clamber.laws",
    "plants": "clamber.plants",
}
"""Kind of thing, as `clamber list` calls it -> group of entry points."""


class ExtensionError(ClamberError):
    """Something that another package adds cannot be used: names it, its package and what happened."""

    def __init__(self, kind: str, name: str, package: str, problem: str) -> None:
        super().__init__(kind, name, package, problem)
        self.kind, self.name, self.package, self.problem = kind, name, package, problem

    def __str__(self) -> str:
        return f"'{self.name}' of the package {self.package} ({GROUPS[self.kind]}): {self.problem}"


def outside(kind: str) -> dict[str, EntryPoint]:
    """Name -> entry point of everything of one kind that other packages add; nothing is loaded.

    Where two packages take one name, that of the package whose name comes first counts; `clamber doctor` tells of both.
    """
    points = sorted(all_outside(kind), key=lambda point: (point.name, package_of(point)))
    found: dict[str, EntryPoint] = {}
    for point in points:
        found.setdefault(point.name, point)
    return found


def all_outside(kind: str) -> tuple[EntryPoint, ...]:
    """Every entry point of one kind, those of a name that is taken twice too."""
    return _all_outside(kind, tuple(sys.path))


@cache
def _all_outside(kind: str, path: tuple[str, ...]) -> tuple[EntryPoint, ...]:
    """Looked for once for each search path: every verdict asks for checks."""
    return tuple(importlib.metadata.entry_points(group=GROUPS[kind]))


def package_of(point: EntryPoint) -> str:
    """The package of an entry point with its version."""
    return "of no name" if point.dist is None else f"{point.dist.name} {point.dist.version}"


def outside_titles(kind: str) -> list[tuple[str, str]]:
    """Name and package of everything of one kind that other packages add."""
    return [(name, f"of the package {package_of(point)}") for name, point in outside(kind).items()]


def load_outside(kind: str, name: str) -> Any:
    """What another package adds under a name.

    Raises:
        UnknownNameError: If none does.
        ExtensionError: If it cannot be loaded.
    """
    points = outside(kind)
    if name not in points:
        raise UnknownNameError(kind.removesuffix("s"), name, tuple(points))
    with blamed(kind, name):
        return points[name].load()


@contextmanager
def blamed(kind: str, name: str) -> Iterator[None]:
    """Turns whatever goes wrong inside into an `ExtensionError` about the thing of this name; our own errors pass.

    Raises:
        ExtensionError: If anything does.
    """
    try:
        yield
    except ClamberError:
        raise
    except Exception as error:
        raise failure(kind, name, f"{type(error).__name__}: {error}{_where(error)}") from error


def failure(kind: str, name: str, problem: str) -> ExtensionError:
    """The error about a thing that another package adds."""
    point = outside(kind).get(name)
    return ExtensionError(kind, name, "of no name" if point is None else package_of(point), problem)


def _where(error: Exception) -> str:
    frames = traceback.extract_tb(error.__traceback__)
    return f" ({Path(frames[-1].filename).name}, line {frames[-1].lineno})" if frames else ""
