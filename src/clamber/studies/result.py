"""One published result repeated: the claim, what we get, what is printed, the verdict, and where we deviate."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal, TypeAlias

from ..json_form import HIDDEN, Jsonable, Key, in_json

Verdict: TypeAlias = Literal["holds", "consistent", "differs", "open"]
Value: TypeAlias = int | float | str | None
Cells: TypeAlias = tuple[Value, ...]
"""A row of a table."""


@dataclass(frozen=True, slots=True)
class Compared:
    """One number, ours beside the printed one."""

    name: str
    """What it is, with its unit in brackets."""
    ours: Value
    printed: Value = None
    """None where nothing is printed."""


@dataclass(frozen=True, slots=True)
class Table:
    """Rows behind the numbers, for the report."""

    columns: tuple[str, ...]
    rows: tuple[Cells, ...]


@dataclass(frozen=True, slots=True)
class Figure:
    """A picture the report draws."""

    name: str
    """Of the file, without suffix."""
    caption: str
    draw: Callable[[Path], object]
    """Draws it into a file whose suffix says the format."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StudyResult(Jsonable):
    """A published result and ours."""

    paper: str = ""
    """As the command line calls it; filled in, as the next, by what repeats it (`library.Repeat`)."""
    result: str = ""
    """Its name on the command line."""
    claim: str
    """What the paper says, in our words, with the place where it says so."""
    verdict: Verdict
    """holds: we get it too; consistent: likewise, but numbers of ours were fitted to it; differs: we do not; open: what is printed, or
    what we did, does not decide it."""
    compared: Annotated[tuple[Compared, ...], HIDDEN]
    deviations: tuple[str, ...]
    """What we inferred, chose or left out, each in a sentence."""
    table: Annotated[Table | None, HIDDEN] = None
    figures: Annotated[tuple[Figure, ...], HIDDEN] = ()
    seeds: Annotated[range, Key(kind=tuple[int, ...])] = range(0)
    """What it draws from; empty: nothing is drawn."""
    options: Annotated[str, HIDDEN] = ""
    """Of the command that repeats it, where they are not its usual ones."""

    @property
    @in_json()
    def command(self) -> str:
        """What repeats it."""
        return f"clamber study {self.paper} {self.result} {self.options}".rstrip()

    @property
    @in_json(after="verdict")
    def numbers(self) -> dict[str, Value]:
        """Name -> our value, each printed one under the same name with ", printed"."""
        out: dict[str, Value] = {}
        for row in self.compared:
            out[row.name] = row.ours
            if row.printed is not None:
                out[f"{row.name}, printed"] = row.printed
        return out
