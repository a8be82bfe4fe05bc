"""Rows of benchmarks and results of studies as people read them."""

from collections.abc import Iterable

from rich.console import Console

from ..experiments.benches import Row
from ..studies.result import StudyResult
from .output import plain_table, print_indented

STYLES = {"holds": "bold green", "consistent": "bold cyan", "differs": "bold red", "open": "bold yellow"}
"""Verdict -> colour."""


def print_rows(console: Console, rows: Iterable[Row]) -> None:
    """Print a benchmark's rows."""
    table = plain_table("name", "value", "unit", "aim", right=("value",))
    for row in rows:
        table.add_row(row.name, f"{row.value:.4g}", row.unit, "" if row.aim is None else str(row.aim))
    console.print(table)


def print_results(console: Console, results: Iterable[StudyResult]) -> None:
    """Print each result: verdict, claim, numbers, deviations."""
    for result in results:
        console.print(f"{result.result}: {result.verdict}", style=STYLES[result.verdict])
        print_indented(console, f"claim: {result.claim}")
        table = plain_table("  number", "value", right=("value",))
        for name, value in result.numbers.items():
            table.add_row(f"  {name}", f"{value:.6g}" if isinstance(value, float) else str(value))
        console.print(table)
        for deviation in result.deviations:
            print_indented(console, f"deviation: {deviation}")
