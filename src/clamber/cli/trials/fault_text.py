"""Trials with faults as people read them: a row for each kind."""

from collections.abc import Sequence

from rich.console import Console

from ...execution.fault import FAULTS
from ...experiments.fault_trials import ENDINGS, FaultRow
from ..output import plain_table


def any_error(rows: Sequence[FaultRow]) -> bool:
    """Whether a trial raised."""
    return any(row.endings["error"] for row in rows)


def print_faults(console: Console, rows: Sequence[FaultRow]) -> None:
    """Print how trials with each kind of fault ended, how many noticed it, and how soon."""
    table = plain_table("fault", "n", *ENDINGS, "noticed", "after [s]", right=("n", *ENDINGS, "noticed", "after [s]"))
    for row in rows:
        delay = "" if row.delay is None else f"{row.delay:.2f}"
        table.add_row(row.kind, str(row.n), *(str(row.endings[name]) for name in ENDINGS), str(row.noticed), delay)
    console.print(table)
    for row in rows:
        if row.kind in FAULTS:
            console.print(f"{row.kind}: {FAULTS[row.kind].words}", soft_wrap=True)
