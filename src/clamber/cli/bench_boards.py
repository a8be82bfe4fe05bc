"""`clamber bench boards`: every planner on the benchmark set."""

from pathlib import Path
from typing import Any

from rich.console import Console

from .crew import EndsLine, executor_of
from .output import announce_compilation, check_writable, plain_table, print_json, stderr, stdout

TABLES = (".md", ".csv")


def bench_boards(
    workers: int | None, ray: str | None, *, store: Path | None, resume: bool, output: Path | None, as_json: bool
) -> None:
    """Run the contest and print its tables.

    Args:
        workers: Processes; None for one a core.
        ray: Address of a Ray cluster to run it on instead.
        store: SQLite file that keeps each trial as it ends.
        resume: Whether to go on with it.
        output: Picture, table (.md) or trials (.csv) to write.
        as_json: Print the rows as JSON.
    """
    check_writable(output)
    if output is not None:
        from ..viewing.output import CANVASES, check_suffix

        check_suffix(output, (*CANVASES, *TABLES))
    if ray is None:
        announce_compilation("simulate")
    from ..experiments.boards.contest import run_contest
    from ..experiments.boards.tables import rows_of, save_markdown, save_trials

    contest = run_contest(
        executor=executor_of(ray, workers),
        store=store,
        resume=resume,
        progress=EndsLine(stderr(), "trials", quiet=False).update,
    )
    if output is not None and output.suffix.lower() not in TABLES:
        from ..viewing.boards_plot import draw_boards

        draw_boards(contest, output)
    elif output is not None:
        (save_markdown if output.suffix.lower() == ".md" else save_trials)(contest, output)
    if as_json:
        print_json([row.to_json() for row in rows_of(contest)])
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
