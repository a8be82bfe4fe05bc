"""`clamber bench boards`: every planner on the benchmark set."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.console import Console

from .output import check_writable, plain_table, print_json, stdout

if TYPE_CHECKING:
    from ..experiments.trials import Crew

TABLES = (".md", ".csv")


def bench_boards(crew: "Crew", *, output: Path | None, as_json: bool) -> None:
    """Run the contest and print its tables.

    Args:
        crew: Who runs the trials, and where they are kept.
        output: Picture, table (.md) or trials (.csv) to write.
        as_json: Print the rows as JSON.
    """
    check_writable(output)
    if output is not None:
        from ..viewing.output import CANVASES, check_suffix

        check_suffix(output, (*CANVASES, *TABLES))
    from ..experiments.boards.contest import run_contest
    from ..experiments.boards.tables import rows_of, save_markdown, save_trials

    contest = run_contest(crew=crew)
    if output is not None and output.suffix.lower() not in TABLES:
        from ..viewing.boards_plot import draw_boards

        draw_boards(contest, output)
    elif output is not None:
        (save_markdown if output.suffix.lower() == ".md" else save_trials)(contest, output)
    if as_json:
        print_json(rows_of(contest))
    else:
        print_contest(stdout(), contest, output)


def print_contest(console: Console, contest: Any, output: Path | None) -> None:
    """Print the tables, what the columns mean, and whatever contradicts a proof."""
    from ..experiments.boards.standing import contradictions
    from ..experiments.boards.tables import tables

    for told in tables(contest):
        console.print(told.title, style="bold")
        table = plain_table(*told.columns, right=told.columns[1:])
        for row in told.rows:
            table.add_row(*row)
        console.print(table)
        console.print()
    console.print(
        f"a trial may judge {contest.allowance.checks} actions; solved: with a plan that holds, of the boards that have "
        "one; gap: median length above the optimum; none: told: proofs, of the boards that have no plan"
    )
    wrong = contradictions(contest, contest.truths())
    for line in wrong:
        console.print(line, style="bold red", soft_wrap=True)
    if not wrong:
        console.print("no answer contradicts a proof")
    if output is not None:
        console.print(f"written to {output}", soft_wrap=True)
