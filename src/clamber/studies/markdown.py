"""Studies as Markdown: one page and its pictures per result, and one page over all results of a paper."""

from collections.abc import Sequence
from pathlib import Path

from ..files import write_atomically
from ..regular_files import make_folder
from .library import STUDIES
from .result import StudyResult, Table, Value


def write_markdown(results: Sequence[StudyResult], folder: Path) -> None:
    """Write FOLDER/PAPER/RESULT.md with its pictures for each result; with all results of a paper, FOLDER/PAPER.md too.

    Raises:
        FileError: If the folder cannot be made or written.
    """
    for result in results:
        own = folder / result.paper
        make_folder(own)
        for figure in result.figures:
            figure.draw(own / f"{_stem(result, figure.name)}.png")
        write_atomically(own / f"{result.result}.md", result_page(result))
    for paper, functions in STUDIES.items():
        told = [result for result in results if result.paper == paper]
        if [result.result for result in told] == list(functions):
            write_atomically(folder / f"{paper}.md", paper_page(paper, told))


def paper_page(paper: str, results: Sequence[StudyResult]) -> str:
    """The verdict on every result of a paper, with its numbers and deviations."""
    lines = [
        f"# Study {paper}",
        "",
        f"Written by `clamber study {paper} --markdown docs/studies`; do not edit by hand.",
        "",
        "| result | verdict | claim |",
        "|---|---|---|",
    ]
    lines += [
        f"| [{result.result}]({paper}/{result.result}.md) | {result.verdict} | {result.claim} |" for result in results
    ]
    for result in results:
        lines += ["", f"## {result.result}: {result.verdict}", "", *_body(result, paper + "/")]
    return "\n".join(lines) + "\n"


def result_page(result: StudyResult) -> str:
    """One result as a page of its own, with the table behind it."""
    lines = [f"# {result.result}: {result.verdict}", "", *_body(result, "")]
    if result.table is not None:
        lines += ["", *_table(result.table)]
    return "\n".join(lines) + "\n"


def _body(result: StudyResult, place: str) -> list[str]:
    lines = [f"Claim: {result.claim}", "", f"Command: `{result.command}`", ""]
    columns = ("number", "ours", "printed")
    lines += _table(Table(columns, tuple((row.name, row.ours, row.printed) for row in result.compared)))
    lines += ["", "Deviations:", "", *(f"- {deviation}" for deviation in result.deviations)]
    for figure in result.figures:
        lines += ["", f"![{figure.caption}]({place}{_stem(result, figure.name)}.png)", "", f"*{figure.caption}*"]
    return lines


def _table(table: Table) -> list[str]:
    rows = ["| " + " | ".join(_shown(value) for value in row) + " |" for row in table.rows]
    return ["| " + " | ".join(map(_shown, table.columns)) + " |", "|" + "---|" * len(table.columns), *rows]


def _shown(value: Value) -> str:
    if value is None:
        return ""
    return f"{value:.6g}" if isinstance(value, float) else str(value).replace("|", "\\|")


def _stem(result: StudyResult, name: str) -> str:
    return f"{result.result}-{name}"
