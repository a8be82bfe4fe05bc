"""Shares, causes and faults of many runs as a terminal shows them."""

from collections.abc import Sequence
from typing import Final

from rich.console import Console

from ..execution.fault import FAULTS
from ..trials.fault_trials import ENDINGS, FaultRow
from ..trials.trial_runs import wilson_interval
from .text_table import plain_table

MOST_NAMED: Final = 6
"""Seeds and steps of a cause that are named; the rest is in the JSON."""


def percent(done: int, n: int) -> str:
    """A share with its interval, such as "95.8 % (79.8 to 99.3 %, 95 %)"."""
    if n == 0:
        return "nothing to tell"
    return f"{100.0 * done / n:.1f} % ({share_range(wilson_interval(done, n))}, 95 %)"


def share_range(interval: tuple[float, float]) -> str:
    """An interval of a share, such as "92.6 to 100.0 %"."""
    low, high = interval
    return f"{100.0 * low:.1f} to {100.0 * high:.1f} %"


def some(numbers: Sequence[int]) -> str:
    """The first few numbers of many."""
    shown = ", ".join(map(str, numbers[:MOST_NAMED]))
    return f"{shown} ..." if len(numbers) > MOST_NAMED else shown


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
