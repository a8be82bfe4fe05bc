"""What an inspection answers."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Set
from dataclasses import dataclass, field
from typing import Annotated, Any, TypeAlias

import numpy as np

from ..json_form import HIDDEN, Jsonable, in_json
from ..notebook import OneLine
from ..shown_units import SI, ShownUnits, Unit
from ..types import Floats

Kind: TypeAlias = str
"""What a file is: "robot", "task", "plan", or one of the kinds of a family, such as "board"."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Margin(Jsonable):
    """One check of a start stance."""

    check: str
    unit: str
    margin: float | None
    """Signed, in `unit`: positive holds; None where nothing limits it."""
    hard: bool
    """Whether the task's rules forbid what violates it."""
    meaning: Annotated[str, HIDDEN]

    @property
    @in_json()
    def holds(self) -> bool:
        """Whether it does."""
        return self.margin is None or self.margin >= 0.0


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Finding(Jsonable, OneLine):
    """What a file is and what is to be said of it; a file that breaks a rule of its format is an error, exit code 2."""

    kind: Kind
    name: str
    title: str
    facts: dict[str, str]
    """Word -> value with its unit, for people."""
    odd: tuple[str, ...] = ()
    """What is allowed and yet most likely not meant, in sentences."""
    margins: tuple[Margin, ...] = field(default=())
    """Of a task's start stance, in the order of its checks."""
    units: Annotated[ShownUnits, HIDDEN] = SI
    """In which margins are printed."""

    def told(self) -> str:
        """What it is, and whether it holds."""
        return f"{self.kind} {self.name!r}: {'ok' if self.ok else 'VIOLATED'}, {len(self.odd)} things odd"

    @property
    @in_json(after="kind")
    def ok(self) -> bool:
        """Whether every hard check holds; files without a start are always."""
        return all(margin.holds for margin in self.margins if margin.hard)


@dataclass(frozen=True, slots=True)
class FileKind:
    """A kind of file that only one family has."""

    schema: str
    """As the file says it."""
    names: Callable[[], tuple[str, ...]]
    """Of those that come with Clamber."""
    load: Callable[[str], Any]
    """By name or path, with all checks."""
    inspect: Callable[[Any, ShownUnits], Finding]
    suffixes: tuple[str, ...] = ()
    """Of files that say no schema."""


def span_words(values: Iterable[float], shown: Unit) -> str:
    """The least and the largest of some values, such as "0.4 to 0.5 m"; one of them where they are alike."""
    unit, size, _ = shown
    sizes = [value / size for value in values]
    low, high = min(sizes), max(sizes)
    return f"{low:.4g} {unit}" if high - low < 1e-9 else f"{low:.4g} to {high:.4g} {unit}"


def nearest(points: Floats) -> Floats:
    """Distance of each of some points, shape (n, d), from the one nearest to it [m], shape (n,); infinite for a single one."""
    from scipy.spatial import cKDTree  # takes a tenth of a second to import

    if len(points) < 2:
        return np.full(len(points), np.inf)
    away: Floats = cKDTree(points).query(points, k=2)[0][:, 1]
    return away


def _nothing(task: Any, hard: Set[str]) -> Iterator[str]:
    return iter(())


@dataclass(frozen=True, slots=True)
class Inspection:
    """What is told of a family's files, and what is odd about them."""

    robot: Callable[[Any, ShownUnits], Finding]
    kinds: Mapping[str, FileKind]
    """Kind -> how its files are read and inspected."""
    odd_task: Callable[[Any, Set[str]], Iterator[str]] = _nothing
    """What is odd about a task with these hard checks, beside what is odd about any."""
