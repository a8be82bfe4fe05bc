"""Studies as a site that opens from a disk: a page for each result, kept as it ends, and a table of all."""

import time
from collections import Counter
from pathlib import Path
from typing import Final

from ..regular_files import is_file, make_folder
from ..viewing.report.pages import open_report, write_page, write_style
from .library import STUDIES, TITLES
from .result import StudyResult
from .told import ToldResult, keep_result, read_result, sources

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
