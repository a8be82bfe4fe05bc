"""Results as a report keeps them, plain data and pictures, and the site of them that opens from a disk: a page for each, a table of all."""

import json
import math
import time
from collections import Counter
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Annotated, Any, Final

from pydantic import StringConstraints, TypeAdapter, ValidationError

from .. import __version__
from ..errors import FileError
from ..files import content_hash, read_text, write_atomically
from ..jobs.release import release
from ..regular_files import is_file, make_folder
from ..specs import spec
from ..viewing.report.pages import open_report, write_page, write_style
from .library import STUDIES, TITLES
from .result import Cells, StudyResult, Value, Verdict

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
    rows: tuple[Cells, ...]


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


INDEX: Final = "index.html"


class StudySite:
    """A report of studies in a folder. It is whole after every result, so one that was stopped can be gone on with.

    Args:
        folder: Its folder; made if need be. An earlier report's results stay until they are made again.

    Raises:
        FileError: If it cannot be made, holds something else, or one of its results cannot be read.
    """

    def __init__(self, folder: Path) -> None:
        open_report(folder, "studies")
        self.folder = folder
        self._told: dict[tuple[str, str], ToldResult] = {}
        for paper, results in STUDIES.items():
            for result in results:
                path = folder / paper / f"{result}.json"
                if is_file(path):
                    self._told[paper, result] = read_result(path)

    @property
    def index(self) -> Path:
        """The page to open first."""
        return self.folder / INDEX

    def has(self, paper: str, result: str) -> bool:
        """Whether a result is there already, made by the very same sources."""
        told = self._told.get((paper, result))
        return told is not None and told.sources == sources()

    def add(self, result: StudyResult, began: float) -> None:
        """Keep a result and write the pages that it changes.

        Args:
            result: The result.
            began: `time.perf_counter()` when work on it began.

        Raises:
            FileError: If a file cannot be written.
        """
        seconds = time.perf_counter() - began
        own = self.folder / result.paper
        make_folder(own)
        keep_result(result, own, seconds)
        self._told[result.paper, result.result] = read_result(own / f"{result.result}.json")
        self.write()

    def write(self) -> None:
        """Write all pages, the table of all results last.

        Raises:
            FileError: If one cannot be written.
        """
        told = [
            self._told[paper, result]
            for paper, results in STUDIES.items()
            for result in results
            if (paper, result) in self._told
        ]
        write_style(self.folder)
        for k, one in enumerate(told):
            before = told[k - 1] if k else None
            after = told[k + 1] if k + 1 < len(told) else None
            write_page(self.folder / one.paper / f"{one.result}.html", "result", told=one, before=before, after=after)
        states = len({(one.version, one.sources) for one in told})
        counts = Counter(one.verdict for one in told)
        write_page(
            self.index,
            "studies",
            studies=[
                {"name": paper, "title": TITLES[paper], "results": [one for one in told if one.paper == paper]}
                for paper in STUDIES
                if any(one.paper == paper for one in told)
            ],
            counts={
                verdict: counts[verdict] for verdict in ("holds", "consistent", "differs", "open") if counts[verdict]
            },
            mixed=states if states > 1 else 0,
        )
