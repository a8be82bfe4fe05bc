"""A result as a report keeps it: plain data and pictures, made once, read back when the pages are written."""

import json
import math
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Annotated, Any

from pydantic import StringConstraints, TypeAdapter, ValidationError

from .. import __version__
from ..errors import FileError
from ..files import content_hash, read_text, write_atomically
from ..jobs.release import release
from ..specs import spec
from .result import StudyResult, Value, Verdict

PictureFile = Annotated[str, StringConstraints(pattern=r"^[\w.-]+\.png$")]
"""Beside the result's page."""


@spec
class ToldFigure:
    """A picture of a result."""

    file: PictureFile
    caption: str


@spec
class ToldTable:
    """The rows behind a result."""

    columns: tuple[str, ...]
    rows: tuple[tuple[Value, ...], ...]


@spec
class ToldResult:
    """A result, what repeats it, and which Clamber made it."""

    paper: str
    result: str
    claim: str
    verdict: Verdict
    compared: tuple[tuple[str, Value, Value], ...]
    """What a number is, ours, the printed one."""
    deviations: tuple[str, ...]
    table: ToldTable | None
    figures: tuple[ToldFigure, ...]
    command: str
    seeds: str
    version: str
    sources: str
    """Of the release that it came from; see `sources`."""
    seconds: float
    """That it took."""


def keep_result(result: StudyResult, folder: Path, seconds: float) -> None:
    """Write a result's pictures and, last, its data into a folder.

    Raises:
        FileError: If one cannot be written.
    """
    figures = []
    for figure in result.figures:
        file = f"{result.result}-{figure.name}.png"
        figure.draw(folder / file)
        figures.append(ToldFigure(file=file, caption=figure.caption))
    told = ToldResult(
        paper=result.paper,
        result=result.result,
        claim=result.claim,
        verdict=result.verdict,
        compared=tuple((row.name, _plain(row.ours), _plain(row.printed)) for row in result.compared),
        deviations=result.deviations,
        table=None
        if result.table is None
        else ToldTable(
            columns=result.table.columns, rows=tuple(tuple(_plain(value) for value in row) for row in result.table.rows)
        ),
        figures=tuple(figures),
        command=result.command,
        seeds=seeds_in_words(result.seeds),
        version=__version__,
        sources=sources(),
        seconds=seconds,
    )
    write_atomically(folder / f"{result.result}.json", json.dumps(asdict(told), indent=1, allow_nan=False) + "\n")


def read_result(path: Path) -> ToldResult:
    """A result from the file that `keep_result` wrote.

    Raises:
        FileError: If it cannot be read or is no such file.
    """
    try:
        return _adapter().validate_json(read_text(path))
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(map(str, first["loc"])) or "the file"
        raise FileError(
            str(path), f"is no result of a report: {where}: {first['msg']}", "remove it and run the study again"
        ) from None


def seeds_in_words(seeds: range) -> str:
    """What is drawn from."""
    if not seeds:
        return "none: nothing is drawn"
    return str(seeds[0]) if len(seeds) == 1 else f"{seeds[0]} to {seeds[-1]}"


def sources() -> str:
    """SHA-256 of what results come from: all files of the package, and the versions of what it computes with."""
    return content_hash(release())


@cache
def _adapter() -> TypeAdapter[ToldResult]:
    return TypeAdapter(ToldResult)


def _plain(value: Any) -> Value:
    """The value as JSON has it: NumPy's numbers as Python's, none that is not finite."""
    plain = value.item() if hasattr(value, "item") else value
    return None if isinstance(plain, float) and not math.isfinite(plain) else plain
