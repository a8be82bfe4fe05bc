"""`clamber bench`: measure speed and success, beside peers."""

import shlex
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console

from ..interrupts import answer, passed_on
from ..terminal.options import AsJson, Output, Ray, Resume, Store, Workers
from ..terminal.output import check_writable, print_json, stderr, stdout, tell_written
from ..terminal.worker_options import Batch, EndsLine, check_resume, executor_of, keeping
from ..viewing.text_table import plain_table

if TYPE_CHECKING:
    from ..trials.measured import Crew, Row


def bench(
    names: Annotated[list[str] | None, typer.Argument(help="Benchmarks, in this order; all unless given.")] = None,
    workers: Workers = None,
    ray: Ray = None,
    store: Store = None,
    resume: Resume = False,
    output: Output = None,
    as_json: AsJson = False,
) -> None:
    """Measure speed and success, ours beside those of peers; seeds, ablation and boards are batches, with workers and a store.

    Leaves with 1 where a plant in real time stopped because the machine was too busy: that benchmark is left out.
    """
    check_resume(resume, store)
    from ..benchmarks.benches import BATCHED, BENCHES, run_bench
    from ..trials.measured import Crew

    chosen = tuple(names or BENCHES)
    only = chosen[0] if len(chosen) == 1 else None
    _check_asked(chosen, only, batch=bool(workers or ray or store), own_crew=bool(workers or store), output=output)
    executor = executor_of(ray, workers)
    if ray is not None:
        executor.check()

    def crew_of(batch: Batch) -> "Crew":
        return Crew(executor=executor, store=batch.store, resume=resume, progress=batch.line.update)

    if only == "boards":
        bench_boards(crew_of, store, output=output, as_json=as_json)
        return
    from ..execution.plant import PlantStoppedError

    measured = {}
    for name in chosen:
        line = EndsLine(stderr(), f"items of {name}", quiet=False)
        try:
            if name in BATCHED:
                with keeping(store, line) as batch, passed_on():
                    measured[name] = run_bench(name, partial(line.show, now=True), crew_of(batch))
            else:
                with line, passed_on():
                    measured[name] = run_bench(name, partial(line.show, now=True))
        except PlantStoppedError as stop:
            stderr().print(f"{name} is left out: {stop}; is the machine too busy for a plant in real time?")
        except KeyboardInterrupt:
            answer()
            stderr().print(f"interrupted while {name} was measured; told is what was measured before")
            break
        except typer.Exit:  # of a batch that was interrupted
            break
    rows = [row for each in measured.values() for row in each]
    if output is not None:
        from ..benchmarks.starts import performance_page
        from ..files import write_atomically

        write_atomically(
            output, performance_page(measured, shlex.join(("clamber", "bench", *chosen, "-o", str(output))))
        )
    if as_json:
        print_json(rows)
    else:
        _print_rows(stdout(), rows)
    raise typer.Exit(0 if len(measured) == len(chosen) else 1)


def _check_asked(
    chosen: tuple[str, ...], only: str | None, *, batch: bool, own_crew: bool, output: Path | None
) -> None:
    from ..benchmarks.benches import BATCHED, BENCHES
    from ..errors import UnknownNameError

    for name in chosen:
        if name not in BENCHES:
            raise UnknownNameError("benchmark", name, tuple(BENCHES))
    if batch and only not in BATCHED:
        raise typer.BadParameter(f"are for one of {', '.join(BATCHED)}", param_hint="--workers, --ray, --store")
    if only == "jobs" and own_crew:
        raise typer.BadParameter(
            "measures workers and stores of its own; it takes --ray", param_hint="--workers, --store"
        )
    if output is not None and only != "boards":
        check_writable(output)
        if output.suffix.lower() != ".md":
            raise typer.BadParameter(
                f"{output}: a page is Markdown (.md); pictures are of `boards` alone", param_hint="--output"
            )


TABLES = (".md", ".csv")


def bench_boards(crew_of: "Callable[[Batch], Crew]", store: Path | None, *, output: Path | None, as_json: bool) -> None:
    """Run the contest and print tables.

    Args:
        crew_of: Who runs a batch.
        store: Where its trials are kept.
        output: Picture, table (.md) or trials (.csv) to write.
        as_json: Print the rows as JSON.
    """
    check_writable(output)
    if output is not None:
        from ..viewing.output import CANVASES, check_suffix

        check_suffix(output, (*CANVASES, *TABLES))
    from ..benchmarks.contest import run_contest
    from ..benchmarks.tables import rows_of, save_markdown, save_trials

    with keeping(store, EndsLine(stderr(), "trials", quiet=False)) as batch, passed_on():
        contest = run_contest(crew=crew_of(batch))
    if output is not None and output.suffix.lower() not in TABLES:
        from ..benchmarks.pictures.boards_plot import draw_boards

        draw_boards(contest, output)
    elif output is not None:
        (save_markdown if output.suffix.lower() == ".md" else save_trials)(contest, output)
    if as_json:
        print_json(rows_of(contest))
    else:
        print_contest(stdout(), contest, output)


def print_contest(console: Console, contest: Any, output: Path | None) -> None:
    """Print the tables, what the columns mean, and whatever contradicts a proof."""
    from ..benchmarks.tables import contradictions, tables

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
    tell_written(console, output)


def _print_rows(console: Console, rows: "Iterable[Row]") -> None:
    table = plain_table("name", "value", "unit", "aim", right=("value",))
    for row in rows:
        table.add_row(row.name, f"{row.value:.4g}", row.unit, "" if row.aim is None else str(row.aim))
    console.print(table)
