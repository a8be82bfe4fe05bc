"""The benchmark `boards`: every planner on the benchmark set, as rows."""

import os
from collections.abc import Callable

from ...jobs import Outcome
from ..rows import Row, Say, keep_quiet
from .contest import run_contest
from .tables import rows_of


def bench_boards(*, say: Say = keep_quiet) -> list[Row]:
    """Success, cost, length and proofs of every planner on the whole set, over a worker process a core."""
    return rows_of(run_contest(workers=os.cpu_count() or 1, progress=tell_tenths(say)))


def tell_tenths(say: Say) -> Callable[[int, int, Outcome], None]:
    """A listener that says how many trials have ended, ten times in all."""

    def listen(ended: int, total: int, _: Outcome) -> None:
        if ended == total or ended * 10 // total > (ended - 1) * 10 // total:
            say(f"{ended} of {total} trials")

    return listen
