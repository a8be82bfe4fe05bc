"""The benchmark `boards`: every planner on the benchmark set, as rows."""

from .contest import run_contest
from .planner_trials import Crew
from .rows import Row, Say, keep_quiet
from .tables import rows_of


def bench_boards(*, say: Say = keep_quiet, crew: Crew | None = None) -> list[Row]:
    """Success, cost, length and proofs of every planner on the whole set."""
    say("every planner on 45 boards")
    return rows_of(run_contest(crew=crew))
